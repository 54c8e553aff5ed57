"""Tornado and table of the margins, of a made-up study."""

import pytest

from armland.experiments.margins.corners import chosen
from armland.view.figures.canvas import paper_style
from armland.view.figures.margins import COLORS, draw_margins, margins_figure
from armland.view.tables.margins import print_margins, range_in_words


def test_bars_stand_in_order_and_end_where_it_holds(made_up_margins):
    with paper_style():
        (axes,) = margins_figure(made_up_margins).axes
    assert [t.get_text() for t in axes.get_yticklabels()] == ["link.loss", "uav.mass", "uav.drag", "uav.thrust"]
    assert axes.get_ylim()[0] > axes.get_ylim()[1], "the first is on top"
    ends = [(p.get_y() + 0.5 * p.get_height(), p.get_x() + p.get_width()) for p in axes.patches]
    assert [e for e in ends if round(e[0]) == 1] == [(1.0, pytest.approx(2.0)), (1.0, pytest.approx(2.4))]
    assert [e for e in ends if round(e[0]) == 3] == [(3.0, pytest.approx(8.0))]


def test_arrow_where_nothing_failed_and_stroke_at_the_bound(made_up_margins):
    with paper_style():
        (axes,) = margins_figure(made_up_margins).axes
    arrows = [line.get_ydata()[0] for line in axes.lines if line.get_marker() == ">"]
    assert arrows == [3]
    bounds = {round(float(line.get_xdata()[0]), 3) for line in axes.lines if line.get_linewidth() == 2.0}
    # That of the thrust, 10, and of the loss, 19.8, lie beyond the axis.
    assert bounds == {round(0.5 / 0.07, 3), round(1.0 / 0.3, 3)}
    assert {round(float(line.get_xdata()[0]), 3) for line in axes.lines} >= {0.5, 1.0, 2.0}


def test_texts_say_what_held_and_why_it_failed(made_up_margins):
    with paper_style():
        (axes,) = margins_figure(made_up_margins).axes
    texts = {t.get_text() for t in axes.texts}
    assert {"±0.14", "not 0.05", "too fast", "published", "harsh", "mild"} <= texts


def test_every_device_has_a_colour_of_its_own():
    assert {r.path.partition(".")[0] for r in chosen(None)} == set(COLORS)
    assert len(set(COLORS.values())) == len(COLORS)


def test_files_are_written(made_up_margins, tmp_path):
    assert [p.name for p in draw_margins(tmp_path, made_up_margins)] == ["margins.pdf", "margins.png"]
    assert all(p.stat().st_size > 5000 for p in tmp_path.iterdir())


def test_table_has_every_margin_and_the_pair(made_up_margins, capsys, tmp_path):
    print_margins(made_up_margins, tmp_path)
    text = " ".join(capsys.readouterr().out.split())
    for words in (
        "link.loss alone, inside its published range",
        "> 8",
        "±0.14",
        "uav.mass fails first by: limits violated: too fast (seed 2, high end; UAV lost)",
        "20 of 24 flights succeed",
        "uav.mass × link.loss",
        "clear",
    ):
        assert words in text


@pytest.mark.parametrize(
    ("low", "high", "words"),
    [
        (-0.07, 0.07, "±0.07 m"),
        (0.0, 25.0, "25 m"),
        (25.0, 25.0, "25 m"),
        (-0.5, 1.0, "-0.5 to 1 m"),
        (0.005, 0.02, "0.005 to 0.02 m"),
    ],
)
def test_range_in_words(low, high, words):
    assert range_in_words(low, high, "m") == words
