from pathlib import Path
from xml.etree import ElementTree

import pytest

from pages.drawings import DRAWINGS, IMPORTS, PLACES

IMAGES = Path(__file__).parents[3] / "docs" / "images"
SVG = "{http://www.w3.org/2000/svg}"


@pytest.mark.parametrize("name", DRAWINGS)
def test_drawing_is_up_to_date(name: str) -> None:
    assert (IMAGES / name).read_text("utf-8") == DRAWINGS[name]().svg(), (
        "run: PYTHONPATH=tools python -m pages.drawings"
    )


@pytest.mark.parametrize("name", DRAWINGS)
def test_drawing_has_a_title_and_stays_within_its_frame(name: str) -> None:
    root = ElementTree.fromstring(DRAWINGS[name]().svg())
    _, _, width, height = map(float, root.get("viewBox", "").split())
    assert root.findtext(f"{SVG}title")
    for box in root.iter(f"{SVG}rect"):
        x, y, w, h = (float(box.get(k, "nan")) for k in ("x", "y", "width", "height"))
        assert x >= 0
        assert y >= 0
        assert x + w <= width
        assert y + h <= height
    for line in [*root.iter(f"{SVG}polyline"), *root.iter(f"{SVG}polygon")]:
        for point in line.get("points", "").split():
            x, y = map(float, point.split(","))
            assert 0 <= x <= width
            assert 0 <= y <= height


def test_every_part_has_a_place_and_no_two_overlap() -> None:
    assert {part for arrow in IMPORTS for part in arrow} == set(PLACES)
    places = list(PLACES.values())
    assert all(abs(a[0] - b[0]) > 60 or abs(a[1] - b[1]) > 34 for i, a in enumerate(places) for b in places[:i])
