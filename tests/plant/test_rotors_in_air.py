"""What motion through the air does to the simulated rotors: as momentum theory has it, and nothing where it is switched off."""

import numpy as np
import pytest

from armland.mission.landing_scenario import landing_scenario
from armland.mission.landing_setup import set_up
from armland.mission.launch import rotors_of
from armland.mission.records import LandingTick
from armland.models.inflow import factor_at_speed
from armland.plant.landing import LandingPlant
from armland.rotations import from_rotation_vector, matrix

HOME = set_up(landing_scenario()).home


class Bench:
    """The plant's actuation with the UAV at a velocity and an attitude that no physics has made."""

    def __init__(self, **rotors):
        self.scenario = landing_scenario("landing", {"rotors": rotors})
        self.plant, self.tick = LandingPlant(self.scenario, HOME), LandingTick(7)
        self.tick.command["uav_quat"][0, 0] = 1.0
        self.plant.connect()
        self.plant.read(self.tick)

    def force(self, velocity, turn=(0.0, 0.0, 0.0), rate=(0.0, 0.0, 0.0), air=(0.0, 0.0, 0.0)):
        """Wrench (6,) on the UAV, world, and the static thrusts (4,)."""
        truth = self.tick.truth
        truth["v_cm"], truth["omega"] = velocity, rate
        truth["quat"] = from_rotation_vector(np.array(turn))
        self.plant._state["air"] = air
        # Between two samples on board, so that all benches ask the same of their rotors.
        self.plant._tick = 1
        self.plant.command(self.tick)
        return self.plant.data.xfrc_applied[self.plant.scene.uav_body].copy(), self.plant._state["rotor"][0].copy()


@pytest.mark.parametrize("velocity", [(0.0, 0.0, 0.0), (0.5, -0.3, 0.0), (0.0, 0.0, 0.4), (2.0, 0.0, -0.5)])
@pytest.mark.parametrize("turn", [(0.0, 0.0, 0.0), (0.2, -0.1, 0.4)])
def test_thrust_is_momentum_theorys_and_drag_is_linear(velocity, turn):
    bench = Bench()
    applied, static = bench.force(velocity, turn)
    rotors, R = (
        rotors_of(bench.scenario.landing, bench.scenario.demonstrator),
        matrix(from_rotation_vector(np.array(turn))),
    )
    body = R.T @ np.array(velocity)
    t = [
        factor_at_speed(s, np.hypot(body[0], body[1]), body[2], rotors.disc, rotors.slope, rotors.advance)
        for s in static
    ]
    expected = (static @ t) * R[:, 2] - 0.22 * np.array([velocity[0], velocity[1], 0.0])
    np.testing.assert_allclose(applied[:3], expected, rtol=1e-9, atol=1e-12)


def test_only_motion_through_the_air_counts():
    still, _ = Bench().force((0.0, 0.0, 0.0))
    with_the_wind, _ = Bench().force((1.0, 0.5, 0.2), air=(1.0, 0.5, 0.2))
    np.testing.assert_allclose(with_the_wind, still, atol=1e-12)


def test_climb_costs_thrust_and_forward_speed_gains_it():
    still, climb, forward = (Bench(drag_nspm=0.0).force(v)[0][2] for v in ((0, 0, 0), (0, 0, 0.5), (1.0, 0, 0)))
    assert climb < still < forward


def test_a_roll_is_damped_by_its_own_rotors():
    still, rolling = Bench().force((0, 0, 0))[0][3], Bench().force((0, 0, 0), rate=(3.0, 0.0, 0.0))[0][3]
    assert rolling < still - 5e-3


def test_switched_off_nothing_is_felt():
    still, moving = (Bench(inflow=False, drag_nspm=0.0).force(v)[0] for v in ((0, 0, 0), (1.0, 0.0, 0.5)))
    np.testing.assert_array_equal(still, moving)
