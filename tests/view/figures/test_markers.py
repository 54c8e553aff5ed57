import numpy as np
import pytest

from armland.errors import PictureError
from armland.experiments.envelope.sight import Band
from armland.scenario.sensing import Camera
from armland.view.figures import markers
from armland.view.figures.markers import (
    draw_contact_sheet,
    draw_marker_demo,
    draw_marker_figure,
)
from armland.view.tables.markers import errors_table, sight_table
from armland.vision.fiducial import Detection
from armland.vision.flight import Shot
from armland.vision.imaging import Motion
from armland.vision.scene import build_marker_scene
from armland.vision.study import FACING, Errors, Row

CAMERA = Camera(marker_size_m=0.06)


def row(z: float) -> Row:
    ideal, honest = (Errors(1.0, k * 1e-4 * z, k * 2e-4 * z, np.deg2rad(0.5), np.deg2rad(0.25)) for k in (0.1, 1.0))
    return Row(z, 4, ideal, honest, Errors(0.96, 1e-3 * z, 2e-3 * z, 0.1, 0.1), 4e-4, 9e-4)


ROWS = [row(0.2), row(0.6), row(1.8)]


def test_table_holds_the_four_beside_each_other() -> None:
    head, rule, first, *_ = errors_table(ROWS).splitlines()
    assert head.count("|") == rule.count("|") == first.count("|")
    assert first == (
        "| 0.2 | 100 / 100 / 96 | 0.002 / 0.02 / 0.2 / 0.4 | 0.004 / 0.04 / 0.4 / 0.9 "
        "| 0.5 / 0.5 / 5.7 | 0.25 / 0.25 / 5.7 |"
    )


def test_table_of_sight_names_what_hides_the_marker() -> None:
    lines = sight_table(
        [Band(0.1, 0.2, 30, 1.0, 1.0, ()), Band(0.2, 0.3, 20, 0.756, 1.0, ("uav/skid_1",))]
    ).splitlines()
    assert lines[2] == "| 0.1 to 0.2 | 30 | 100 % | nothing |"
    assert lines[3] == "| 0.2 to 0.3 | 20 | 76 % | uav/skid_1 |"


def test_figure_is_written_twice_with_the_same_bytes(tmp_path) -> None:
    first, second = (draw_marker_figure(tmp_path / name, ROWS, CAMERA) for name in "ab")
    assert [p.name for p in first] == ["fig_marker_error.pdf", "fig_marker_error.png"]
    assert [p.read_bytes() for p in first] == [p.read_bytes() for p in second]


def test_figure_draws_the_rows_in_millimetres_and_degrees() -> None:
    figure = markers._error_figure(ROWS, CAMERA)
    for axes, expected in zip(
        figure.axes, ([0.02, 0.06, 0.18], [0.04, 0.12, 0.36], [0.5] * 3, [0.25] * 3), strict=True
    ):
        (line,) = (x for x in axes.lines if x.get_label() == "detector, honest pictures")
        np.testing.assert_allclose(line.get_xdata(), [0.2, 0.6, 1.8])
        np.testing.assert_allclose(line.get_ydata(), expected)
    (stars,) = (x for x in figure.axes[1].lines if x.get_marker() == "*" and len(x.get_xdata()))
    np.testing.assert_allclose(stars.get_ydata(), [0.9, 3.3])


def test_demo_finds_the_marker_in_its_picture(tmp_path) -> None:
    pytest.importorskip("cv2")
    try:
        paths, found = draw_marker_demo(tmp_path)
    except PictureError as e:
        pytest.skip(str(e))
    assert all(p.stat().st_size > 10_000 for p in paths)
    np.testing.assert_allclose(found.position, markers._DEMO.position, atol=1e-3)


def test_contact_sheet_shows_found_and_lost(tmp_path) -> None:
    pytest.importorskip("cv2")
    motion = Motion(np.array([0.0, 0.0, 0.3]), FACING, np.zeros(3), np.zeros(3))
    corners = np.array([[500.0, 400.0], [700.0, 400.0], [700.0, 600.0], [500.0, 600.0]])
    found = Detection(7, np.array([0.0, 0.0, 0.301]), FACING, corners, 0.01, 0.1)
    image = np.full((960, 1248), 128, np.uint8)
    shots = [Shot(image, motion, found), Shot(image, motion, None)]
    assert shots[0].error[0] == pytest.approx([0.0, 0.0, 1e-3])
    assert np.isnan(shots[1].error[0]).all()
    pdf, png = draw_contact_sheet(tmp_path, shots, build_marker_scene(), ["guide", "approach"])
    assert pdf.stat().st_size > 5_000
    assert png.stat().st_size > 5_000
