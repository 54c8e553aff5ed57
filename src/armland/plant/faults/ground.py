"""What failures do to the devices on the ground, compiled: encoders, force sensor, camera and magnet."""

from numba import njit

from armland.records import Record
from armland.scenario.faults import FAILURES

ARM_STALE = FAILURES.index("arm_stale")
ENCODER_OFFSET, ENCODER_DRIFT, ENCODER_FROZEN = (FAILURES.index(f"encoder_{n}") for n in ("offset", "drift", "frozen"))
WRENCH_FROZEN, WRENCH_DRIFT, WRENCH_DEAD, WRENCH_REVERSED, WRENCH_GAIN = (
    FAILURES.index(f"wrench_{n}") for n in ("frozen", "drift", "dead", "reversed", "gain")
)
CAMERA_FROZEN, CAMERA_LOST, CAMERA_NOISE, CAMERA_OUTLIERS, CAMERA_FLIP = (
    FAILURES.index(f"camera_{n}") for n in ("frozen", "lost", "noise", "outliers", "flip")
)
WRONG_MARKER = FAILURES.index("wrong_marker")
MAGNET_COIL, MAGNET_SLIP, MAGNET_STUCK = (FAILURES.index(f"magnet_{n}") for n in ("coil", "slip", "stuck"))


@njit(cache=True)
def fail_arm(row: Record, since: float, kept: Record) -> None:
    """Set what encoders and force sensor read.

    Args:
        row: of `table.ROW`, a fault that acts.
        since: time for which it has acted, s.
        kept: of `table.kept_layout`, updated.
    """
    kind = row.kind
    if kind == ARM_STALE:
        kept.arm_stale = 1
    elif kind == ENCODER_OFFSET:
        kept.encoder_off[row.joint] += row.size
    elif kind == ENCODER_DRIFT:
        kept.encoder_off[row.joint] += row.size * since
        kept.encoder_creep[row.joint] += row.size
    elif kind == ENCODER_FROZEN:
        kept.encoder_stuck[row.joint] = 1
    elif kind == WRENCH_FROZEN:
        kept.wrench_frozen = 1
    elif kind == WRENCH_DRIFT:
        kept.drift = row.size * since
    elif kind == WRENCH_DEAD:
        kept.bridge = 0.0
    elif kind == WRENCH_REVERSED:
        kept.bridge *= -1.0
    elif kind == WRENCH_GAIN:
        kept.bridge *= row.size


@njit(cache=True)
def fail_camera(row: Record, seen: Record) -> None:
    """Set what the camera gets wrong.

    Args:
        row: of `table.ROW`, a fault that acts.
        seen: of `camera_numbers.ERRORS`, updated.
    """
    kind = row.kind
    if kind == CAMERA_FROZEN:
        seen.frozen = 1
    elif kind == CAMERA_LOST:
        seen.lost = 1
    elif kind == CAMERA_NOISE:
        seen.noise *= row.size
    elif kind == CAMERA_OUTLIERS:
        seen.outlier = row.size
    elif kind == CAMERA_FLIP:
        seen.flipped = 1
    elif kind == WRONG_MARKER:
        for i in range(3):
            seen.marker[i] = row.size * row.direction[i]


@njit(cache=True)
def fail_magnet(row: Record, kept: Record) -> None:
    """Set what coil, rating and residual pull are worth.

    Args:
        row: of `table.ROW`, a fault that acts.
        kept: of `table.kept_layout`, updated.
    """
    kind = row.kind
    if kind == MAGNET_COIL:
        kept.coil = 1.0 - row.size
    elif kind == MAGNET_SLIP:
        kept.rating *= 1.0 - row.size
    elif kind == MAGNET_STUCK:
        kept.residual = row.size
