"""The marker study as Markdown: what the camera sees of the marker, and the errors of detector and model."""

from collections.abc import Sequence

from armland.experiments.envelope.sight import Band
from armland.view.figures.markers import UNITS
from armland.vision.study import Row


def errors_table(rows: Sequence[Row]) -> str:
    """The study as Markdown: root mean squares for each axis of detector on ideal and honest pictures, model, published."""
    lines = ["| distance m | found % | lateral mm | depth mm | tilt ° | yaw ° |", "|---|---|---|---|---|---|"]
    for r in rows:
        found = " / ".join(f"{100.0 * e.found:.0f}" for e in (r.ideal, r.honest, r.model))
        cells = []
        for k in range(4):
            values = [UNITS[k] * e[1 + k] for e in (r.ideal, r.honest, r.model)]
            if k < 2:
                values.append(1e3 * (r.published_lateral_m, r.published_depth_m)[k])
            cells.append(" / ".join(f"{v:.2g}" for v in values))
        lines.append(f"| {r.distance_m:g} | {found} | {' | '.join(cells)} |")
    note = "Each cell: detector on ideal pictures / on honest ones / the measurement model / published (position only)."
    return "\n".join([*lines, "", note])


def sight_table(bands: Sequence[Band]) -> str:
    """What share of the marker's face, margin included, the camera sees on a landing, as Markdown."""
    lines = ["| distance m | images | least share of the marker seen | hidden by |", "|---|---|---|---|"]
    for b in bands:
        what = ", ".join(b.hidden_by) or "nothing"
        lines.append(f"| {b.near_m:g} to {b.far_m:g} | {b.exposures} | {100.0 * b.least_seen:.0f} % | {what} |")
    return "\n".join(lines)
