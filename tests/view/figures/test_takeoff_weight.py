import pytest

from armland.experiments.takeoff_weight.study import FlownLimit, TakeoffWeight
from armland.experiments.takeoff_weight.theory import Theory
from armland.scenario import load_scenario
from armland.view.figures.canvas import paper_style
from armland.view.figures.takeoff_weight import draw_takeoff_weight, takeoff_weight_figure

FOUND = TakeoffWeight(
    static_thrust_n=7.44,
    hover_inflow_mps=4.92,
    arm_speed_mps={"forward": 0.6, "sideways": 0.65, "upwards": 0.5},
    theory=Theory({}, {}, {}, {}),
    flights=[FlownLimit("sideways", 0.6, 1.0016, 1.0013, 0.0002, True)],
)


def test_page_is_written_as_pdf_and_png(tmp_path):
    files = draw_takeoff_weight(tmp_path / "new", FOUND, load_scenario("landing"))
    assert [f.name for f in files] == ["takeoff_weight.pdf", "takeoff_weight.png"]
    assert files[0].read_bytes().startswith(b"%PDF")


def test_lines_say_what_theory_says_and_axes_carry_units():
    with paper_style():
        figure = takeoff_weight_figure(FOUND, load_scenario("landing"))
        figure.draw_without_rendering()
    near = figure.axes[0]
    assert all(axes.get_xlabel().endswith("(m/s)") for axes in figure.axes)
    lines = {line.get_label(): line for line in near.lines}
    kept = lines["constant rotor speed"]
    at = abs(kept.get_xdata() - 0.6).argmin()
    assert kept.get_ydata()[at] == pytest.approx(0.158, abs=0.01)
    assert lines["constant rotor speed, no drag"].get_ydata()[at] > kept.get_ydata()[at]
