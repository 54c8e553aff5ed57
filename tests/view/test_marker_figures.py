import numpy as np
import pytest

from armland.errors import PictureError
from armland.plant.camera import Camera
from armland.view import marker_figures
from armland.view.marker_figures import draw_marker_demo, draw_marker_figure, table
from armland.view.marker_study import ERROR, Row, Study, model_sigma

CAMERA = Camera(marker_size_m=0.06)


@pytest.fixture
def study() -> Study:
    """Made up: errors at three distances, and nothing found at a fourth."""
    rng, errors, rows = np.random.default_rng(0), np.zeros(16, ERROR), []
    for group, z in zip(errors.reshape(4, 4), (0.2, 0.6, 1.8, 4.0), strict=True):
        group["distance"], group["found"] = z, z < 2.0
        group["position"], group["rotation"] = 1e-4 * z * rng.normal(size=(2, 4, 3))
        found = [1e-4 * z, 2e-4 * z, np.deg2rad(0.5), np.deg2rad(0.25)] if z < 2.0 else [np.nan] * 4
        rows.append(Row(z, 4, 4 * (z < 2.0), *found, *model_sigma(CAMERA, z)))
    return Study(errors, rows, CAMERA)


def test_table_has_units_and_the_models_claims_in_brackets(study) -> None:
    head, rule, first, *rest = table(study.rows).splitlines()
    assert head.count("|") == rule.count("|") == first.count("|")
    lateral, depth, tilt, yaw = (f"{x:.2g}" for x in np.multiply(model_sigma(CAMERA, 0.2), [1e3, 1e3, 57.3, 57.3]))
    assert first == f"| 0.2 | 4/4 | 0.02 ({lateral}) | 0.04 ({depth}) | 0.5 ({tilt}) | 0.25 ({yaw}) |"
    assert rest[-1].startswith("| 4 | 0/4 | nan")


def test_figure_is_written_twice_with_the_same_bytes(study, tmp_path) -> None:
    first, second = draw_marker_figure(tmp_path / "a", study), draw_marker_figure(tmp_path / "b", study)
    assert [p.name for p in first] == ["fig_marker_error.pdf", "fig_marker_error.png"]
    assert [p.read_bytes() for p in first] == [p.read_bytes() for p in second]


def test_figure_draws_the_rows_in_millimetres_and_degrees(study) -> None:
    figure = marker_figures._error_figure(study)
    for axes, expected in zip(
        figure.axes, ([0.02, 0.06, 0.18], [0.04, 0.12, 0.36], [0.5] * 3, [0.25] * 3), strict=True
    ):
        (line,) = (x for x in axes.lines if x.get_label() == "detector, rms")
        np.testing.assert_allclose(line.get_xdata(), [0.2, 0.6, 1.8])
        np.testing.assert_allclose(line.get_ydata(), expected)


def test_demo_finds_the_marker_in_its_picture(tmp_path) -> None:
    pytest.importorskip("cv2")
    try:
        paths, found = draw_marker_demo(tmp_path)
    except PictureError as e:
        pytest.skip(str(e))
    assert all(p.stat().st_size > 10_000 for p in paths)
    np.testing.assert_allclose(found.position, marker_figures._DEMO_POSE[0], atol=5e-4)
