"""What is written over a film: phase and time, a bar of the phases, what is flown, and in the end the verdict."""

from collections.abc import Sequence
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

import matplotlib
import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

from armland.experiments.judge.judgement import PhaseTime

Picture = NDArray[np.uint8]
"""(height, width, 3)"""

INK, PALE, PANEL = (255, 255, 255), (205, 213, 222), (16, 22, 30, 178)
DONE, AHEAD, NOW = (86, 180, 233), (120, 132, 145), (230, 159, 0)
GOOD, BAD = (0, 115, 84, 235), (170, 75, 0, 235)
"""Okabe and Ito's colours, the last two darker so that white letters can be read on them; words say the same."""


class Captions(NamedTuple):
    """What is written over each picture of a run."""

    title: str
    phases: Sequence[PhaseTime]
    speed: float
    success: bool
    reason: str

    def over(self, picture: Picture, t: float, ended: bool = False) -> Picture:
        """The picture at the time `t`, s, with the captions; with the verdict where the run has `ended`."""
        height, width = picture.shape[:2]
        image = Image.fromarray(picture).convert("RGBA")
        layer = Image.new("RGBA", image.size, (0, 0, 0, 0))
        draw, unit = ImageDraw.Draw(layer), height / 540.0
        now = next((p for p in reversed(self.phases) if p.start_s <= t), self.phases[0])
        self._bar(draw, width, height, t, now)
        lines = [
            (now.name.replace("_", " "), 25, INK, True),
            (f"{t:.1f} s   {self.speed:g} × real time", 15, PALE, False),
        ]
        _box(draw, (16 * unit, height - 22 * unit), lines, unit, above=True)
        _box(draw, (16 * unit, 14 * unit), [(self.title, 15, INK, False)], unit)
        if ended:
            word, color = ("success", GOOD) if self.success else ("failure", BAD)
            _box(draw, (16 * unit, 50 * unit), [(word, 25, INK, True), (self.reason, 15, INK, False)], unit, fill=color)
        return np.asarray(Image.alpha_composite(image, layer).convert("RGB"))

    def _bar(self, draw: ImageDraw.ImageDraw, width: int, height: int, t: float, now: PhaseTime) -> None:
        # One piece for each phase, as long as it took.
        first, last = self.phases[0].start_s, max(self.phases[-1].end_s, self.phases[0].start_s + 1e-9)
        scale, top = width / (last - first), height - max(round(height / 60), 4)
        for p in self.phases:
            left, right = (scale * (x - first) for x in (p.start_s, p.end_s))
            draw.rectangle((left, top, max(right - 2, left), height), fill=(*AHEAD, 200))
            reached = min(scale * (t - first), right - 2)
            if reached > left:
                draw.rectangle((left, top, reached, height), fill=(*(NOW if p is now else DONE), 255))


def _box(
    draw: ImageDraw.ImageDraw,
    at: tuple[float, float],
    lines: Sequence[tuple[str, int, tuple[int, ...], bool]],
    unit: float,
    above: bool = False,
    fill: tuple[int, ...] = PANEL,
) -> None:
    # A box of lines (text, size, colour, bold) with its upper corner at `at`, or its lower one where it is `above`.
    pad, width = 9 * unit, draw.im.size[0]
    fonts = [font(max(round(size * unit), 9), bold) for _, size, _, bold in lines]
    texts = [_cut(text, f, width - 2 * at[0] - 2 * pad) for (text, *_), f in zip(lines, fonts, strict=True)]
    wide = max(f.getlength(text) for text, f in zip(texts, fonts, strict=True))
    tall = sum(1.28 * f.size for f in fonts)
    x, y = at[0], at[1] - tall - 2 * pad if above else at[1]
    corners = (x, y, x + wide + 2 * pad, y + tall + 1.5 * pad)
    draw.rounded_rectangle(corners, radius=6 * unit, fill=fill)
    y += 0.6 * pad
    for text, (_, _, color, _), f in zip(texts, lines, fonts, strict=True):
        draw.text((x + pad, y), text, fill=(*color, 255), font=f)
        y += 1.28 * f.size


def _cut(text: str, letters: ImageFont.FreeTypeFont, width: float) -> str:
    while len(text) > 4 and letters.getlength(text) > width:
        text = f"{text[:-2].rstrip(' …')}…"
    return text


@lru_cache
def font(size: int, bold: bool = False) -> ImageFont.FreeTypeFont:
    """The letters that come with Matplotlib, so that they are there on every machine."""
    folder = Path(matplotlib.get_data_path()) / "fonts" / "ttf"
    return ImageFont.truetype(str(folder / f"DejaVuSans{'-Bold' if bold else ''}.ttf"), size)
