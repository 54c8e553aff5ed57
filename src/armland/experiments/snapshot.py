"""A flight that can be kept at a tick, put back to it and flown on from there, as often as asked.

What is kept is everything that changes while a flight runs: the controller's and the plant's record, MuJoCo's state with its warm
start, the friction of the brakes, the block of noise and the generators. A flight that is put back gives byte for byte the records
of one that was flown through.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import mujoco
import numpy as np

from armland.errors import PlantError
from armland.experiments.episode import Flight
from armland.plant.faults import table as faults
from armland.records import Records
from armland.rotations import Array
from armland.scenario.faults import Fault


class Snapshot(NamedTuple):
    """A flight at the begin of a tick, before anything of it is read."""

    tick: int
    board: bytes
    world: bytes
    physics: mujoco.MjData
    friction: tuple[Array, ...]
    noise: tuple[Array, ...]
    generators: tuple[dict[str, Any], ...]


class Run:
    """A prepared flight, flown step by step.

    Args:
        flight: of `episode.prepare`.
    """

    def __init__(self, flight: Flight) -> None:
        self.scenario, self.plan, self.simulator, self.controller, self.metadata, _ = flight
        self.tick, self.rate = self.controller.tick, self.scenario.run.rate_hz
        self.simulator.connect()

    def step(self) -> None:
        """One tick."""
        self.simulator.read(self.tick)
        self.controller.update(self.tick)
        self.simulator.command(self.tick)

    def advance(self, until: int, keep_at: frozenset[int] = frozenset()) -> tuple[Records, dict[int, Snapshot]]:
        """Fly in compiled blocks up to tick `until`, or until the mission has ended and was watched.

        Returns:
            The ticks flown (k,) of `tick_layout`, and snapshots at those of the ticks `keep_at`.

        Raises:
            PlantError: command or state are no longer finite.
        """
        first, flown, kept = self.simulator.tick, 0, {}
        rows: Records = np.empty(until - first, self.tick.buffer.dtype)
        for stop in sorted(k for k in {*keep_at, until} if k >= first):
            while first + flown < stop and self.controller.ended_for() < self.plan.watch:
                done, broken = self.simulator.advance(self.controller, rows[flown : stop - first])
                flown += done
                if broken is not None:
                    raise broken
            if stop in keep_at and first + flown == stop:
                kept[stop] = self.keep()
        return rows[:flown], kept

    def advance_to(self, there: Callable[[], bool], what: str) -> None:
        """Fly on until `there` after a tick.

        Raises:
            PlantError: the mission ended, or its time was over, before it came to `what`.
        """
        while self.simulator.tick < self.plan.ticks:
            self.step()
            if there():
                return
            if self.controller.final:
                break
        raise PlantError(f"the flight ended in phase {self.controller.phase!r} and never came to {what}")

    def keep(self) -> Snapshot:
        """The flight as it is."""
        simulator, model = self.simulator, self.simulator.scene.model
        physics = mujoco.MjData(model)
        mujoco.mj_copyData(physics, model, simulator.data)
        return Snapshot(
            simulator.tick,
            self.controller.board.tobytes(),
            simulator.world.tobytes(),
            physics,
            tuple(a.copy() for a in self._friction()),
            tuple(rows.copy() for rows in simulator.noise),
            tuple(dict(g.bit_generator.state) for g in simulator.noise_source.generators),
        )

    def restore(self, kept: Snapshot) -> None:
        """Back to a moment that was kept, in the same arrays, so that views of them stay what they are."""
        simulator = self.simulator
        simulator.tick = kept.tick
        self.controller.board.view(np.uint8)[:] = np.frombuffer(kept.board, np.uint8)
        simulator.world.view(np.uint8)[:] = np.frombuffer(kept.world, np.uint8)
        mujoco.mj_copyData(simulator.data, simulator.scene.model, kept.physics)
        for array, old in zip((*self._friction(), *simulator.noise), (*kept.friction, *kept.noise), strict=True):
            array[...] = old
        for generator, state in zip(simulator.noise_source.generators, kept.generators, strict=True):
            generator.bit_generator.state = state

    def fail(self, failures: tuple[Fault, ...]) -> None:
        """Let `failures` happen from here on, in place of the scenario's, each when its phase begins next.

        Raises:
            ConfigurationError: one that the mission cannot have.
        """
        simulator = self.simulator
        scenario = self.scenario.model_copy(update={"faults": failures})
        faults.tell(simulator.world["told"]["faults"], scenario, simulator.scene, self.plan.names)
        faults.reset(simulator.world["kept"]["faults"], simulator.world["told"]["faults"])

    def _friction(self) -> tuple[Array, Array]:
        model = self.simulator.scene.model
        return model.dof_frictionloss, model.dof_solimp
