"""The drawings of docs/images: what flows in a tick, which part imports which, the frames, the sign of the site.

`PYTHONPATH=tools python -m pages.drawings` writes them.
"""

from itertools import pairwise
from pathlib import Path

from pages.svg import BLUE, GREEN, GREY, ORANGE, PALE, RED, Drawing, Point

IMAGES = Path(__file__).parents[2] / "docs" / "images"

PLACES: dict[str, Point] = {
    "cli": (35, 95),
    "console": (130, 95),
    "view": (230, 95),
    "vision": (330, 95),
    "experiments": (455, 95),
    "runtime": (580, 60),
    "plant": (580, 130),
    "mission": (690, 95),
    "control": (805, 60),
    "estimation": (805, 130),
    "laws": (690, 25),
    "models": (925, 95),
    "foundation": (925, 175),
}
IMPORTS = (
    ("models", "foundation"),
    ("control", "models"),
    ("estimation", "models"),
    ("laws", "control"),
    ("mission", "control"),
    ("mission", "estimation"),
    ("runtime", "mission"),
    ("plant", "mission"),
    ("experiments", "plant"),
    ("experiments", "runtime"),
    ("vision", "experiments"),
    ("view", "vision"),
    ("console", "view"),
    ("cli", "console"),
)
"""Who imports whom; what is reached over several arrows may be imported as well."""

HEIGHT = 34


def half_width(name: str) -> float:
    """Half of the width of a part's box."""
    return 20 + 3.6 * len(name)


def parts() -> Drawing:
    """Which part imports which."""
    drawing = Drawing(985, 205, "Which part of armland imports which: " + ", ".join(f"{a} {b}" for a, b in IMPORTS))
    for one, other in IMPORTS:
        (x, y), (u, v) = PLACES[one], PLACES[other]
        if x == u:
            drawing.arrow([(x, y + HEIGHT / 2), (u, v - HEIGHT / 2)], GREY)
        else:
            drawing.arrow([(x + half_width(one), y), (u - half_width(other), v)], GREY)
    for name, place in PLACES.items():
        colour = {"foundation": GREEN, "plant": ORANGE, "runtime": ORANGE}.get(name, BLUE)
        drawing.box(place, (2 * half_width(name), HEIGHT), name, colour)
    return drawing


def flow() -> Drawing:
    """What flows in a tick."""
    drawing = Drawing(
        905, 360, "What flows in a tick: from the port through the controller's stages and back, and into the record"
    )
    drawing.group((10, 10), (185, 220), "port: simulator or devices")
    drawing.group((270, 10), (625, 220), "controller: one compiled call per tick")
    upper = {"screen": 330, "arm model": 470, "estimate": 640, "decide": 810}
    lower = {"limit": 330, "act": 540, "refer": 810}
    size = (100, 40)
    drawing.box((102, 80), size, "read", ORANGE)
    drawing.box((102, 180), size, "command", ORANGE)
    drawing.arrow([(72, 160), (72, 100)], RED)
    drawing.text((82, 134), "the physics step", anchor="start", size=12)
    for row, y in ((upper, 80), (lower, 180)):
        for name, x in row.items():
            drawing.box((x, y), size, name)
    for x, u in pairwise(upper.values()):
        drawing.arrow([(x + 50, 80), (u - 50, 80)])
    drawing.arrow([(152, 80), (280, 80)])
    drawing.text((232, 72), "measurement", size=12)
    drawing.arrow([(810, 100), (810, 160)])
    drawing.text((818, 134), "phase, fault", anchor="start", size=12)
    drawing.arrow([(760, 180), (590, 180)])
    drawing.text((676, 172), "reference", size=12)
    drawing.arrow([(640, 100), (575, 160)], dashed=True)
    drawing.text((616, 140), "estimate", anchor="start", size=12)
    drawing.arrow([(490, 180), (380, 180)])
    drawing.text((435, 172), "torque, thrust", size=12)
    drawing.arrow([(280, 180), (152, 180)])
    drawing.text((232, 172), "command", size=12)
    _record(drawing)
    return drawing


