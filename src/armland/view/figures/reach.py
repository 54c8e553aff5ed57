"""Where an arm can land, on one page: the catch by distance and height, the cradle by distance and heading."""

from pathlib import Path

from matplotlib.figure import Figure

from armland.experiments.reach import Reach
from armland.view.figures.canvas import PAGE_IN, drawn, sheet


def draw_reach(out: Path, found: Reach) -> list[Path]:
    """Write reach as PDF and PNG into the folder `out`, and return the files' paths."""
    return drawn(out, {"reach": lambda: reach_figure(found)}) if found.spots else []


def reach_figure(found: Reach) -> Figure:
    """The page; the darker, the further from what the supervisor stops the arm at."""
    figure = sheet(PAGE_IN, 3.0)
    catch, cradle = figure.subplots(1, 2)
    spots = sorted(found.spots, key=lambda s: s.merit)
    merit = [s.merit for s in spots]
    dots = catch.scatter([s.radius_m for s in spots], [s.height_m for s in spots], c=merit, cmap="viridis_r", s=14)
    cradle.scatter([s.distance_m for s in spots], [s.heading_deg for s in spots], c=merit, cmap="viridis_r", s=14)
    catch.set(title="catch", xlabel="distance from the first axis (m)", ylabel="height (m)")
    headings = sorted({s.heading_deg for s in spots})
    cradle.set(title="cradle", xlabel="distance from the first axis (m)", ylabel="heading (°)", yticks=headings)
    cradle.set_ylim(min(headings) - 45.0, max(headings) + 45.0)
    catch.plot(found.radius_m, found.asked.place.catch_m[2], "k+", markersize=9, label="asked for")
    catch.legend(loc="lower left")
    figure.colorbar(dots, ax=(catch, cradle), label="merit (1)")
    return figure
