"""The command `render`: a film of a recorded run, and stills of its phases."""

import shutil
from contextlib import ExitStack
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

from armland.cli import options
from armland.cli.console import diagnostics, progress_bar
from armland.errors import ConfigurationError, PictureError

if TYPE_CHECKING:
    from armland.view.film.film import Cut, Take

RENDER_EPILOG = """**Examples**

`armland render out/land/landing.mcap --video landing.mp4` makes a film of some seconds; no display is needed.

`armland render out/land/landing.mcap --video landing.webp --speed 4 --fps 12 --size 480x270` makes a small one that
a page shows inline.

`armland render out/land/landing.mcap --video landing.mp4 --plots` has heights, forces and tilt beside the scene.

`armland render out/land/landing.mcap --stills out/stills` draws a picture of each phase.

Exit code: 0 when it is done, 2 for bad input or where no OpenGL works, 3 if something broke, 130 if it was stopped.
"""


@options.taken(
    RENDER_EPILOG,
    file=options.argument(Path, "Run log (MCAP).", ..., metavar="LOG"),
    video=options.option(Path | None, "Film to write: *.mp4, *.webm, *.gif or *.webp.", metavar="FILE"),
    plots=options.option(bool, "Show heights, forces and tilt over time beside the scene.", "--plots", default=False),
    stills=options.option(Path | None, "Folder for a picture of each phase (PNG).", metavar="DIR"),
    speed=options.option(
        float | None, "Times as fast as it was; so that the film takes 8 s at most if absent.", min=0.01, max=1000.0
    ),
    fps=options.option(int, "Pictures a second.", default=24, min=1, max=120),
    size=options.option(str, "Size of the scene in pixels.", default="960x540", metavar="WxH"),
)
def render(**given: Any) -> None:
    """Make a film of a run from its log, and stills of its phases."""
    from armland.runtime.log import read_log
    from armland.view.film.encoding import check_name
    from armland.view.film.film import Cut, film, take_of

    video, stills = given["video"], given["stills"]
    if video is None and stills is None:
        raise ConfigurationError("nothing to make: --video film.mp4 makes a film, --stills DIR a picture of each phase")
    width, height = _size(given["size"])
    cut = Cut(width, height, given["fps"], given["speed"], given["plots"])
    if video is not None:
        check_name(video)
    take = take_of(read_log(given["file"]))
    try:
        if stills is not None:
            print(f"{len(_write_stills(take, stills, cut))} stills are in {stills}/")
        if video is not None:
            with progress_bar(diagnostics()) as bar:
                task = bar.add_task(video.name)
                film(take, video, cut, lambda done, total: bar.update(task, completed=done, total=total))
            print(f"The film is {video}")
    except PictureError as e:
        raise ConfigurationError(f"no film and no stills: {e}") from e


def _size(text: str) -> tuple[int, int]:
    parts = text.lower().split("x")
    if len(parts) != 2 or not all(p.isascii() and p.isdigit() and len(p) < 6 for p in parts):
        raise ConfigurationError(f"--size {text!r}: expected width x height in pixels, e.g. 960x540")
    width, height = int(parts[0]), int(parts[1])
    if width % 2 or height % 2 or not (120 <= width <= 4096 and 120 <= height <= 4096):
        raise ConfigurationError(f"--size {text!r}: both must be even and 120 to 4096")
    return width, height


def _write_stills(take: "Take", folder: Path, cut: "Cut") -> list[Path]:
    # All or none: they are drawn elsewhere first.
    from armland.view.film.film import write_stills

    with ExitStack() as stack:
        try:
            folder.mkdir(parents=True, exist_ok=True)
            part = Path(stack.enter_context(TemporaryDirectory(prefix=".part-", dir=folder)))
        except OSError as e:
            raise ConfigurationError(
                f"--stills {str(folder)!r} cannot be made a folder to write to: {e.strerror}"
            ) from e
        made = write_stills(take, part, cut)
        return [Path(shutil.move(path, folder / path.name)) for path in made]