def _record(drawing: Drawing) -> None:
    drawing.arrow([(102, 230), (102, 320), (300, 320)], dashed=True)
    drawing.text((112, 312), "truth", anchor="start", size=12)
    drawing.arrow([(360, 230), (360, 300)])
    drawing.text((370, 268), "all messages of the tick", anchor="start", size=12)
    drawing.box((360, 320), (120, 40), "record", GREEN)
    drawing.box((540, 320), (100, 40), "judge", GREEN)
    drawing.box((740, 320), (220, 40), "figures, tables, report", GREEN)
    drawing.arrow([(420, 320), (490, 320)])
    drawing.arrow([(590, 320), (630, 320)])


def axes(drawing: Drawing, at: Point, name: str, colour: str, length: float = 46) -> None:
    """x and z of a frame seen from starboard; y points away from the reader."""
    x, y = at
    drawing.arrow([at, (x + length, y)], colour, 3)
    drawing.arrow([at, (x, y - length)], colour, 3)
    drawing.text((x + length + 4, y + 4), "x", anchor="start", size=12, italic=True)
    drawing.text((x - 4, y - length + 4), "z", anchor="end", size=12, italic=True)
    drawing.dot(at, colour)
    drawing.text((x + 8, y - 10), name, anchor="start", size=15)


def frames() -> Drawing:
    """World, deck, body and end effector, seen from the side."""
    drawing = Drawing(
        720, 400, "Frames: W and D at the arm's base, E at the tip of the tool, B at the UAV's centre of mass"
    )
    drawing.line([(20, 370), (700, 370)], GREY, 2)
    drawing.line([(90, 370), (90, 320), (150, 190), (290, 260), (350, 245)], PALE, 12)
    drawing.line([(350, 245), (390, 245), (390, 205)], PALE, 8)
    drawing.box((428, 245), (26, 16), "", GREY)
    drawing.line([(390, 245), (415, 245)], PALE, 4)
    drawing.text((448, 250), "camera, looks up", anchor="start", size=12)
    _uav(drawing)
    drawing.line([(370, 201), (410, 201)], RED, 5)
    drawing.text((420, 212), "magnet", anchor="start", size=12)
    drawing.dot((390, 168), RED, 6)
    drawing.text((400, 173), "pivot r, and E", anchor="start", size=12)
    axes(drawing, (90, 370), "W, D", GREEN, 60)
    drawing.text((176, 390), "on land W = D; at sea D moves with the deck", anchor="start", size=12)
    drawing.line([(560, 370), (560, 290), (600, 290)], PALE, 5)
    drawing.line([(670, 370), (670, 290), (630, 290)], PALE, 5)
    drawing.text((615, 280), "cradle", size=12)
    return drawing


def _uav(drawing: Drawing) -> None:
    drawing.line([(290, 100), (490, 100)], PALE, 5)
    for x in (290, 490):
        drawing.line([(x - 45, 86), (x + 45, 86)], PALE, 3)
        drawing.line([(x, 100), (x, 86)], PALE, 3)
    drawing.line([(315, 100), (285, 215), (270, 215)], PALE, 3)
    drawing.line([(465, 100), (540, 215), (555, 215)], PALE, 3)
    drawing.line([(365, 192), (415, 192)], BLUE, 4)
    drawing.line([(390, 192), (390, 168)], BLUE, 3)
    drawing.text((362, 196), "plate", anchor="end", size=12)
    drawing.arrow([(390, 100), (390, 164)], ORANGE, 3)
    drawing.text((398, 140), "ρ, the lever", anchor="start", size=12)
    axes(drawing, (390, 100), "B", BLUE)
    drawing.text((325, 52), "centre of mass", anchor="end", size=12)
    drawing.line([(328, 54), (384, 95)], GREY, 1)


def sign() -> Drawing:
    """The sign of the site: a UAV above a hand."""
    drawing = Drawing(64, 64, "armland")
    drawing.line([(8, 14), (28, 14)], BLUE, 5)
    drawing.line([(36, 14), (56, 14)], BLUE, 5)
    drawing.line([(18, 22), (46, 22)], BLUE, 6)
    drawing.line([(32, 22), (32, 34)], ORANGE, 5)
    drawing.line([(20, 38), (44, 38)], RED, 6)
    drawing.line([(32, 41), (32, 50), (16, 60)], GREY, 6)
    return drawing


DRAWINGS = {"flow.svg": flow, "parts.svg": parts, "frames.svg": frames, "sign.svg": sign}

if __name__ == "__main__":
    for name, drawn in DRAWINGS.items():
        (IMAGES / name).write_text(drawn().svg(), encoding="utf-8")
