import sys
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter

from armland.errors import ArmlandError
from armland.rotations import from_rotation_vector, matrix, multiply, rotation_error
from armland.vision import fiducial
from armland.vision.fiducial import Intrinsics, detect, marker_image, pinhole, project, square

pytest.importorskip("cv2")

SIZE_M = 0.06
WIDTH, HEIGHT = 640, 480
EYE = Intrinsics(700.0, 690.0, 325.0, 236.5)
FACING = np.array([0.0, 1.0, 0.0, 0.0])
FINE = 4


def attitude(tilt: tuple[float, float], turn: float) -> np.ndarray:
    """camera<-marker, turned about the marker's normal, then tilted about the camera's x and y, rad."""
    return multiply(
        from_rotation_vector(np.array([*tilt, 0.0])), multiply(from_rotation_vector(np.array([0, 0, turn])), FACING)
    )


def picture(position, quat: np.ndarray, marker: int = 7, ground: np.ndarray | None = None) -> np.ndarray:
    """What a camera `EYE` sees of the marker, by the homography of its plane: u ~ K [r_x r_y p] (x, y, 1)."""
    print_ = marker_image(marker, 1) > 127
    R = matrix(quat)
    K = np.array([[EYE.fx, 0.0, EYE.cx], [0.0, EYE.fy, EYE.cy], [0.0, 0.0, 1.0]])
    back = np.linalg.inv(K @ np.column_stack([R[:, 0], R[:, 1], position]))
    u = (np.arange(WIDTH * FINE) + 0.5) / FINE - 0.5
    v = (np.arange(HEIGHT * FINE) + 0.5) / FINE - 0.5
    w = back[2, 0] * u + (back[2, 1] * v + back[2, 2])[:, None]
    x = (back[0, 0] * u + (back[0, 1] * v + back[0, 2])[:, None]) / w
    y = (back[1, 0] * u + (back[1, 1] * v + back[1, 2])[:, None]) / w
    column, row = np.floor(5.0 + 8.0 * x / SIZE_M).astype(int), np.floor(5.0 - 8.0 * y / SIZE_M).astype(int)
    on = (column >= 0) & (column < 10) & (row >= 0) & (row < 10)
    light = np.where(print_[np.clip(row, 0, 9), np.clip(column, 0, 9)], 200.0, 30.0)
    blocks = HEIGHT, FINE, WIDTH, FINE
    share, light = on.reshape(blocks).mean(axis=(1, 3)), np.where(on, light, 0.0).reshape(blocks).mean(axis=(1, 3))
    behind = np.full((HEIGHT, WIDTH), 110.0) if ground is None else ground.astype(float)
    return np.rint(gaussian_filter(light + (1.0 - share) * behind, 0.6)).astype(np.uint8)


POSES = [
    ((0.01, 0.0, 0.25), attitude((0.05, 0.0), 0.2)),
    ((0.03, -0.02, 0.2), attitude((0.35, -0.2), 0.8)),
    ((-0.08, 0.05, 0.4), attitude((-0.3, 0.3), -2.5)),
    ((0.1, 0.06, 0.6), attitude((0.1, 0.4), 1.9)),
]


@pytest.mark.parametrize(("position", "quat"), POSES)
def test_pose_of_a_known_homography(position, quat) -> None:
    (found,) = detect(picture(position, quat), SIZE_M, EYE)
    off, z = found.position - position, position[2]
    assert found.marker == 7
    # 0.02 px of corner error, through z²/(f s) in depth, z/f across (plus the depth's share off the axis) and √2/(f s/z) in yaw.
    assert abs(off[2]) < 0.03 * z * z / (690.0 * SIZE_M)
    assert np.abs(off[:2] - off[2] * np.array(position[:2]) / z).max() < 0.03 * z / 690.0
    assert np.linalg.norm(rotation_error(matrix(quat), matrix(found.quat))) < np.deg2rad(0.3)
    np.testing.assert_allclose(found.corners, project(square(SIZE_M) @ matrix(quat).T + position, EYE), atol=0.03)
    assert found.residual_px < 0.02


def test_quaternion_is_a_unit_and_scalar_first() -> None:
    (found,) = detect(picture((0.0, 0.0, 0.25), attitude((0.0, 0.0), 0.0)), SIZE_M, EYE)
    assert np.linalg.norm(found.quat) == pytest.approx(1.0)
    # Face on and upright: half a turn about the image's x axis.
    assert abs(found.quat[1]) == pytest.approx(1.0, abs=1e-3)


