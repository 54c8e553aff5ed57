"""A flight that is put back to a moment flies on from there as it did."""

import numpy as np
import pytest

from armland.errors import PlantError
from armland.experiments.snapshot import Flight, quiet
from armland.mission.landing_scenario import landing_scenario


def fly_on(flight: Flight, ticks: int) -> bytes:
    rows = []
    for _ in range(ticks):
        flight.step()
        rows.append(flight.tick.buffer.tobytes())
    return b"".join(rows)


def test_flies_on_bit_for_bit_after_being_put_back():
    flight = Flight(landing_scenario())
    flight.fly_until(lambda: flight.controller.phase == "guide", "its station")
    first = fly_on(flight, 150)
    flight.devices["force"][0, 0] = 1.0
    flight.step()
    flight.restore()
    assert fly_on(flight, 150) == first
    # A push that is left out of what is put back would show.
    flight.restore()
    flight.devices["force"][0, 0] = 1.0
    assert fly_on(flight, 150) != first


def test_a_moment_that_never_comes_is_an_error():
    flight = Flight(landing_scenario("landing", {"duration_s": 1.0}))
    with pytest.raises(PlantError, match="never came to the moon"):
        flight.fly_until(lambda: False, "the moon")


def test_quiet_seeds_fly_alike():
    starts = []
    for seed in (1, 2):
        flight = Flight(quiet(landing_scenario("landing", {"seed": seed})))
        for _ in range(20):
            flight.step()
        starts.append(flight.tick.truth["r"][0].copy())
    np.testing.assert_array_equal(*starts)
