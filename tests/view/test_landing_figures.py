import re
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure

from armland.errors import LogError
from armland.experiments.landing import LandingOutcome, fly_landing
from armland.experiments.landing_judge import PhaseTime
from armland.mission.landing_scenario import landing_scenario
from armland.models.uav import GRAVITY
from armland.view.canvas import paper_style
from armland.view.landing_figures import (
    distance_mm,
    draw_landing_figures,
    label_places,
    overview_figure,
    upward_forces_n,
)

SCENARIO = landing_scenario("landing")
RATE_HZ = SCENARIO.demonstrator.run.rate_hz


@pytest.fixture(scope="module")
def landed() -> LandingOutcome:
    return fly_landing(SCENARIO, seed=1)


@pytest.fixture(scope="module")
def figure(landed) -> Figure:
    with paper_style():
        drawn = overview_figure(landed, RATE_HZ)
        drawn.draw_without_rendering()
    return drawn


@pytest.fixture(scope="module")
def files(landed, tmp_path_factory) -> list[Path]:
    return draw_landing_figures(tmp_path_factory.mktemp("out") / "new", landed, RATE_HZ, "mine")


def of_phase(outcome: LandingOutcome, name: str, y: np.ndarray) -> np.ndarray:
    (p,) = (p for p in outcome.phases if p.name == name)
    return y[round(p.start_s * RATE_HZ) : round(p.end_s * RATE_HZ)]


def test_page_is_written_as_pdf_and_png(files) -> None:
    assert [f.name for f in files] == ["mine_overview.pdf", "mine_overview.png"]
    assert files[0].read_bytes().startswith(b"%PDF")
    assert files[1].read_bytes().startswith(b"\x89PNG")


def test_same_outcome_gives_the_same_bytes(files, landed, tmp_path) -> None:
    again = draw_landing_figures(tmp_path, landed, RATE_HZ, "mine")
    assert [a.read_bytes() == b.read_bytes() for a, b in zip(files, again, strict=True)] == [True, True]


def test_rotors_arm_and_cradle_together_carry_the_weight(landed) -> None:
    forces = upward_forces_n(landed.records)
    weight = SCENARIO.demonstrator.uav.mass_kg * GRAVITY
    for phase in ("self_test", "carry", "done"):
        total = of_phase(landed, phase, np.sum(forces, axis=0)).mean()
        assert total == pytest.approx(weight, rel=5e-3), phase
    # Without any one of the three it does not add up.
    for force, phase in zip(forces, ("self_test", "carry", "done"), strict=True):
        assert abs(of_phase(landed, phase, force).mean()) > 0.3 * weight


def test_rotor_thrust_is_counted_by_its_vertical_part(landed) -> None:
    log = landed.records[:1].copy()
    log["truth"]["rotor_thrust"] = 1.0
    half = 0.5 * np.deg2rad(60.0)
    log["truth"]["quat"] = [np.cos(half), np.sin(half), 0.0, 0.0]
    assert upward_forces_n(log)[0] == pytest.approx([2.0])


def test_distance_is_horizontal(landed) -> None:
    log = landed.records[:1].copy()
    log["truth"]["r"], log["truth"]["ee"] = [0.6, 0.1, 0.9], [0.603, 0.104, 0.2]
    assert distance_mm(log) == pytest.approx([5.0])


def test_every_axis_carries_its_unit(figure) -> None:
    panels = figure.axes[1:]
    assert len(panels) == 6
    for axes in panels:
        assert re.search(r" \((m|mm|N|°|1)\)$", axes.get_ylabel())
    assert panels[-1].get_xlabel() == "time $t$ (s)"


def test_every_phase_is_named_in_its_order(figure, landed) -> None:
    texts = figure.axes[0].texts
    assert [t.get_text() for t in texts] == [p.name.replace("_", " ") for p in landed.phases]
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


def test_outcome_without_records_is_an_error_and_writes_nothing(landed, tmp_path) -> None:
    with pytest.raises(LogError, match="no records to draw"):
        draw_landing_figures(tmp_path / "out", replace(landed, records=None), RATE_HZ)
    assert not (tmp_path / "out").exists()