def test_wrong_size_scales_the_position_and_nothing_else() -> None:
    image = picture(*POSES[1])
    (true,), (wrong,) = detect(image, SIZE_M, EYE), detect(image, 1.1 * SIZE_M, EYE)
    np.testing.assert_allclose(wrong.position, 1.1 * true.position, rtol=1e-6)
    np.testing.assert_allclose(wrong.quat, true.quat, atol=1e-6)
    assert abs(wrong.position[2] - POSES[1][0][2]) > 0.015


def test_wrong_focal_length_scales_the_depth() -> None:
    position, quat = (0.0, 0.0, 0.4), attitude((0.0, 0.0), 0.3)
    (wrong,) = detect(picture(position, quat), SIZE_M, EYE._replace(fx=770.0, fy=759.0))
    assert wrong.position[2] == pytest.approx(0.44, rel=1e-3)


def test_cropped_image_needs_the_moved_principal_point() -> None:
    position, quat = POSES[2]
    image = np.ascontiguousarray(picture(position, quat)[40:, 25:])
    (found,) = detect(image, SIZE_M, EYE._replace(cx=EYE.cx - 25.0, cy=EYE.cy - 40.0))
    (wrong,) = detect(image, SIZE_M, EYE)
    np.testing.assert_allclose(found.position, position, atol=3e-4)
    np.testing.assert_allclose((wrong.position - position)[:2], [-25.0 * 0.4 / 700.0, -40.0 * 0.4 / 690.0], atol=2e-3)


def test_corners_without_the_edges_make_the_marker_look_farther_away(monkeypatch) -> None:
    image = picture(*POSES[3])
    (with_edges,) = detect(image, SIZE_M, EYE)
    monkeypatch.setattr(fiducial, "refined", lambda image, corners, cells: corners)
    (without,) = detect(image, SIZE_M, EYE)
    assert abs(with_edges.position[2] - 0.6) < 0.3e-3
    assert without.position[2] - 0.6 > 1e-3


def test_no_marker_gives_an_empty_list() -> None:
    assert detect(np.full((HEIGHT, WIDTH), 200, np.uint8), SIZE_M, EYE) == []
    noise = np.random.default_rng(0).integers(0, 255, (HEIGHT, WIDTH)).astype(np.uint8)
    assert detect(noise, SIZE_M, EYE) == []
    square_without_code = np.full((HEIGHT, WIDTH), 200, np.uint8)
    square_without_code[100:260, 200:360] = 30
    assert detect(square_without_code, SIZE_M, EYE) == []
    assert detect(picture(*POSES[0])[:, ::-1], SIZE_M, EYE) == []


@pytest.mark.parametrize("turn", [0.0, 0.5 * np.pi, np.pi, -0.5 * np.pi])
@pytest.mark.parametrize(
    "tilt", [(0.0, 0.0), (np.deg2rad(10.0), 0.0), (-np.deg2rad(10.0), 0.0), (0.0, np.deg2rad(10.0))]
)
def test_symmetric_corners_have_a_pose(tilt, turn: float) -> None:
    # OpenCV's solver answers NaN or nonsense to some of these.
    import cv2

    eye, quat = pinhole(1244, 960, 48.0), attitude(tilt, turn)
    corners = project(square(SIZE_M) @ matrix(quat).T + [0.0, 0.0, 0.3], eye)
    found = fiducial._detection(cv2, 7, corners, SIZE_M, eye)
    assert found is not None
    np.testing.assert_allclose(found.position, [0.0, 0.0, 0.3], atol=1e-6)
    np.testing.assert_allclose(matrix(found.quat), matrix(quat), atol=1e-4)


def test_solver_needs_a_start_without_symmetry(monkeypatch) -> None:
    import cv2

    eye, marker = pinhole(1244, 960, 48.0), square(SIZE_M) @ matrix(FACING).T
    seen = [project(marker + [0.0, 0.0, z], eye) for z in (0.13, 0.2, 0.3, 0.5, 0.8, 1.2)]
    assert None not in [fiducial._detection(cv2, 7, corners, SIZE_M, eye) for corners in seen]
    monkeypatch.setattr(fiducial, "SHAKES_PX", np.zeros((1, 4, 2)))
    assert None in [fiducial._detection(cv2, 7, corners, SIZE_M, eye) for corners in seen]


