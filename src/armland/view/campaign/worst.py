"""The worst flights of a campaign in pictures: each is flown again, and a picture drawn of its last phases."""

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from armland.errors import ArmlandError, PictureError
from armland.experiments.campaign.answers.report import Report
from armland.experiments.campaign.replay import replay
from armland.experiments.campaign.store import Store
from armland.runtime.log import read_log
from armland.view.film.film import stills, take_of
from armland.view.page.pictures import photograph

MOST = 6
"""Pictures of a flight: of its last phases, where what went wrong is seen."""
SIZE_PX = (224, 180)
QUALITY = 80


class Picture(NamedTuple):
    """One picture of a strip."""

    phase: str
    time_s: float
    source: str
    """Address of an image that stands in the page itself."""


class Strip(NamedTuple):
    """The pictures of a flight."""

    pictures: tuple[Picture, ...]
    words: str
    """What is to be said of them: why there is none, or that it was not the same flight; empty where all is well."""


def strips(store: Store, report: Report, scratch: Path, told: Callable[[int, int], object]) -> dict[int, Strip]:
    """A strip of each of the worst flights, by row.

    Args:
        store: the report is of.
        report: says which they are.
        scratch: file of a log that nobody keeps.
        told: called with how many are done, and of how many.
    """
    out: dict[int, Strip] = {}
    without = ""
    for number, worst in enumerate(report.worst, start=1):
        if not without:
            try:
                out[worst.run] = _strip(store, worst.run, scratch)
            except PictureError as e:
                # No other flight would have one either.
                without = f"There are no pictures: {e}."
            except ArmlandError as e:
                out[worst.run] = Strip((), f"There are no pictures, for it came to no flight: {e}")
            finally:
                scratch.unlink(missing_ok=True)
        if without:
            out[worst.run] = Strip((), without)
        told(number, len(report.worst))
    return out


def _strip(store: Store, run: int, scratch: Path) -> Strip:
    again = replay(store, run, scratch)
    drawn = list(stills(take_of(read_log(scratch)), *SIZE_PX))[-MOST:]
    pictures = [
        Picture(
            phase.name.replace("_", " "),
            phase.end_s if last else 0.5 * (phase.start_s + phase.end_s),
            photograph(image, QUALITY),
        )
        for phase, image, last in ((p, i, k == len(drawn) - 1) for k, (p, i) in enumerate(drawn))
    ]
    if again.same:
        return Strip(tuple(pictures), "")
    why = f"with other versions ({'; '.join(again.changed)})" if again.changed else "and was not the same"
    return Strip(tuple(pictures), f"Flown again {why}: the pictures may show another course than the row's.")
