import re
from pathlib import Path

import matplotlib
import numpy as np
import pytest
from matplotlib.colors import to_hex
from matplotlib.figure import Figure

from armland.errors import LogError
from armland.view.figures.canvas import DPI, drawn, paper_style
from armland.view.figures.curves import clocked
from armland.view.figures.paper import FIGURES, PUBLISHED_DEG, attitude_figure, draw_paper_figures, position_figure
from armland.view.flown import Flown


@pytest.fixture(scope="module")
def runs(make_run) -> list[Flown]:
    return [make_run("E1", 9.0), make_run("E2", 6.5, offset_mm=1.0), make_run("E3", 6.0, offset_mm=0.5)]


@pytest.fixture(scope="module")
def figures(runs) -> dict[str, Figure]:
    with paper_style():
        drawn = {name: draw(clocked(runs)) for name, draw in FIGURES.items()}
        for figure in drawn.values():
            figure.draw_without_rendering()
    return drawn


@pytest.fixture(scope="module")
def files(runs, tmp_path_factory) -> list[Path]:
    return draw_paper_figures(tmp_path_factory.mktemp("out") / "new" / "folder", runs)


def png_size(path: Path) -> tuple[int, int]:
    head = path.read_bytes()[:24]
    assert head[:8] == b"\x89PNG\r\n\x1a\n"
    return int.from_bytes(head[16:20], "big"), int.from_bytes(head[20:24], "big")


def test_every_figure_is_written_as_pdf_and_png(files, figures) -> None:
    assert {f.name for f in files} == {f"{name}.{kind}" for name in FIGURES for kind in ("pdf", "png")}
    for file in files:
        assert file.stat().st_size > 5000
        if file.suffix == ".png":
            expected = figures[file.stem].get_size_inches() * DPI
            assert png_size(file) == pytest.approx(tuple(expected), abs=1.0)
        else:
            assert file.read_bytes().startswith(b"%PDF")


@pytest.mark.slow
def test_same_runs_give_the_same_bytes(files, runs, tmp_path) -> None:
    again = draw_paper_figures(tmp_path, runs)
    assert [f.name for f in files if f.read_bytes() != (tmp_path / f.name).read_bytes()] == []
    assert len(again) == len(files)
    assert not any(b"CreationDate" in f.read_bytes() for f in files)


def test_users_matplotlib_settings_neither_matter_nor_change(files, runs, tmp_path) -> None:
    with matplotlib.rc_context({"font.size": 20.0, "axes.facecolor": "red", "pdf.fonttype": 3}):
        before = dict(matplotlib.rcParams)
        drawn(tmp_path, {"fig6a_attitude": lambda: attitude_figure(clocked(runs))})
        assert dict(matplotlib.rcParams) == before
    reference = next(f for f in files if f.name == "fig6a_attitude.pdf")
    assert (tmp_path / "fig6a_attitude.pdf").read_bytes() == reference.read_bytes()


def test_every_axis_carries_its_unit(figures) -> None:
    for name, figure in figures.items():
        for axes in figure.axes:
            assert re.search(r" \((m|mm|N|N·m|°|1)\)$", axes.get_ylabel()), name
        assert figure.axes[-1].get_xlabel().endswith("(s)") or figure.axes[0].get_xlabel().endswith("(s)"), name


def test_a_run_has_the_same_colour_everywhere(figures) -> None:
    colours: dict[str, set[str]] = {}
    for figure in figures.values():
        for line in (line for axes in figure.axes for line in axes.get_lines()):
            name = re.match(r"E[123]|desired", str(line.get_label()))
            if name:
                colours.setdefault(name[0], set()).add(to_hex(line.get_color()))
    assert sorted(colours) == ["E1", "E2", "E3", "desired"]
    assert all(len(used) == 1 for used in colours.values())
    assert len(set.union(*colours.values())) == 4


def test_nothing_covers_anything(figures) -> None:
    for name, figure in figures.items():
        panels = [axes.get_window_extent() for axes in figure.axes]
        texts = [axes.get_tightbbox() for axes in figure.axes]
        for legend in figure.legends:
            assert not any(legend.get_window_extent().overlaps(box) for box in texts), name
        for i, box in enumerate(texts):
            assert not any(box.overlaps(other) for j, other in enumerate(panels) if i != j), name
            assert min(box.x0, box.y0) >= 0.0, name
            assert (box.max <= figure.bbox.max).all(), name


def labels(figure: Figure) -> str:
    return " | ".join(text.get_text() for legend in figure.legends for text in legend.get_texts())


def test_published_maxima_are_labelled_lines(figures) -> None:
    (axes,) = figures["fig6a_attitude"].axes
    levels = [line.get_ydata()[0] for line in axes.get_lines() if len(line.get_xdata()) == 2]
    assert sorted(levels) == sorted(PUBLISHED_DEG.values())
    texts = [text.get_text() for text in axes.texts]
    assert texts == ["E1 in the paper: 9.2°", "E2 in the paper: 6.8°"]


def test_settling_is_not_judged(make_run) -> None:
    run = make_run(swing_deg=5.0)
    half = 0.5 * np.deg2rad(30.0)
    run.ticks["truth"]["quat"][10] = [np.cos(half), np.sin(half), 0.0, 0.0]
    run.ticks["truth"]["r"][10] += 1.0
    with paper_style():
        on_clock = clocked([run])
        assert labels(attitude_figure(on_clock)) == "E1, max. 5.0°"
        assert "max. 2.0 mm" in labels(position_figure(on_clock, 0))
        on_clock = clocked([run._replace(brief=make_run(settle_s=0.0).brief)])
        assert labels(attitude_figure(on_clock)) == "E1, max. 30.0°"


def test_other_names_and_lengths_are_drawn_too(make_run) -> None:
    on_clock = clocked([make_run("mine"), make_run("yours", seconds=2.0)])
    with paper_style():
        for name, draw in FIGURES.items():
            figure = draw(on_clock)
            assert figure.axes[-1].get_xlim()[1] == pytest.approx(2.5, abs=0.02), name


def test_no_runs_is_an_error_and_writes_nothing(tmp_path) -> None:
    with pytest.raises(LogError, match="no run to draw"):
        draw_paper_figures(tmp_path / "out", [])
    assert not (tmp_path / "out").exists()