def test_covered_edge_is_refused(monkeypatch) -> None:
    position, quat = (0.0, 0.0, 0.25), attitude((0.05, 0.0), 0.2)
    image = picture(position, quat)
    corners = project(square(SIZE_M) @ matrix(quat).T + position, EYE)
    # A light bar over a strip of one cell's half along the first edge: the code can still be read.
    along, across = corners[1] - corners[0], corners[3] - corners[0]
    x, y = np.meshgrid(np.arange(WIDTH), np.arange(HEIGHT))
    u = np.linalg.solve(np.column_stack([along, across]), [x.ravel() - corners[0, 0], y.ravel() - corners[0, 1]])
    bar = ((np.abs(u[1]) < 0.05 + 0.03 * u[0]) & (u[0] > -0.2) & (u[0] < 1.2)).reshape(x.shape)
    covered = np.where(bar, 160, image).astype(np.uint8)
    assert detect(covered, SIZE_M, EYE) == []
    monkeypatch.setattr(fiducial, "RESIDUAL_MAX_PX", np.inf)
    (wrong,) = detect(covered, SIZE_M, EYE)
    assert abs(wrong.position[2] - 0.25) > 2e-3


def test_corners_of_no_square_have_no_pose() -> None:
    import cv2

    corners = np.array([[100.0, 100.0], [180.0, 90.0], [190.0, 200.0], [90.0, 120.0]])
    assert fiducial._detection(cv2, 7, corners, SIZE_M, EYE) is None


def test_several_markers_come_in_the_order_of_their_numbers() -> None:
    first = picture((0.06, 0.0, 0.35), attitude((0.0, 0.0), 0.5), marker=300)
    both = picture((-0.06, 0.0, 0.35), attitude((0.2, 0.0), 0.0), marker=11, ground=first)
    low, high = detect(both, SIZE_M, EYE)
    assert (low.marker, high.marker) == (11, 300)
    assert low.position[0] == pytest.approx(-0.06, abs=2e-4)
    assert high.position[0] == pytest.approx(0.06, abs=2e-4)


def test_colours_do_not_matter() -> None:
    image = picture(*POSES[1])
    (grey,), (colour,) = detect(image, SIZE_M, EYE), detect(np.repeat(image[..., None], 3, axis=2), SIZE_M, EYE)
    np.testing.assert_allclose(colour.position, grey.position, atol=1e-6)


def test_ambiguity_tells_a_tilt_that_may_be_mirrored() -> None:
    (near,) = detect(picture((0.0, 0.0, 0.25), attitude((0.4, 0.0), 0.0)), SIZE_M, EYE)
    (far,) = detect(picture((0.0, 0.0, 1.2), attitude((0.04, 0.0), 0.0)), SIZE_M, EYE)
    assert near.ambiguity < 0.05
    assert 0.3 < far.ambiguity <= 1.0


def test_pinhole_sees_the_edge_of_the_field_of_view_at_the_edge_of_the_image() -> None:
    eye = pinhole(800, 600, 90.0)
    assert eye.fx == eye.fy == pytest.approx(300.0)
    # Pixel 0 reaches from -0.5 to 0.5.
    np.testing.assert_allclose(
        project(np.array([[0.0, -1.0, 1.0], [0.0, 0.0, 2.0]]), eye), [[399.5, -0.5], [399.5, 299.5]]
    )


def test_print_has_a_white_margin_of_one_cell_and_a_black_border() -> None:
    image = marker_image(3, 5)
    assert image.shape == (50, 50)
    assert (image[:5] == 255).all()
    assert (image[:, -5:] == 255).all()
    assert (image[5:10, 5:-5] == 0).all()
    assert (image[5:-5, 40:45] == 0).all()


@pytest.mark.parametrize("marker", [-1, 587])
def test_unknown_marker_is_refused(marker: int) -> None:
    with pytest.raises(ArmlandError, match="its markers are 0 to 586"):
        marker_image(marker, 4)


@pytest.mark.parametrize(
    ("image", "size", "says"),
    [
        (np.zeros((10, 10)), SIZE_M, r"float64 \(10, 10\); detection needs uint8"),
        (np.zeros((10, 10, 4), np.uint8), SIZE_M, r"uint8 \(10, 10, 4\)"),
        (np.zeros(10, np.uint8), SIZE_M, r"uint8 \(10,\)"),
        (np.zeros((10, 10), np.uint8), 0.0, "size is 0 m; it must be positive"),
        (np.zeros((10, 10), np.uint8), np.nan, "size is nan m"),
    ],
)
def test_what_is_no_image_is_refused(image, size: float, says: str) -> None:
    with pytest.raises(ArmlandError, match=says):
        detect(image, size, EYE)


@pytest.mark.parametrize("module", [None, SimpleNamespace(aruco=SimpleNamespace())])
def test_missing_opencv_names_the_extra(monkeypatch, module) -> None:
    monkeypatch.setitem(sys.modules, "cv2", module)
    with pytest.raises(ArmlandError, match=r"pip install 'armland\[vision\]'"):
        detect(np.zeros((10, 10), np.uint8), SIZE_M, EYE)
