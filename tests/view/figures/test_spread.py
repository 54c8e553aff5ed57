from armland.experiments.spread import E1_LARGEST, E2_LARGEST, PAPER, Demonstrator, Spread
from armland.view.figures.canvas import paper_style
from armland.view.figures.spread import draw_spread, spread_figure


def point(e1, e2):
    return dict.fromkeys(PAPER, 0.5) | {E1_LARGEST: e1, E2_LARGEST: e2}


FOUND = Spread(
    [Demonstrator(n, point(9.0, 7.0), [point(4.0, 8.0), point(170.0, 8.0)], {}) for n in ("fitted", "bench")], []
)


def test_page_is_written_as_pdf_and_png(tmp_path):
    assert [f.name for f in draw_spread(tmp_path / "new", FOUND)] == ["spread.pdf", "spread.png"]


def test_paper_is_where_it_says_and_what_fell_is_left_out():
    with paper_style():
        figure = spread_figure(FOUND)
        figure.draw_without_rendering()
    left, right = figure.axes
    lines = {line.get_label(): line for line in left.lines}
    assert (list(lines["paper"].get_xdata()), list(lines["paper"].get_ydata())) == ([9.2], [6.8])
    assert [len(line.get_xdata()) for line in left.lines[:2]] == [1, 1]
    assert left.get_xlabel() == E1_LARGEST
    assert right.get_xlabel() == E2_LARGEST
