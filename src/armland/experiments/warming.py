"""What a flight compiles, as pieces of work for `compiled.warming`: the linked functions, and what calls them."""

from typing import Any

import numpy as np
from numba import typeof

from armland.linking import LINKED
from armland.mission.board import new_board
from armland.mission.controller import Controller
from armland.mission.plan import plan
from armland.plant.block import fly_block
from armland.plant.simulator import Simulator
from armland.plant.world import world_layout
from armland.records import Records, tick_layout
from armland.scenario import load_scenario

HERE = __name__


def pieces(joints: int) -> list[tuple[str, str]]:
    """Calls and their argument, the longest first, for an arm with `joints` joints."""
    # What a function calls stands before it in the list and has the most below it.
    linked = [(f"{HERE}:compile_linked", f"{function.name}:{joints}") for function in LINKED]
    return [(f"{HERE}:compile_block", str(joints)), *linked]


def compile_linked(which: str) -> None:
    """Compile a linked function alone, `which` being its name and the number of joints; nothing of it can be run in this process."""
    name, joints = which.split(":")
    for function in LINKED:
        function.expect(int(joints))
    for function in LINKED:
        if function.name == name:
            function.dispatcher.compile(tuple(function.types_of(int(joints))))


def compile_block(joints: str) -> None:
    """Compile the block that flies an arm with `joints` joints; none of it is flown in this process."""
    n = int(joints)
    for function in LINKED:
        function.expect(n)
    fly_block.compile(block_types(n))


def block_types(joints: int) -> tuple[Any, ...]:
    """Numba's types of the arguments of `fly_block`: those of a landing of the arm that comes with armland, but for the records."""
    made = plan(load_scenario("landing"), "landing")
    for function in LINKED:
        function.expect(made.joints)
    simulator, controller = Simulator(made.scenario, made.home, made.mission.start, made.names), Controller(made)
    rows: Records = np.zeros(1, tick_layout(joints))
    k, _, views, noise, physics, (_, path, arm), watch, _ = simulator.block_arguments(controller, rows)
    world: Records = np.zeros(1, world_layout(joints))
    return tuple(map(typeof, (k, world, views, noise, physics, (new_board(joints), path, arm), watch, rows)))
