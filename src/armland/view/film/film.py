"""A film of a run: its pictures one after the other, drawn while the one before is captioned and encoded."""

from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from armland.errors import ConfigurationError, LogError
from armland.experiments.judge.judgement import PhaseTime, phase_times
from armland.runtime.log import Log
from armland.view.film.captions import Captions
from armland.view.film.encoding import encode
from armland.view.film.stage import CAMERA, Stage, poses, stage_of
from armland.view.film.strip import Strip
from armland.view.flown import Flown, flown, scenario_of
from armland.view.report import result_of
from armland.vision.frames import FrameStream

HOLD_S = 1.2
"""How long the last picture stays, with the verdict."""

STRIP = 0.44
"""Width of the plots over that of the scene."""


class Cut(NamedTuple):
    """How a film is made of a run."""

    width: int = 960  # px, of the scene
    height: int = 540
    fps: int = 24
    speed: float | None = None  # Times as fast as it was; the smallest whole number for a film of `longest_s` if absent
    plots: bool = False
    longest_s: float = 8.0  # About how long a film lasts at most whose speed nobody chose


SHORT = Cut(width=800, height=450, fps=20, longest_s=5.0)
"""Of a film that a run ends with: made in half the time."""


class Take(NamedTuple):
    """A run with its phases and its verdict."""

    log: Log
    run: Flown
    phases: list[PhaseTime]
    success: bool
    reason: str

    @property
    def seconds(self) -> float:
        """Length of the run."""
        return len(self.log.messages["truth"]) / self.run.brief.rate_hz


Progress = Callable[[int, int], object]
"""Called with how many pictures are done, and of how many."""


def take_of(log: Log) -> Take:
    """A run as a film shows it.

    Raises:
        LogError: fewer than two ticks, or a log that cannot be judged.
    """
    if len(log.messages["truth"]) < 2:
        raise LogError(f"the run has {len(log.messages['truth'])} ticks; a film needs two")
    run, result = flown(log), result_of([log])
    phases = phase_times(log.messages["mission"]["phase"], run.brief.phases, run.brief.rate_hz)
    return Take(log, run, phases, bool(result["success"]), str(result["reason"]))


def film(take: Take, path: Path, cut: Cut, progress: Progress = lambda *_: None) -> Path:
    """Make a film of a run and write it into the file `path`, see `encoding`; returns its path.

    Raises:
        LogError: a log whose scene cannot be composed.
        PictureError: no OpenGL that works.
        ConfigurationError: a size that films cannot have.
    """
    if cut.width % 2 or cut.height % 2 or min(cut.width, cut.height) < 120:
        raise ConfigurationError(
            f"a film of {cut.width} x {cut.height} pixels is not possible: both must be even and at least 120"
        )
    speed = max(float(np.ceil(take.seconds / cut.longest_s)), 1.0) if cut.speed is None else cut.speed
    times = np.arange(0.0, take.seconds, speed / cut.fps)
    stage = stage_of(take.log, cut.width / cut.height)
    wide = 2 * round(0.5 * STRIP * cut.width)
    strip = Strip(take.run, take.phases, wide, cut.height) if cut.plots else None
    captions = Captions(title_of(take.log), take.phases, speed, take.success, take.reason)
    with FrameStream(stage.model, cut.width, cut.height, CAMERA, coloured=True, quick=True) as stream:
        drawn = _drawn(stream, stage, take, times)

        def pictures() -> Iterator[NDArray[np.uint8]]:
            for number, (t, scene) in enumerate(zip(times, drawn, strict=True), start=1):
                progress(number, len(times))
                yield _with(strip, captions.over(scene, float(t)), float(t))
            last = _with(strip, captions.over(scene, take.seconds, ended=True), take.seconds)
            for _ in range(round(HOLD_S * cut.fps)):
                yield last

        return encode(path, pictures(), cut.fps)


def stills(take: Take, width: int, height: int) -> Iterator[tuple[PhaseTime, NDArray[np.uint8]]]:
    """Each phase with a picture (height, width, 3) of its middle, of the last one's end; a phase that came twice, twice.

    Raises:
        LogError: a log whose scene cannot be composed.
        PictureError: no OpenGL that works.
    """
    stage = stage_of(take.log, width / height)
    times = np.array([0.5 * (p.start_s + p.end_s) for p in take.phases[:-1]] + [take.phases[-1].end_s])
    with FrameStream(stage.model, width, height, CAMERA, coloured=True) as stream:
        yield from zip(take.phases, _drawn(stream, stage, take, times), strict=True)


def write_stills(take: Take, folder: Path, cut: Cut) -> list[Path]:
    """Write a still of each phase as PNG into the folder; returns the files' paths. Errors as for `stills`."""
    paths = []
    for number, (phase, picture) in enumerate(stills(take, cut.width, cut.height), start=1):
        paths.append(folder / f"still_{number:02d}_{phase.name}.png")
        Image.fromarray(picture).save(paths[-1], optimize=True)
    return paths


def title_of(log: Log) -> str:
    """What is flown, in a few words."""
    scenario = scenario_of(log)
    words = [log.metadata.get("experiment") or log.metadata["mission"], f"seed {log.metadata['seed']}"]
    if scenario.air.wind_mps:
        words.append(f"wind {scenario.air.wind_mps:g} m/s")
    if scenario.sea.trace is not None:
        words.append("recorded deck")
    elif scenario.sea.waves:
        words.append(f"sea {scenario.sea.state.removeprefix('ss')}, hull {scenario.sea.hull_m:g} m")
    elif scenario.sea.moves:
        words.append(f"sea: {scenario.sea.state}")
    return ", ".join(words)


def _drawn(stream: FrameStream, stage: Stage, take: Take, times: NDArray[np.float64]) -> Iterator[NDArray[np.uint8]]:
    # Pictures at the times; each is drawn while the one before is in use.
    truth, rate = take.log.messages["truth"], take.run.brief.rate_hz
    ticks = np.minimum(np.rint(times * rate).astype(int), len(truth) - 1)
    qpos = poses(stage.scene, truth[ticks])
    with ThreadPoolExecutor(1) as ahead:

        def draw(i: int) -> NDArray[np.uint8]:
            return stream.draw(qpos[i], stage.surface(float(times[i])))

        coming = ahead.submit(draw, 0)
        for i in range(len(times)):
            picture = coming.result()
            if i + 1 < len(times):
                coming = ahead.submit(draw, i + 1)
            yield picture


def _with(strip: Strip | None, scene: NDArray[np.uint8], t: float) -> NDArray[np.uint8]:
    return scene if strip is None else np.hstack([scene, strip.at(t)])
