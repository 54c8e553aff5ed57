"""What is said of a rare failure: on the terminal, on the page, and for a plain campaign that counted it."""

import math
from pathlib import Path

import pytest

from armland.experiments.campaign.answers.report import Report
from armland.experiments.campaign.description import Failure
from armland.experiments.campaign.rare.answer import Counted, Learnt, Place, RareReport
from armland.experiments.campaign.rare.estimate import Rate
from armland.experiments.campaign.stopping import Interval
from armland.view.campaign.page import page
from armland.view.campaign.rare import counted_lines, level, rare_lines, share, where_heads
from armland.view.campaign.terminal import print_report

FOUND = RareReport(
    failure="touchdown speed above 0.2 m/s",
    stages=(Learnt(100, 3, -0.02), Learnt(100, 41, 0.0)),
    flights=1200,
    rate=Rate(2.5e-6, 0.1, Interval(2e-6, 3.1e-6), 1000, 400, 4e7),
    equal=80.0,
    places=(Place("air.wind_mps", (3.0, 6.0, 9.0), (10.5, 11.0, 12.5)),),
)


@pytest.fixture
def rare(made):
    """Store, report and table of a campaign of which there is only the rate of a rare failure."""
    file, report, table = made
    return file, report._replace(points=(), pairings=(), rare=FOUND), table


def test_rate_interval_and_what_it_took_are_said_in_sentences():
    lines = rare_lines(FOUND)
    assert lines[0] == "Rate of failure (touchdown speed above 0.2 m/s): 2.50e-06, with 95 % from 2.00e-06 to 3.10e-06."
    assert "Coefficient of variation 10 %. It took 1200 flights: 200 in 2 stages of learning, and 1000" in lines[1]
    assert "of which 400 failed" in lines[1]
    assert lines[2] == "Plain flights for the same: 4e+07, 3.3e+04 times as many."
    assert len(lines) == 3


def test_doubt_is_said_last():
    few = FOUND._replace(equal=3.0)
    assert "as if 3.0 had been seen: the interval may be too narrow" in rare_lines(few)[-1]
    none = FOUND._replace(rate=Rate(0.0, math.inf, Interval(0.0, 0.03), 1000, 0, math.inf), equal=0.0, places=())
    said = rare_lines(none)
    assert "0, with 95 % from 0 to 0.03" in said[0]
    assert not any("Plain flights for the same" in line for line in said)
    assert "only an upper bound is known" in said[-1]
    slow = FOUND._replace(rate=FOUND.rate._replace(plain=900.0))
    assert "plain flights, without --rare, would have done as well" in rare_lines(slow)[-1]
    learning = FOUND._replace(rate=None, flights=200)
    assert rare_lines(learning)[0].endswith("not known yet, after 200 flights in 2 stages of learning.")


def test_terminal_has_the_stages_and_where_failures_are(rare, capsys):
    file, report, _ = rare
    print_report(report, file, Path("out"))
    text = " ".join(capsys.readouterr().out.split())
    for words in ("Rate of failure", "Stages of learning", "-0.02", "Where failures are", "12.5", "The worst flights"):
        assert words in text
    assert "Success" not in text
    assert "seed by seed" not in text


def test_page_has_the_rate_and_no_table_of_success(rare):
    file, report, table = rare
    text = page(report, table, file)
    assert "<h2>The rate of a rare failure</h2>" in text
    assert "2.00e-06 to 3.10e-06" in text
    assert "<td>10.5</td><td>11</td><td>12.5</td>" in text
    assert "<h2>Success</h2>" not in text
    assert "Wilson" not in text


def test_plain_campaign_says_how_many_failed_as_its_file_asks(made):
    _, report, _ = made
    asked = report.campaign.description.model_copy(
        update={"failure": Failure(figure="hinge_force_max_n", above=30.0, stage=20)}
    )
    found: Report = report._replace(
        campaign=report.campaign._replace(description=asked), counted=(Counted(0, 120, 3, Interval(0.008, 0.07)),)
    )
    assert counted_lines(found) == [
        f"Hinge force max above 30 N, {report.points[0].name}: 3 of 120, 0.025, with 95 % from 0.008 to 0.07."
    ]
    assert counted_lines(report) == []


def test_numbers_are_read_as_rare_ones_are():
    assert [share(x) for x in (0.0, 0.25, 0.00123, 4.56e-7)] == ["0", "0.25", "0.00123", "4.56e-07"]
    assert [level(x) for x in (None, -math.inf, -0.0123, 0.0)] == ["-", "-", "-0.0123", "0"]
    assert where_heads() == ["all 5 %", "all 50 %", "all 95 %", "failing 5 %", "failing 50 %", "failing 95 %"]
