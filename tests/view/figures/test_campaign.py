"""Page of a campaign: one panel per figure, every flight in it."""

import numpy as np

from armland.view.figures.campaign import campaign_page, draw_campaign

BOUNDS = {"touchdown.offset_m": 0.01}


def test_page_has_a_panel_for_each_figure_and_shows_every_flight(make_row):
    page = campaign_page([make_row(i, 0.01 * i) for i in range(1, 6)], BOUNDS)
    (panel,) = (a for a in page.axes if a.get_xlabel().startswith("touchdown speed"))
    shown = np.concatenate([line.get_xdata() for line in panel.lines[:2]])
    np.testing.assert_allclose(np.sort(shown), [0.01, 0.02, 0.03, 0.04, 0.05])
    assert not any(a.get_xlabel().startswith("release") for a in page.axes)


def test_bound_is_drawn_in_the_unit_of_its_panel(make_row):
    page = campaign_page([make_row(1, 0.02)], BOUNDS)
    (panel,) = (a for a in page.axes if a.get_xlabel().startswith("off centre"))
    assert panel.lines[-1].get_xdata()[0] == 10.0


def test_page_of_flights_that_broke_is_empty_and_no_error():
    assert campaign_page([{"seed": 1, "success": False, "reason": "broke"}], BOUNDS).axes


def test_files_repeat_byte_for_byte(tmp_path, make_row):
    flights = [make_row(1, 0.02), make_row(2, 0.03)]
    first = [p.read_bytes() for p in draw_campaign(tmp_path / "a", flights, BOUNDS, "landing")]
    second = [p.read_bytes() for p in draw_campaign(tmp_path / "b", flights, BOUNDS, "landing")]
    assert first == second
