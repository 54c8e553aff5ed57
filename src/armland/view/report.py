"""Figures, tables and result of a run from its log, whichever mission it is of."""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from armland.errors import LogError
from armland.experiments.episode import result_of_log
from armland.experiments.paper import judged
from armland.runtime.log import Log
from armland.view.flown import flown
from armland.view.tables.flight import print_flight
from armland.view.tables.paper import print_paper


@contextmanager
def _doubted() -> Iterator[None]:
    # A log is input: what does not fit together in it is its fault, not this program's.
    try:
        yield
    except (ArithmeticError, LookupError, TypeError, ValueError) as e:
        raise LogError(f"the log's messages and metadata do not fit together: {type(e).__name__}: {e}") from e


def result_of(logs: Sequence[Log]) -> dict[str, Any]:
    """Result of one run, or of experiments of the paper together, as in their result.json; what a log cannot know is left out.

    Raises:
        LogError: a log that is of another version, or several of which one is no experiment.
    """
    with _doubted():
        runs = {run.name: run for run in map(flown, logs)}
        if len(logs) == 1:
            return result_of_log(logs[0])
        untracked = [name for name, run in runs.items() if not run.brief.legs]
        if untracked:
            raise LogError(f"{', '.join(untracked)}: no experiment that follows a path; give one log at a time")
        return judged({name: (run.ticks, run.brief) for name, run in sorted(runs.items())})


def succeeded(result: Mapping[str, Any]) -> bool:
    """Whether the flight succeeded, or all verdicts on experiments hold."""
    return (
        all(v["holds"] is not False for v in result["verdicts"]) if "experiments" in result else bool(result["success"])
    )


def draw(out: Path, logs: Sequence[Log]) -> list[Path]:
    """Write the figures of one run, or of experiments of the paper together, into the folder `out`; returns the files' paths.

    Raises:
        LogError: a log that holds too little for them.
        PictureError: no OpenGL for the picture of the scene; the other figures are there then.
    """
    from armland.view.figures.flight import draw_flight
    from armland.view.figures.paper import draw_paper_figures, draw_scene

    with _doubted():
        runs = [flown(log) for log in logs]
        if all(run.brief.legs for run in runs):
            return [*draw_paper_figures(out, runs), draw_scene(out, logs[0])]
        return [path for run in runs for path in draw_flight(out, run)]


def write_report(out: Path, logs: Sequence[Log], result: Mapping[str, Any]) -> Path:
    """Write the page of one run, or of experiments of the paper together, into the folder `out`; returns its path.

    Raises:
        LogError: a log that holds too little for it.
    """
    from armland.view.page.flight import flight_sheet
    from armland.view.page.sheet import write_page
    from armland.view.page.study import paper_sheet

    with _doubted():
        sheet = paper_sheet(logs, result) if "experiments" in result else flight_sheet(logs[0], result)
        return write_page(out, sheet)


def print_run(result: Mapping[str, Any], log: Log | None, out: Path) -> None:
    """Print the tables of a result; what needs the log is left out without one."""
    if "experiments" in result:
        print_paper(result, out)
    else:
        print_flight(result, None if log is None else flown(log), out)
