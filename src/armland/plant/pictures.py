"""Real pictures in place of the camera's measurement model: taken at the exposures, found in them what is found, delivered late.

The model keeps its clock, its delay and its faults; position and attitude come from whoever looks at the picture. The claimed
standard deviations stay the model's: a detector states none.
"""

from collections.abc import Callable

from armland.records import Records
from armland.rotations import Array

Photo = tuple[Array, Array] | None
"""Position (3,) m and attitude (4,) of the marker in the camera's frame, or None where no marker was found."""

Photographer = Callable[[Array, Array], Photo]
"""From the scene's `qpos` and `qvel`, one step before which the exposure's middle was, to what was found in the picture."""


class Pictures:
    """Pictures that are under way between exposure and delivery.

    Args:
        photographer: takes a picture and looks at it.
    """

    def __init__(self, photographer: Photographer) -> None:
        self._photographer = photographer
        self._last: Photo = None
        self._taken: dict[int, Photo] = {}

    def expose(self, tick: int, qpos: Array, qvel: Array, frozen: bool) -> None:
        """Take the picture of `tick`; a `frozen` camera shows the last one again.

        Args:
            tick: of the exposure.
            qpos: the scene's positions (nq,), m, rad, quaternions.
            qvel: its velocities (nv,), m/s, rad/s.
            frozen: whether the camera fails.
        """
        if not frozen:
            self._last = self._photographer(qpos, qvel)
        self._taken[tick] = self._last

    def deliver(self, sample: Records) -> bool:
        """Put what was found into `sample` (1,), of `camera_numbers.SAMPLE`, whose capture says which picture.

        Returns:
            Whether there was anything.
        """
        capture = int(sample["capture"][0])
        photo = self._taken.get(capture)
        self._taken = {tick: later for tick, later in self._taken.items() if tick > capture}
        if photo is None:
            return False
        sample["position"], sample["quat"] = photo
        return True
