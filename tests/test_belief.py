"""What the controller knows comes from the belief alone, and what the plant does from the hardware alone.

The hardware's numbers are changed, section by section, with the belief held where it was: nothing that the controller is built of may
change. Then the belief's are changed: nothing that the plant is built of may.
"""

import json

import mujoco
import numpy as np
import pytest

from armland.scenario import load_scenario
from armland.scenario.deviation import rows
from armland.scenario.tree import HARDWARE

MISSIONS = [("paper", "E3"), ("landing", "landing")]

GIVEN = {
    "uav": {
        "mass_kg": 0.5,
        "inertia_kgm2": ((0.0061, 0.0, 0.0), (0.0, 0.0072, 0.0), (0.0, 0.0, 0.0123)),
        "lever_m": (0.0, 0.0, -0.061),
    },
    "plate": {"mass_kg": 0.05},
}
"""Numbers that stand in a file where the scenario does not name them."""

RATES = {200: 250, 100: 125, 30: 25}


def other(value):
    """All numbers of nested tables a little different, each still in its bounds."""
    if isinstance(value, dict):
        return {k: new for k, v in value.items() if (new := other(v)) is not None}
    if isinstance(value, list):
        return [other(v) for v in value] if all(isinstance(v, int | float) for v in value) else None
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    if isinstance(value, int):
        return RATES.get(value, value)
    return value * 1.01 if value else 1e-3


def changed(scenario, section):
    """The numbers of a section as they are, and a little different."""
    plain = json.loads(getattr(scenario, section).model_dump_json())
    new = {**other(plain), **GIVEN.get(section, {})}
    return {key: plain[key] for key in new}, new


def arrays(model):
    """All numbers of a MuJoCo model by name, options included."""
    found = {
        name: np.array(getattr(model, name)) for name in dir(model) if isinstance(getattr(model, name), np.ndarray)
    }
    return found | {"gravity": np.array(model.opt.gravity), "timestep": np.array([model.opt.timestep])}


def differing(a, b):
    return {
        name for name in a if a[name].shape != b[name].shape or not np.array_equal(a[name], b[name], equal_nan=True)
    }


SET_UP = ("run_down", "watched", "lift_min", "thrust_max", "kp", "kd", "k_angle", "k_rate", "k_change", "most_leaning")
"""What the UAV's own autopilot is set up with follows by rules from what is believed of the UAV: `airframe.sizing`."""


class Fingerprint:
    """All that the controller of a flight is built of, and all that its plant is built of."""

    def __init__(self, scenario, mission) -> None:
        from armland.experiments.episode import prepare

        flight = prepare(scenario, mission)
        plan, simulator = flight.plan, flight.simulator
        self.controller = {"board": np.frombuffer(flight.controller.board.tobytes(), np.uint8)}
        self.controller |= {name: np.asarray(getattr(plan, name)) for name in ("path", "home", "ticks", "watch")}
        self.controller |= {f"arm.{k}": v for k, v in arrays(plan.arm.model).items()}
        world = simulator.world.copy()
        for name in SET_UP:
            world["told"]["onboard"][name] = 0.0
        self.plant = {"world": np.frombuffer(world.tobytes(), np.uint8)}
        self.plant |= {f"scene.{k}": v for k, v in arrays(simulator.scene.model).items()}
        # The arm starts where its controller wants it: that is no part of the hardware.
        data = mujoco.MjData(simulator.scene.model)
        mujoco.mj_forward(simulator.scene.model, data)
        self.plant["rest"] = np.concatenate([data.qfrc_bias, data.sensordata, data.qacc])


@pytest.fixture(scope="module")
def plain():
    """Each scenario as it comes and what a flight in it is built of."""
    made = {}

    def of(name, mission):
        if (name, mission) not in made:
            scenario = load_scenario(name)
            made[name, mission] = scenario, Fingerprint(scenario, mission)
        return made[name, mission]

    return of


def real(scenario, sections):
    """The hardware's numbers changed, the belief held where it was."""
    changes = {section: changed(scenario, section) for section in sections}
    believed = {section: old for section, (old, _) in changes.items()}
    return scenario.replaced({**{section: new for section, (_, new) in changes.items()}, "belief": believed})


def believed(scenario, sections):
    """The belief's numbers changed, the hardware held where it was."""
    return scenario.replaced({"belief": {section: changed(scenario, section)[1] for section in sections}})


