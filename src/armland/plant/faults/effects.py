"""What the failures of `table` do to the devices, compiled: they set the fields that devices read; see also `intrusions`.

| kind | in the plant |
|---|---|
| `encoder_frozen` | a joint's position reading stays; the speed is made of its counts, so it reads zero |
| `encoder_drift` | a joint's position reading grows by `size` rad/s too much, and its speed reading is too large by as much |
| `wrench_dead`, `wrench_reversed`, `wrench_gain` | the force sensor makes 0, -1, `size` of one N; bias, drift and noise stay |
| `camera_noise` | the camera's noise is `size` times what it was; what it claims is not |
| `camera_outliers` | each position is off by random numbers of standard deviation `size` m on each axis |
| `camera_flip` | each attitude is the second solution of a planar pose, `detector_errors.second_pose` |
| `wrong_marker` | what is found lies `size` m beside the marker, in the world's axes |
| `link_delay` | both delays grow by `size` ms/s, up to what the link's lines hold |
| `thrust_loss` | every rotor gives less by `size` |
| `power_loss` | the rotors run down; the UAV neither sends nor hears, and begins its hover anew should the power return |
| `magnet_stuck` | without current the magnet still pulls with `size` of its rating |
| `gust` | the air around the UAV moves by (`size`/2)(1 - cos 2πt/`lasts`) more: MIL-F-8785C's rise, and its mirror image |
"""

from numba import njit

from armland.plant.faults.airborne import fail_link, fail_uav
from armland.plant.faults.ground import fail_arm, fail_camera, fail_magnet
from armland.records import MOST_ROTORS, Record


@njit(cache=True)
def act(k: int, phase: int, told: Record, kept: Record) -> None:
    """Find what fails at tick `k` in `phase`, and set the fields that the devices read.

    Args:
        k: present tick.
        phase: number of the mission's phase.
        told: of `table.told_layout`.
        kept: of `table.kept_layout`, updated.
    """
    _heal(kept)
    for i in range(told.count):
        row = told.row[i]
        if kept.armed[i] < 0 and row.phase == phase:
            kept.armed[i] = k
        since = (k - kept.armed[i]) / told.rate_hz - row.after
        acts = kept.armed[i] >= 0 and 0.0 <= since < row.lasts
        kept.acting[i] = acts
        if acts:
            kept.acted[i] = 1
            fail_link(row, since, told.rate_hz, kept)
            fail_arm(row, since, kept)
            fail_camera(row, kept.camera)
            fail_magnet(row, kept)
            fail_uav(row, since, kept)


@njit(cache=True)
def _heal(kept: Record) -> None:
    kept.uplink_lost = kept.downlink_lost = kept.wrench_frozen = kept.arm_stale = kept.deaf = kept.unpowered = 0
    kept.late = 0
    kept.drift, kept.bridge, kept.coil, kept.rating, kept.residual = 0.0, 1.0, 1.0, 1.0, 0.0
    seen = kept.camera
    seen.frozen = seen.lost = seen.flipped = 0
    seen.noise, seen.outlier = 1.0, 0.0
    for i in range(kept.encoder_off.shape[0]):
        kept.encoder_stuck[i] = 0
        kept.encoder_off[i] = kept.encoder_creep[i] = 0.0
    for i in range(3):
        kept.force[i] = kept.torque[i] = kept.wind[i] = kept.away[i] = seen.marker[i] = 0.0
    for i in range(MOST_ROTORS):
        kept.rotor[i] = 1.0
