"""Tables of the spread and of laws crossed with boards."""

import pytest

from armland.experiments.factorial import ARMS, BOARDS, Cell, Factorial
from armland.experiments.judge.tracking import Metrics
from armland.experiments.spread import E1_LARGEST, E2_LARGEST, PAPER, RATIO, Demonstrator, Sensitivity, Spread
from armland.view.tables.spread import interval, print_factorial, print_spread


def point(e1, e2):
    return dict.fromkeys(PAPER, 0.5) | {E1_LARGEST: e1, E2_LARGEST: e2}


def demonstrator(name, angles):
    return Demonstrator(name, point(9.1, 6.8), [point(a, 7.0) for a in angles], {"E2 overshoots less": 0.75})


@pytest.fixture
def wide(monkeypatch):
    monkeypatch.setenv("COLUMNS", "220")


def test_interval_leaves_out_what_fell():
    assert interval(demonstrator("fitted", [4.0, 5.0, 6.0, 170.0]), E1_LARGEST) == "5.00 [4.10 … 5.90]"
    assert interval(demonstrator("fitted", [170.0]), E1_LARGEST) == "-"


def test_paper_stands_beside_both_demonstrators(wide, capsys, tmp_path):
    alone = [
        Sensitivity("as calibrated", None, point(9.1, 6.8), {"+1 N": 0.58}),
        Sensitivity("control.thrust_n", 4.7, point(9.0, 6.7) | {RATIO: 0.99}, {"+1 N": 1.33}),
    ]
    print_spread(Spread([demonstrator("fitted", [4.0, 170.0]), demonstrator("bench", [4.0])], alone), tmp_path)
    text = capsys.readouterr().out
    lines = {line.split("│")[1].strip(): line for line in text.splitlines() if line.startswith("│")}
    assert "9.2" in lines[E1_LARGEST]
    assert lines[E1_LARGEST].count("9.10") == 2
    assert "1 of 2" in lines["points whose UAV keeps upright"]
    assert "75 %" in lines["holds: E2 overshoots less"]
    assert [cell.strip() for cell in lines["control.thrust_n"].split("│")[2:-1]] == [
        "4.7",
        "9.00",
        "6.70",
        "0.99",
        "1.33",
    ]


def test_every_cell_is_under_its_arm(wide, capsys, tmp_path):
    cells = [
        Cell("E3", board, arm, Metrics(10.0 * i + j, 0.0, [0.0] * 3, [1e-3 * j] * 3, [0.0] * 3, 0.0, 0.0))
        for i, board in enumerate(BOARDS)
        for j, arm in enumerate(ARMS)
    ]
    print_factorial(Factorial(cells), tmp_path)
    text = capsys.readouterr().out
    (row, _) = (line for line in text.splitlines() if "as in split" in line)
    assert [cell.strip() for cell in row.split("│")[3:-1]] == ["10.00", "11.00", "12.00", "13.00", "14.00"]
    assert "2.00/2.00/2.00" in text
    # A unit in brackets is not taken for markup.
    assert "Position error, RMS x/y/z [mm]" in text
