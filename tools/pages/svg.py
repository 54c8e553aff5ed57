"""A few words for drawings in SVG: boxes, arrows, texts, in colours that all eyes tell apart, on light and dark ground."""

from collections.abc import Sequence
from html import escape
from math import atan2, cos, pi, sin

BLUE, ORANGE, GREEN, RED = "#2f8fc8", "#e69f00", "#009e73", "#d55e00"
"""Of Okabe and Ito, the blue lighter, so that it is seen on dark ground."""
GREY, PALE = "#808080", "#a8a8a8"

Point = tuple[float, float]

STYLE = "svg{color:#1c1c1c}@media (prefers-color-scheme:dark){svg{color:#e8e8e8}}"
"""For the drawing by itself; the site takes it out and lets the theme say the colour."""


class Drawing:
    """A drawing that grows by what is added to it; lengths in px, y downwards."""

    def __init__(self, width: float, height: float, title: str) -> None:
        self.size, self.title, self.parts = (width, height), title, list[str]()

    def box(self, middle: Point, size: Point, text: str, colour: str = BLUE, note: str = "") -> None:
        """A box with a word, and a smaller one below it."""
        (x, y), (w, h) = middle, size
        self.parts.append(
            f'<rect x="{x - w / 2:g}" y="{y - h / 2:g}" width="{w:g}" height="{h:g}" rx="5" fill="{colour}" '
            f'fill-opacity="0.18" stroke="{colour}" stroke-width="1.5"/>'
        )
        self.text((x, y + (-3 if note else 5)), text)
        if note:
            self.text((x, y + 13), note, size=11)

    def group(self, corner: Point, size: Point, text: str) -> None:
        """A dashed frame around what belongs together, its name at the upper edge."""
        (x, y), (w, h) = corner, size
        self.parts.append(
            f'<rect x="{x:g}" y="{y:g}" width="{w:g}" height="{h:g}" rx="8" fill="none" stroke="{GREY}" stroke-dasharray="5 4"/>'
        )
        self.text((x + 10, y + 19), text, anchor="start", size=12)

    def text(self, at: Point, text: str, anchor: str = "middle", size: float = 14, italic: bool = False) -> None:
        """A line of text, its base at a point."""
        style = ' font-style="italic"' if italic else ""
        self.parts.append(
            f'<text x="{at[0]:g}" y="{at[1]:g}" text-anchor="{anchor}" font-size="{size:g}"{style} fill="currentColor">'
            f"{escape(text)}</text>"
        )

    def line(
        self, points: Sequence[Point], colour: str = "currentColor", width: float = 1.5, dashed: bool = False
    ) -> None:
        """A line through points."""
        way = " ".join(f"{x:g},{y:g}" for x, y in points)
        dash = ' stroke-dasharray="5 4"' if dashed else ""
        self.parts.append(
            f'<polyline points="{way}" fill="none" stroke="{colour}" stroke-width="{width:g}" stroke-linecap="round" '
            f'stroke-linejoin="round"{dash}/>'
        )

    def arrow(
        self, points: Sequence[Point], colour: str = "currentColor", width: float = 1.5, dashed: bool = False
    ) -> None:
        """A line through points with a head at the last."""
        (x0, y0), (x, y) = points[-2:]
        along = atan2(y - y0, x - x0)
        self.line([*points[:-1], (x - 6 * cos(along), y - 6 * sin(along))], colour, width, dashed)
        corners = [(x, y)] + [(x - 10 * cos(along + a), y - 10 * sin(along + a)) for a in (pi / 8, -pi / 8)]
        self.parts.append(f'<polygon points="{" ".join(f"{a:.1f},{b:.1f}" for a, b in corners)}" fill="{colour}"/>')

    def dot(self, at: Point, colour: str, radius: float = 5) -> None:
        """A filled circle."""
        self.parts.append(f'<circle cx="{at[0]:g}" cy="{at[1]:g}" r="{radius:g}" fill="{colour}"/>')

    def svg(self) -> str:
        """The drawing as SVG."""
        w, h = self.size
        body = "\n".join(self.parts)
        return (
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {w:g} {h:g}" width="{w:g}" role="img" '
            f'font-family="system-ui, sans-serif">\n<title>{escape(self.title)}</title>\n<style>{STYLE}</style>\n{body}\n</svg>\n'
        )
