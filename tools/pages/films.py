"""The films and the sheet of stills of `docs/film.md`: `PYTHONPATH=tools python -m pages.films` flies the runs and draws them.

Films are animated WebP, which pages show inline; each is small enough for a repository.
"""

from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from PIL import Image

from armland.experiments.episode import fly
from armland.runtime.log import read_log
from armland.scenario import load_scenario
from armland.view.film.film import Cut, Take, film, stills, take_of

IMAGES = Path(__file__).parents[2] / "docs" / "images"

CUT = Cut(width=512, height=288, fps=12, speed=3.0)

PUBLISHED = {"deviation": {"level": "published"}}

RUNS: dict[str, tuple[int, dict[str, Any]]] = {
    "film_landing": (7, PUBLISHED),
    "film_sea": (3, {**PUBLISHED, "sea": {"state": "ss2", "hull_m": 4.0}}),
}
"""File -> seed and changes: as `armland land --seed 7`, and `armland land --seed 3 --sea 2 --hull 4`."""

SHOWN = ("guide", "approach", "capture", "carry", "set_down", "done")
"""Phases on the sheet of stills."""

STILL_PX = (426, 320)


def taken(name: str, folder: Path) -> Take:
    """One of `RUNS`, flown, with its log in `folder`."""
    seed, changes = RUNS[name]
    episode = fly(load_scenario("landing", changes), "landing", seed=seed, log=folder / f"{name}.mcap")
    assert episode.log is not None
    return take_of(read_log(episode.log))


def contact_sheet(take: Take, columns: int = 3) -> Image.Image:
    """Stills of the phases `SHOWN` side by side."""
    shown = [picture for phase, picture in stills(take, *STILL_PX) if phase.name in SHOWN]
    gap = np.full((STILL_PX[1] + 6, STILL_PX[0] + 6, 3), 255, np.uint8)
    tiles = []
    for picture in shown:
        tiles.append(gap.copy())
        tiles[-1][: STILL_PX[1], : STILL_PX[0]] = picture
    rows = [np.hstack(tiles[i : i + columns]) for i in range(0, len(tiles) - columns + 1, columns)]
    return Image.fromarray(np.vstack(rows)[:-6, :-6])


def main() -> None:
    """Fly and draw everything."""
    with TemporaryDirectory() as folder:
        for name in RUNS:
            take = taken(name, Path(folder))
            film(take, IMAGES / f"{name}.webp", CUT)
            if name == "film_landing":
                contact_sheet(take).save(IMAGES / "film_stills.jpg", quality=84, optimize=True)


if __name__ == "__main__":
    main()
