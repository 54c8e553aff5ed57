"""The map of wind and sea says what its store has, with what the UAV can do by itself beside it."""

import numpy as np

from pages.weather import axes_of, deck_speed, markdown, page, winds_held

FOUND = {
    (s, w): (good, 8)
    for s, goods in {"calm": (8, 6), "ss3": (7, 0)}.items()
    for w, good in zip((8.0, 12.0), goods, strict=True)
}


def test_axes_rise_and_calm_comes_first():
    assert axes_of({("ss3", 12.0): (1, 8), ("calm", 1.0): (8, 8), ("ss1", 4.0): (8, 8)}) == (
        ["calm", "ss1", "ss3"],
        [1.0, 4.0, 12.0],
    )


def test_table_has_landings_with_their_interval():
    head, _, *rows = markdown(FOUND).splitlines()
    assert head == "| wind at 20 ft | calm | ss3 |"
    assert rows == [
        "| 8 m/s | 8 of 8 (68 to 100 %) | 7 of 8 (53 to 98 %) |",
        "| 12 m/s | 6 of 8 (41 to 93 %) | 0 of 8 (0 to 32 %) |",
    ]


def test_stronger_gusts_are_held_in_less_wind_and_the_map_shows_them():
    held = list(winds_held())
    assert [k for k, _ in held] == [1.0, 2.0, 3.0]
    assert (np.diff([w for _, w in held]) < -1.0).all()
    figure = page(FOUND)
    lines = [float(line.get_xdata()[0]) for line in figure.axes[0].lines]
    assert {w for _, w in held} <= set(lines)


def test_deck_outruns_the_arm_between_sea_states_3_and_4():
    """Significant speeds of a 4 m hull, facts of `docs/sea.md`: 0.18, 0.47 and 0.88 m/s; the catch's lever adds some."""
    np.testing.assert_allclose([deck_speed(s) for s in ("ss2", "ss3", "ss4")], [0.18, 0.47, 0.88], rtol=0.1)