def leaks(plain, name, mission, change, side):
    """What differs where nothing may, by section; all sections at once first, as one flight to prepare takes seconds."""
    scenario, before = plain(name, mission)

    def differs(sections):
        after = Fingerprint(change(scenario, sections), mission)
        return differing(getattr(before, side), getattr(after, side))

    if not differs(HARDWARE):
        return {}
    return {section: found for section in HARDWARE if (found := differs([section]))}


@pytest.mark.slow
@pytest.mark.parametrize(("name", "mission"), MISSIONS)
def test_no_number_of_the_plant_reaches_the_controller(plain, name, mission) -> None:
    assert leaks(plain, name, mission, real, "controller") == {}


@pytest.mark.slow
@pytest.mark.parametrize(("name", "mission"), MISSIONS)
def test_no_number_of_the_belief_reaches_the_plant(plain, name, mission) -> None:
    assert leaks(plain, name, mission, believed, "plant") == {}


@pytest.mark.slow
@pytest.mark.parametrize(("name", "mission"), MISSIONS)
def test_what_only_the_plant_has_does_not_reach_the_controller(plain, name, mission) -> None:
    scenario, before = plain(name, mission)
    _, imperfect = changed(scenario, "imperfections")
    worse = {"imperfections": imperfect, "disturbance": {"force_n": [1.0, 2.0, 3.0], "torque_nm": [0.1, 0.2, 0.3]}}
    assert differing(before.controller, Fingerprint(scenario.replaced(worse), mission).controller) == set()


@pytest.mark.slow
@pytest.mark.parametrize(("name", "mission"), MISSIONS)
def test_changes_are_seen_where_they_belong(plain, name, mission) -> None:
    """Negative control: the same numbers, believed and real at once, change both, in the record and in the model of either."""
    scenario, before = plain(name, mission)
    after = Fingerprint(scenario.replaced({section: changed(scenario, section)[1] for section in HARDWARE}), mission)
    assert differing(before.controller, after.controller) >= {"board", "arm.body_mass", "arm.gravity"}
    assert differing(before.plant, after.plant) >= {"world", "scene.body_mass", "scene.body_inertia", "scene.gravity"}


def test_every_number_of_the_hardware_is_changed() -> None:
    scenario = load_scenario("landing")
    for section in HARDWARE:
        old, new = changed(scenario, section)

        def same(a, b, path):
            if isinstance(a, dict):
                return [p for k in a for p in same(a[k], b.get(k), f"{path}.{k}")]
            number = isinstance(a, int | float) and not isinstance(a, bool)
            return [path] if number and a == b else []

        assert same(json.loads(getattr(scenario, section).model_dump_json()), {**old, **new}, section) == []


def keys(section):
    """Keys of a section of the landing that hold numbers, with nested tables opened: paths and the numbers as they are, and changed."""
    old, new = changed(load_scenario("landing"), section)

    def opened(a, b, path):
        for key in b:
            if isinstance(b[key], dict):
                yield from opened(a[key], b[key], (*path, key))
            elif a.get(key) != b[key]:
                yield (*path, key), a.get(key), b[key]

    yield from opened(old, new, (section,))


def nested(path, value):
    for key in reversed(path):
        value = {key: value}
    return value


NUMBERS = [found for section in HARDWARE for found in keys(section)]
ROWS = [(row.path, row.told.high or row.told.low) for row in rows()]


def with_row(scenario, path, number):
    return scenario.replaced({"deviation": nested(path.split("."), [number, number])})


def differently(scenario, kind):
    """Scenarios of which the plant alone is another one, each in one number, by the name of that number."""
    if kind == "deviation":
        return {path: with_row(scenario, path, extreme) for path, extreme in ROWS}
    if kind == "imperfections":
        found = [((kind, key), value) for key, value in changed(scenario, kind)[1].items()]
        found += [(("disturbance", "force_n"), [1.0, 2.0, 3.0]), (("disturbance", "torque_nm"), [0.1, 0.2, 0.3])]
        return {".".join(path): scenario.replaced(nested(path, value)) for path, value in found}
    return {
        ".".join(path): scenario.replaced({**nested(path, new), "belief": nested(path, old)})
        for path, old, new in NUMBERS
    }


