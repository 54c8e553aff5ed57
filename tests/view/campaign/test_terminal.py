"""A report on the terminal says what there is, and how to fly the worst again."""

from pathlib import Path

import pytest

from armland.experiments.campaign.answers.sensitivity import Influence
from armland.view.campaign.terminal import fails_with, headline, interval_of, percent, print_report


def test_everything_is_said(made, capsys):
    file, report, _ = made
    print_report(report, file, Path("out"))
    text = " ".join(capsys.readouterr().out.split())
    for words in (
        "Wind & <load>: 240 of 240 flights; no flights: 1 refused",
        "sea.state = ss2",
        "Against sea.state = calm, seed by seed",
        "What success depends on",
        "air.wind_mps",
        "lost at",
        "refused: no place",
        f"replay {file} {report.worst[0].run} flies the first of them again",
    ):
        assert words.replace(" ", "") in text.replace(" ", ""), words


def test_rates_near_the_ends_have_more_digits():
    assert [percent(x) for x in (0.0, 0.004, 0.5, 0.995, 1.0)] == ["0.0", "0.40", "50.0", "99.50", "100.0"]


def test_interval_is_that_of_all_looks_where_somebody_looked(made):
    _, report, _ = made
    point = report.points[0]
    assert interval_of(report, point) == point.wilson
    early = report._replace(until=0.01)
    assert interval_of(early, point) == point.always
    assert "until intervals are ±1 %" in headline(early)


@pytest.mark.parametrize(
    ("share", "chance", "trend", "names", "words"),
    [
        (0.4, 1e-9, 0.5, ("a",), "more"),
        (0.4, 1e-9, -0.5, ("a",), "less"),
        (0.4, 1e-9, 0.0, ("a",), "some"),
        (0.4, 0.3, 0.5, ("a",), "-"),
        (0.4, 1e-9, 0.0, ("a", "b"), "the combination"),
    ],
)
def test_what_failure_comes_with(share, chance, trend, names, words):
    assert fails_with(Influence(names, share, chance, trend)) == words
