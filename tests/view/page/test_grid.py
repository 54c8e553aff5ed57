"""Tables of a page, made of those of the terminal."""

from rich.text import Text

from armland.view.page.grid import Cell, grid_of, holds
from armland.view.tables.verdicts import mark, titled


def test_a_table_of_the_terminal_becomes_one_of_a_page() -> None:
    table = titled("What `x` does", "", "found", "", left=(0, 2))
    table.add_row(Text("[not a tag]"), "1.5 [1.0 … 2.0]", mark(True))
    table.add_row("two", "-", mark(False))
    table.add_section()
    table.add_row("three", "3", mark(None))
    grid = grid_of(table)
    assert grid.caption == "What x does"
    assert grid.columns == ["what", "found", "verdict"]
    assert grid.left == (0, 2)
    assert grid.rows == [
        ("[not a tag]", "1.5 [1.0 … 2.0]", holds(True)),
        ("two", "-", holds(False)),
        ("three", "3", "shown"),
    ]


def test_rows_are_named_where_the_terminal_leaves_that_out() -> None:
    table = titled("Laws", "law", "on board", left=(0, 1))
    for law, board in (("E2", "one"), ("", "two"), ("", "three"), ("E3", "one")):
        table.add_row(law, board)
    assert [row[0] for row in grid_of(table).rows] == ["E2", "E2", "E2", "E3"]


def test_verdicts_carry_a_mark_and_say_the_same_in_words() -> None:
    assert [holds(v) for v in (True, False, None)] == [Cell("holds", "good"), Cell("fails", "bad"), Cell("not judged")]
