from itertools import combinations

from armland.view.figures.canvas import paper_style
from armland.view.figures.comparison import COLORS, SHAPES, comparison_figure


def row(condition: str, law: str, attitude: float) -> dict:
    metrics = {"attitude_max_deg": attitude, "position_rms_m": [1e-3, attitude * 1e-3, 1e-4]}
    return {"condition": condition, "law": law, "metrics": metrics}


def test_each_law_has_a_mark_of_its_own_in_each_row() -> None:
    laws = [f"law {i}" for i in range(10)]
    rows = [row(c, law, 1.0 + i) for c in ("calm", "pushed") for i, law in enumerate(laws)]
    with paper_style():
        figure = comparison_figure(rows)
    left, right = figure.axes
    assert [line.get_label() for line in left.lines] == laws
    looks = [(line.get_marker(), line.get_color()) for line in left.lines]
    assert all(a != b for a, b in combinations(looks, 2))
    assert len({m for m, _ in looks}) == 10
    assert list(left.lines[2].get_xdata()) == [3.0, 3.0]
    # The worst axis, in mm.
    assert list(right.lines[2].get_xdata()) == [3.0, 3.0]
    assert [t.get_text() for t in left.get_yticklabels()] == ["calm", "pushed"]
    assert "(°)" in left.get_xlabel()
    assert "(mm)" in right.get_xlabel()
    assert len(COLORS) < len(SHAPES)
