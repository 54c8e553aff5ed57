"""What a flight compiles, as pieces of work for `compiled.warming`: the linked functions, and what calls them."""

import numpy as np
from numba import typeof

from armland.linking import LINKED
from armland.mission.controller import Controller
from armland.mission.plan import plan
from armland.plant.block import fly_block
from armland.plant.simulator import Simulator
from armland.scenario import load_scenario

JOINTS = 7  # Of the arm that comes with armland; for another one code is compiled when it first flies

HERE = __name__


def pieces() -> list[tuple[str, str]]:
    """Calls and their argument, the longest first."""
    # What a function calls stands before it in the list and has the most below it.
    return [(f"{HERE}:compile_flight", "landing"), *((f"{HERE}:compile_linked", f.name) for f in LINKED)]


def compile_linked(name: str) -> None:
    """Compile the linked function `name` alone; nothing of it can be run in this process."""
    for function in LINKED:
        function.expect(JOINTS)
    for function in LINKED:
        if function.name == name:
            function.dispatcher.compile(tuple(function.types_of(JOINTS)))


def compile_flight(mission: str) -> None:
    """Plan a mission, put its plant at the start, and compile the block that flies it; none of it is flown in this process."""
    for function in LINKED:
        function.expect(JOINTS)
    made = plan(load_scenario(mission), mission)
    simulator, controller = Simulator(made.scenario, made.home, made.mission.start, made.names), Controller(made)
    simulator.connect()
    fly_block.compile(
        tuple(map(typeof, simulator.block_arguments(controller, np.zeros(1, controller.tick.buffer.dtype))))
    )
