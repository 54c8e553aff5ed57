"""Pictures show the numbers of the report."""

import numpy as np
import pytest
from matplotlib.figure import Figure

from armland.experiments.campaign.answers.sensitivity import Sensitivity
from armland.view.campaign.pictures import as_source, pictures, rates, slices, spreads, success_map


def test_rates_are_points_with_their_intervals(made):
    _, report, _ = made
    figure = rates(report)
    (axes,) = figure.axes
    (container,) = axes.containers
    shown = container.lines[0].get_xdata()
    assert shown == pytest.approx([100.0 * p.successes / p.flights for p in report.points])
    ends = container.lines[2][0].get_segments()[0][:, 0]
    assert ends == pytest.approx([100.0 * x for x in report.points[0].wilson])
    assert [t.get_text() for t in axes.get_yticklabels()] == [p.name for p in report.points]


def test_map_counts_flights_and_successes(made):
    _, report, table = made
    figure = success_map(report, table)
    axes = figure.axes[0]
    assert axes.get_xlabel() == "sea.state"
    assert axes.get_ylabel() == "air.wind_mps"
    counted = sum(int(t.get_text().partition("(")[2].rstrip(")")) for t in axes.texts)
    assert counted == len(table.run)
    shown = axes.images[0].get_array()
    assert shown[0].min() > 90.0
    assert shown[-1, 1] < 20.0


def test_spreads_have_a_panel_each_with_the_bound(made):
    _, report, table = made
    figure = spreads(report, table)
    (force,) = [a for a in figure.axes if a.get_xlabel().startswith("hinge force")]
    assert any(line.get_xdata()[0] == 40.0 for line in force.lines)
    assert len(force.lines) == 3


def test_slices_begin_with_what_matters_most(made):
    _, report, table = made
    figure = slices(report, table)
    assert figure.axes[0].get_xlabel() == "air.wind_mps"
    rate = figure.axes[0].containers[0].lines[0].get_ydata()
    assert rate[0] > rate[-1] + 50.0


def test_what_would_show_nothing_is_left_out(made):
    _, report, table = made
    one = report._replace(points=report.points[:1])
    assert rates(one) is None
    assert success_map(report._replace(sensitivity=Sensitivity((), ())), table._replace(values={})) is None
    assert spreads(report, table._replace(figures={})) is None
    assert isinstance(spreads(report, table), Figure)


def test_pictures_are_text_that_stands_in_a_page_and_repeats(made):
    _, report, table = made
    found = pictures(report, table)
    assert len(found) == 4
    assert all(svg.lstrip().startswith("<?xml") and "</svg>" in svg for svg in found.values())
    assert as_source("<svg/>") == "data:image/svg+xml;base64,PHN2Zy8+"
    assert np.isfinite(report.cpu_s)
