"""A picture of the scene at the begin of a run, from its log."""

from pathlib import Path

import numpy as np

from armland.errors import LogError
from armland.plant.scene.composition import build_scene
from armland.plant.simulator import level_hinge
from armland.rotations import matrix
from armland.runtime.log import Log
from armland.scenario import Scenario
from armland.vision.picture import render


def draw_scene(out: Path, log: Log, name: str = "scene.png") -> Path:
    """Draw arm and hinged UAV as the log's first tick has them, with the scenario that stands in the log.

    Raises:
        LogError: a log without scenario or ticks, or of a UAV that is not hinged.
        PictureError: no OpenGL that works.
        ModelError: a file of the scenario is no longer there.
    """
    if "scenario" not in log.metadata or not len(log.messages["truth"]) or log.metadata.get("start") != "hinged":
        raise LogError("a picture of the scene needs the log of an experiment with its scenario, such as E1")
    truth = log.messages["truth"][0]
    scene = build_scene(Scenario.model_validate_json(log.metadata["scenario"]), "hinged")
    qpos = np.zeros(scene.model.nq)
    qpos[scene.joint_qpos], qpos[scene.hinge_qpos] = truth["q"], level_hinge(matrix(truth["ee_quat"]))
    return render(scene.model, qpos, Path(out) / name)
