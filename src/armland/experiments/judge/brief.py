"""What a log's metadata says about its flight, written and read: all that the judge is told beside the ticks."""

import json
from collections.abc import Mapping
from importlib.metadata import version
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from armland.errors import LogError
from armland.experiments.judge.singularity import Screws, screws_of
from armland.experiments.judge.solids import solids_of
from armland.mission.plan import Plan
from armland.mission.reference.path import Leg
from armland.mission.supervisor.table import FAULTS
from armland.mission.table.mission import Criterion
from armland.models.arm_file.meshes.worn import worn
from armland.models.parameters import arm_file
from armland.models.weather import swayed
from armland.plant.scene.composition import Scene
from armland.plant.scene.uav import UAV
from armland.rotations import Array
from armland.scenario import Scenario

Ticks = NDArray[np.void] | Mapping[str, NDArray[np.void]]
"""Recorded ticks (k,) of `records.tick_layout`, or the messages of a log by name."""


class Hold(NamedTuple):
    """What a magnet can hold, of which a flight may use a share."""

    rating_n: float
    shear_share: float  # Shear held per newton that presses the faces together
    share: float


class Brief(NamedTuple):
    """A mission as the judge has to know it."""

    mission: str
    start: str  # `hinged`, `air` or `cradle`
    rate_hz: int
    phases: tuple[str, ...]
    finals: frozenset[str]  # Names of the phases that end the mission
    on_cradle: frozenset[str]  # Names of those in which the UAV may touch the cradle
    faults: tuple[str, ...]  # Names of the faults that the controller can find, `none` first
    limits: dict[str, Any]  # By the names in `limits.excesses`; a limit that is not here is not judged
    hold: Hold | None  # None where the scene has no magnet
    screws: Screws  # Of the arm
    gravity: float  # m/s²
    weight: float  # N, of all that flies, as the controller believes it
    solids: str  # MJCF, see `solids.solids_of`; empty where nothing can touch, or the log has none
    uav_cm: Array  # (3,) m, B: centre of mass in the UAV's body of `solids`
    put_down: Array  # (3,) m, D: where the pivot is when the UAV stands in the middle of the cradle
    given: Array  # (3,) m/s, D: velocity that the UAV keeps after the release
    swayed: tuple[float, float]  # Lean, degrees, and speed, m/s, that the wind gives to a UAV which is under control
    legs: tuple[Leg, ...]  # Of the path that the mission follows; none where it follows none
    judged_as: str  # Row of `judgement.KINDS`
    praise: str  # What to say where all is well
    criteria: tuple[Criterion, ...]  # Largest values of figures, by `judge.figures.NAMES`
    timeouts: dict[str, str]  # Phase -> why it can run out of time, and what helps
    arm: str  # Its file


def brief_of(metadata: Mapping[str, str]) -> Brief:
    """The brief that stands in a log's metadata, where `episode` has put it.

    Raises:
        LogError: it lacks something; the log is of an older version or of another program.
    """
    try:
        return Brief(
            mission=metadata["mission"],
            start=metadata["start"],
            rate_hz=round(1e9 / int(metadata["period_ns"])),
            phases=tuple(metadata["phases"].split(",")),
            finals=frozenset(metadata["finals"].split(",")),
            on_cradle=frozenset(metadata["on_cradle"].split(",")),
            faults=tuple(metadata["faults"].split(",")),
            limits={name: np.array(value) for name, value in json.loads(metadata["limits"]).items()},
            hold=Hold(**hold) if (hold := json.loads(metadata["hold"])) else None,
            screws=Screws(**json.loads(metadata["screws"])),
            gravity=float(metadata["gravity"]),
            weight=float(metadata.get("weight", "inf")),
            solids=metadata.get("solids", ""),
            uav_cm=np.array(json.loads(metadata.get("uav_cm", "[0.0, 0.0, 0.0]"))),
            put_down=np.array(json.loads(metadata["put_down"])),
            given=np.array(json.loads(metadata["given"])),
            swayed=tuple(json.loads(metadata.get("swayed", "[0.0, 0.0]"))),
            legs=tuple(_leg(leg) for leg in json.loads(metadata["legs"])),
            judged_as=metadata["judged_as"],
            praise=metadata["praise"],
            criteria=tuple(Criterion(*row) for row in json.loads(metadata["criteria"])),
            timeouts=dict(json.loads(metadata["timeouts"])),
            arm=metadata["arm"],
        )
    except KeyError as e:
        raise LogError(
            f"the log's metadata has no {e.args[0]!r}, which judging it needs; it has {', '.join(metadata)}"
        ) from e
    except (TypeError, ValueError) as e:
        raise LogError(f"the log's metadata is damaged: {e}") from e


def _leg(data: dict[str, Any]) -> Leg:
    leg = Leg(**data)
    return leg._replace(origin=np.array(leg.origin), target=np.array(leg.target))


SOFTWARE = ("mujoco", "numba", "numpy")  # Packages whose versions make a difference to the numbers

LIMITS = ("q_min", "q_max", "qd_max", "tau_max", "torque_rate", "sigma_min", "hinge_max")
"""Limits of the controller that the judge holds against what happened; infinite ones are none."""


def metadata_of(scenario: Scenario, plan: Plan, scene: Scene) -> dict[str, str]:
    """The metadata of a flight of `plan`; lists of names by commas, everything else that is no text as JSON.

    Args:
        scenario: what is flown.
        plan: of it.
        scene: in which it is flown.
    """
    mission, place, magnet = plan.mission, scenario.place, scenario.magnet
    hold = Hold(magnet.rating_n, magnet.shear_share, scenario.limits.hinge_force_share)
    data: dict[str, Any] = {
        "limits": {name: plan.told["limit"][name][0] for name in LIMITS if np.isfinite(plan.told["limit"][name]).all()},
        "legs": [leg._asdict() for leg in plan.legs],
        "thresholds": plan.thresholds,
        "put_down": np.nan_to_num(scene.put_down),
        "uav_cm": scene.model.site(f"{UAV}cm").pos,
        "hold": hold._asdict() if "magnet" in scene.parts else None,
        "screws": screws_of(scene)._asdict(),
        "gravity": float(np.linalg.norm(scenario.environment.gravity_mps2)),
        "weight": plan.weight_n,
        "swayed": swayed(scenario, plan.weight_n / float(np.linalg.norm(scenario.environment.gravity_mps2))),
        "given": place.takeoff_velocity_mps if place.fly_on else (0.0, 0.0, 0.0),
        "criteria": [list(c) for c in mission.criteria],
        "timeouts": dict(mission.timeouts),
        "versions": {name: version(name) for name in SOFTWARE},
    }
    text = {
        "mission": mission.name,
        "title": scenario.title,
        "experiment": plan.experiment or "",
        "law": plan.law_name,
        "arm": scenario.arm.file,
        "seed": str(scenario.run.seed),
        "start": mission.start,
        "judged_as": mission.judged_as,
        "praise": mission.praise,
        "phases": ",".join(plan.names),
        "finals": ",".join(p.name for p in plan.phases if p.final),
        "on_cradle": ",".join(p.name for p in plan.phases if p.on_cradle),
        "faults": ",".join(FAULTS),
        "scenario": scenario.model_dump_json(),
        "overrides": scenario.overrides,
        "solids": solids_of(scene, worn(arm_file(scenario).chain) if scene.bond == "free" else {}),
    }
    return {**text, **{name: json.dumps(value, default=_plain) for name, value in data.items()}}


def _plain(value: Any) -> Any:
    return np.asarray(value).tolist()
