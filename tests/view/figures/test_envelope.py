"""Page and table of the capture envelope, of a made-up study."""

import numpy as np
import pytest
from matplotlib.patches import Arc, Rectangle

from armland.view.figures.canvas import paper_style
from armland.view.figures.envelope import draw_envelope, envelope_figure, in_units
from armland.view.tables.studies import print_envelope


def test_the_page_shows_boundary_thresholds_and_flights(made_up_envelope):
    with paper_style():
        figure = envelope_figure(made_up_envelope)
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


def test_files(made_up_envelope, tmp_path):
    files = draw_envelope(tmp_path, made_up_envelope)
    assert sorted(f.name for f in files) == ["envelope.pdf", "envelope.png"]
    before = files[0].read_bytes()
    assert draw_envelope(tmp_path, made_up_envelope)[0].read_bytes() == before


def test_the_table_names_what_fails(made_up_envelope, tmp_path, capsys):
    print_envelope(made_up_envelope, tmp_path)
    text = " ".join(capsys.readouterr().out.split())
    assert "fails: bounds.lost_offset_m = 0.015 m lies outside" in text
    assert text.count("│ fails │") == 1
    assert "1 of 1 captures hold" in text