@pytest.mark.parametrize("kind", ["deviation", "imperfections", "hardware"])
def test_belief_is_the_same_whichever_number_of_the_plant_is_another(kind) -> None:
    """All that a controller is planned from: `plan` takes nothing else of a scenario."""
    scenario = load_scenario("landing")
    plain = scenario.believed().model_dump_json()
    assert [
        name for name, other in differently(scenario, kind).items() if other.believed().model_dump_json() != plain
    ] == []


def test_belief_follows_each_of_its_own_numbers() -> None:
    """Negative control: without the belief held where it was, each number of the hardware is believed as well."""
    scenario = load_scenario("landing")
    plain = scenario.believed().model_dump_json()
    for path, _, new in NUMBERS:
        assert scenario.replaced(nested(path, new)).believed().model_dump_json() != plain, path


def first_tick(scenario, measured=None):
    """Command and truth of the first tick, and what was measured then; `measured` replaces that for the controller."""
    from armland.experiments.episode import prepare

    flight = prepare(scenario, "landing")
    tick = flight.controller.tick
    flight.simulator.connect()
    flight.simulator.read(tick)
    seen, truth = tick.measurement.copy(), tick.truth.copy()
    if measured is not None:
        tick.measurement[:] = measured
    flight.controller.update(tick)
    return tick.command.tobytes(), truth.tobytes(), seen


@pytest.fixture(scope="module")
def first():
    return first_tick(load_scenario("landing"))


def test_first_command_is_the_same_in_another_plant(first) -> None:
    """All hardware and imperfections changed, every deviation at twice its range; what is measured is the same."""
    scenario = real(load_scenario("landing"), HARDWARE).replaced(
        {"deviation": {"level": "harsh"}, "imperfections": changed(load_scenario("landing"), "imperfections")[1]}
    )
    command, truth, _ = first_tick(scenario, first[2])
    assert command == first[0]
    # Negative control: it is another plant.
    assert truth != first[1]


@pytest.mark.slow
@pytest.mark.parametrize(("path", "extreme"), ROWS)
def test_first_command_is_the_same_whichever_row_deviates(first, path, extreme) -> None:
    assert first_tick(with_row(load_scenario("landing"), path, extreme), first[2])[0] == first[0]


def test_first_command_follows_the_belief(first) -> None:
    """Negative control: a tool that is believed to be heavier is held by other torques."""
    scenario = load_scenario("landing")
    mass = scenario.tool.tool_mass_kg
    heavier = scenario.replaced({"belief": {"tool": {"tool_mass_kg": 1.01 * mass}}})
    command, truth, _ = first_tick(heavier, first[2])
    assert command != first[0]
    assert truth == first[1]


def first_truth(scenario, start):
    """Truth and measurement at tick 0 of the plant alone, its arm where the landing's waits."""
    from armland.plant.simulator import Simulator
    from armland.records import Tick

    simulator = Simulator(scenario, np.deg2rad(scenario.place.home_deg), start)
    tick = Tick(simulator.scene.joints)
    simulator.connect()
    simulator.read(tick)
    return tick.truth.tobytes() + tick.measurement.tobytes() + simulator.world.tobytes()


@pytest.mark.parametrize("start", ["air", "cradle"])
def test_first_truth_is_the_same_whatever_is_believed(start) -> None:
    scenario = load_scenario("landing", {"deviation": {"level": "published"}})
    plain = first_truth(scenario, start)
    assert [s for s in HARDWARE if first_truth(believed(scenario, [s]), start) != plain] == []
    # Negative control: real, and not believed, the same numbers show, but for gear that nothing touches or moves as yet, and for
    # what is fitted at sea or by other methods alone.
    same = {s for s in HARDWARE if first_truth(scenario.replaced({s: changed(scenario, s)[1]}), start) == plain}
    assert same <= {"cradle", "hinge", "motion_reference", "pad", "tether", "hexapod"}


@pytest.mark.slow
@pytest.mark.parametrize(("path", "old", "new"), NUMBERS)
def test_first_truth_is_the_same_whichever_number_is_believed_otherwise(path, old, new) -> None:
    scenario = load_scenario("landing", {"deviation": {"level": "published"}})
    assert first_truth(scenario.replaced({"belief": nested(path, new)}), "air") == first_truth(scenario, "air")
