import re
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure

from armland.errors import LogError
from armland.experiments.judge.judgement import PhaseTime, phase_times
from armland.models.environment import STANDARD_GRAVITY
from armland.scenario import load_scenario
from armland.view.figures.canvas import paper_style
from armland.view.figures.flight import distance_mm, draw_flight, label_places, overview_figure, upward_forces_n
from armland.view.flown import Flown


@pytest.fixture(scope="module")
def phases(landed) -> list[PhaseTime]:
    return phase_times(landed.ticks["mission"]["phase"], landed.brief.phases, landed.brief.rate_hz)


@pytest.fixture(scope="module")
def figure(landed) -> Figure:
    with paper_style():
        drawn = overview_figure(landed)
        drawn.draw_without_rendering()
    return drawn


@pytest.fixture(scope="module")
def files(landed, tmp_path_factory) -> list[Path]:
    return draw_flight(tmp_path_factory.mktemp("out") / "new", landed)


def of_phase(run: Flown, phases: list[PhaseTime], name: str, y: np.ndarray) -> np.ndarray:
    (p,) = (p for p in phases if p.name == name)
    return y[round(p.start_s * run.brief.rate_hz) : round(p.end_s * run.brief.rate_hz)]


def test_page_is_written_as_pdf_and_png(files) -> None:
    assert [f.name for f in files] == ["landing_overview.pdf", "landing_overview.png"]
    assert files[0].read_bytes().startswith(b"%PDF")
    assert files[1].read_bytes().startswith(b"\x89PNG")


def test_same_run_gives_the_same_bytes(files, landed, tmp_path) -> None:
    again = draw_flight(tmp_path, landed)
    assert [a.read_bytes() == b.read_bytes() for a, b in zip(files, again, strict=True)] == [True, True]


def test_rotors_arm_and_cradle_together_carry_the_weight(landed, phases) -> None:
    forces = upward_forces_n(landed.ticks)
    uav = load_scenario("landing").uav
    weight = (0.480 if uav.mass_kg is None else uav.mass_kg) * STANDARD_GRAVITY
    for phase in ("self_test", "carry", "done"):
        total = of_phase(landed, phases, phase, np.sum(forces, axis=0)).mean()
        assert total == pytest.approx(weight, rel=5e-3), phase
    # Without any one of the three it does not add up.
    for force, phase in zip(forces, ("self_test", "carry", "done"), strict=True):
        assert abs(of_phase(landed, phases, phase, force).mean()) > 0.3 * weight


def test_rotor_thrust_is_counted_by_its_vertical_part(landed) -> None:
    ticks = landed.ticks[:1].copy()
    ticks["truth"]["rotor_thrust"] = [[1.0] * 4 + [0.0] * 4]
    half = 0.5 * np.deg2rad(60.0)
    ticks["truth"]["quat"] = [np.cos(half), np.sin(half), 0.0, 0.0]
    assert upward_forces_n(ticks)[0] == pytest.approx([2.0])


def test_distance_is_horizontal(landed) -> None:
    ticks = landed.ticks[:1].copy()
    ticks["truth"]["r"], ticks["truth"]["ee"] = [0.6, 0.1, 0.9], [0.603, 0.104, 0.2]
    assert distance_mm(ticks) == pytest.approx([5.0])


def test_every_axis_carries_its_unit(figure) -> None:
    panels = figure.axes[1:]
    assert len(panels) == 6
    for axes in panels:
        assert re.search(r" \((m|mm|N|°|1)\)$", axes.get_ylabel())
    assert panels[-1].get_xlabel() == "time $t$ (s)"


def test_every_phase_is_named_in_its_order(figure, phases) -> None:
    texts = figure.axes[0].texts
    assert [t.get_text() for t in texts] == [p.name.replace("_", " ") for p in phases]
    boxes = [t.get_window_extent() for t in texts]
    assert all(a.x1 <= b.x0 + 1.0 for a, b in pairwise(boxes))


def test_nothing_covers_anything(figure) -> None:
    boxes = [axes.get_tightbbox() for axes in figure.axes]
    assert not any(a.overlaps(b) for i, a in enumerate(boxes) for b in boxes[:i])
    (legend,) = figure.legends
    assert not any(legend.get_window_extent().overlaps(box) for box in boxes)
    assert all((box.min >= 0.0).all() and (box.max <= figure.bbox.max).all() for box in boxes)


def test_crowded_labels_are_pushed_apart_and_stay_inside() -> None:
    edges = [0.0, 8.0, 9.7, 9.8, 9.9, 10.0]
    phases = [PhaseTime("p", a, b) for a, b in pairwise(edges)]
    places = label_places(phases, 0.5)
    assert places[0] == 4.0
    assert np.diff(places).min() >= 0.5 - 1e-12
    assert places[-1] <= 10.0
    # Where there are too many for the width they share it evenly.
    assert label_places(phases, 100.0) == pytest.approx([1.0, 3.0, 5.0, 7.0, 9.0])


@pytest.mark.parametrize("ticks", [0, 1])
def test_run_of_too_few_ticks_is_an_error_and_writes_nothing(landed, tmp_path, ticks: int) -> None:
    with pytest.raises(LogError, match=f"has {ticks} ticks"):
        draw_flight(tmp_path / "out", landed._replace(ticks=landed.ticks[:ticks]))
    assert not (tmp_path / "out").exists()
