"""Page and table of the capture envelope, of a made-up study."""

import numpy as np
import pytest
from matplotlib.patches import Arc, Rectangle

from armland.experiments.envelope.bench import Capture
from armland.experiments.envelope.bounds import Allowed, Axis, Edge, Map
from armland.experiments.envelope.interception import Tracked
from armland.experiments.envelope.study import EnvelopeStudy, Flown
from armland.view.figures.canvas import paper_style
from armland.view.figures.envelope import draw_envelope, envelope_figure, in_units
from armland.view.tables.studies import print_envelope


@pytest.fixture
def made_up() -> EnvelopeStudy:
    directions = [0.0, 0.5 * np.pi, np.pi]

    def axis(name, bound):
        edges = tuple(Edge(bound, "3 of 4 pads", w) for w in directions)
        return Axis(name, edges, edges, 1.1 * bound, bound)

    bounds = {"offset": 0.0065, "speed": 0.2, "tilt": 0.4, "plate": 0.3, "fastest": 0.6, "slowest": 0.01}
    boundary = (Edge(0.2, "3 of 4 pads"), Edge(0.1, "3 of 4 pads"))
    maps = (
        Map("offset", "speed", (0.0, 0.008), boundary, (0.2, 0.1), (0.004, 0.06)),
        Map("offset", "tilt", (0.0, 0.008), boundary, (0.2, 0.1), (0.004, 0.1)),
        Map("closing", "speed", (0.0, 0.8), boundary, (0.2, 0.1), (0.16, 0.06)),
    )
    limits = dict.fromkeys(
        ("offset", "relative speed", "joint speed", "joint torque", "torque rate", "track filter"), 0.1
    )
    held = Capture(True, "held", 4, 15.0, 6.0, 0.005, 0.03)
    return EnvelopeStudy(
        allowed=Allowed(0.004, 0.06, 0.1, 0.015, 0.04, 0.16),
        closing=0.1,
        axes=tuple(axis(k, v) for k, v in bounds.items()),
        maps=maps,
        corners=((0.0, held),),
        flown=(Flown(1, 0.001, 0.02, 0.09, 0.2, 1.0), Flown(2, 0.002, 0.01, 0.1, 0.1, 0.5)),
        tracked=tuple(Tracked(f, 0.01, 0.1 * f, 0.05, {**limits, "offset": 0.04 / f}) for f in (0.5, 1.0)),
        captures=10,
    )


def test_the_page_shows_boundary_thresholds_and_flights(made_up):
    with paper_style():
        figure = envelope_figure(made_up)
    first, second, third = figure.axes[:3]
    (box,) = [p for p in first.patches if isinstance(p, Rectangle)]
    assert (box.get_width(), box.get_height()) == pytest.approx((4.0, 0.06))
    (arc,) = [p for p in third.patches if isinstance(p, Arc)]
    assert (arc.center[0], arc.width) == pytest.approx((0.1, 0.12))
    lines = {line.get_label(): line for line in first.lines}
    np.testing.assert_allclose(lines["boundary"].get_xydata(), [[0.0, 0.2], [8.0, 0.1]])
    np.testing.assert_allclose(lines["flown"].get_xydata(), [[1.0, 0.02], [2.0, 0.01]])
    tilt = next(line for line in second.lines if line.get_label() == "flown")
    np.testing.assert_allclose(tilt.get_ydata(), [0.2, 0.1])


def test_units_of_the_page():
    assert in_units("offset", 0.004) == pytest.approx(4.0)
    assert in_units("tilt", np.pi / 6) == pytest.approx(30.0)
    assert in_units("closing", 0.2) == pytest.approx(0.2)


def test_files(made_up, tmp_path):
    files = draw_envelope(tmp_path, made_up)
    assert sorted(f.name for f in files) == ["envelope.pdf", "envelope.png"]
    before = files[0].read_bytes()
    assert draw_envelope(tmp_path, made_up)[0].read_bytes() == before


def test_the_table_names_what_fails(made_up, tmp_path, capsys):
    print_envelope(made_up, tmp_path)
    text = " ".join(capsys.readouterr().out.split())
    assert "fails: bounds.lost_offset_m = 0.015 m lies outside" in text
    assert text.count("│ fails │") == 1
    assert "1 of 1 captures hold" in text
