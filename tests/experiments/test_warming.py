"""What is compiled beforehand is what a flight calls, for any number of joints."""

import numpy as np
from numba import typeof

from armland.experiments.episode import prepare
from armland.experiments.warming import block_types, pieces
from armland.linking import LINKED
from armland.scenario import load_scenario


def called(flight):
    """Numba's types of what a block of the flight is called with."""
    rows = np.zeros(1, flight.controller.tick.buffer.dtype)
    return tuple(map(typeof, flight.simulator.block_arguments(flight.controller, rows)))


def test_block_is_compiled_for_the_types_that_a_flight_calls_it_with():
    flight = prepare(load_scenario("landing"), "landing")
    assert block_types(7) == called(flight)
    assert block_types(6) != block_types(7)


def test_every_linked_function_is_a_piece_of_work_for_each_number_of_joints():
    for joints in (6, 8):
        asked = [argument for call, argument in pieces(joints) if call.endswith(":compile_linked")]
        assert asked == [f"{function.name}:{joints}" for function in LINKED]


def test_what_sees_no_joint_is_the_same_for_every_arm():
    same = {f.name for f in LINKED if f.types_of(6) == f.types_of(7)}
    assert {"held_law", "held_lyapunov", "follow", "look"} <= same
    assert {"act", "sense", "actuate", "estimate"}.isdisjoint(same)
