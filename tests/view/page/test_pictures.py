import base64
import io
import re

import numpy as np
import pytest
from PIL import Image

from armland.view.figures.canvas import DESIRED, sheet
from armland.view.figures.flight import overview_figure
from armland.view.page.pictures import COLORS, drawing, photograph, screen_style


@pytest.fixture(scope="module")
def overview(landed):
    return drawing("overview", "Over time", "What it shows.", lambda: overview_figure(landed))


def test_figure_takes_the_colours_of_the_page(overview) -> None:
    found = set(re.findall(r"#[0-9a-f]{6}\b", overview.svg.lower()))
    assert not found & COLORS.keys()
    for color in ("currentColor", "var(--blue)", "var(--vermilion)", "var(--green)", "var(--grid)", "var(--shade)"):
        assert color in overview.svg


def test_letters_stay_letters_and_numbers_are_short(overview) -> None:
    assert "hinge force (N)" in overview.svg
    assert overview.svg.count("<text") > 40
    assert not re.search(r"\d\.\d{3,}", overview.svg.split(">", 1)[1])
    assert len(overview.svg) < 400_000


@pytest.mark.slow
def test_names_of_two_figures_do_not_clash(landed) -> None:
    one, two = (drawing(n, "t", "w", lambda: overview_figure(landed)).svg for n in ("one", "two"))
    ids = [set(re.findall(r'\bid="([^"]+)"', svg)) for svg in (one, two)]
    assert ids[0]
    assert not ids[0] & ids[1]
    used = set(re.findall(r'url\(#([^)]+)\)|href="#([^"]+)"', one))
    assert {a or b for a, b in used} <= ids[0]


@pytest.mark.slow
def test_same_figure_gives_the_same_bytes(landed, overview) -> None:
    assert drawing("overview", "Over time", "What it shows.", lambda: overview_figure(landed)) == overview


@pytest.mark.slow
def test_nothing_covers_anything_in_the_letters_of_screens(landed) -> None:
    with screen_style():
        figure = overview_figure(landed)
        figure.draw_without_rendering()
        labels = [axes.yaxis.label.get_window_extent() for axes in figure.axes[1:]]
    assert not any(a.overlaps(b) for i, a in enumerate(labels) for b in labels[:i])


def test_wide_legend_breaks_into_lines() -> None:
    def make():
        figure = sheet(6.0, 3.0)
        axes = figure.subplots()
        for i in range(4):
            axes.plot([0, 1], [0, i], label=f"a rather long name of a line, number {i}", **DESIRED)
        figure.legend(*axes.get_legend_handles_labels(), loc="outside upper center", ncols=4)
        made.append(figure)
        return figure

    made = []
    drawing("x", "t", "w", make)
    assert made[0].legends[0].get_window_extent().width <= made[0].bbox.width


def test_picture_stands_in_the_page() -> None:
    picture = np.zeros((40, 60, 3), np.uint8)
    picture[:, 30:] = (200, 100, 50)
    address = photograph(picture)
    back = np.asarray(Image.open(io.BytesIO(base64.b64decode(address.partition(",")[2]))).convert("RGB")).astype(int)
    assert back.shape == (40, 60, 3)
    assert np.abs(back - picture).mean() < 4.0
