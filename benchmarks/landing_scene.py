"""Cost of a step of the landing scene in its phases, beside the paper's scene and the magnet's own tick.

Run: .venv/bin/python benchmarks/landing_scene.py [PICTURE.png]
"""

import sys
import time
from collections.abc import Callable

import mujoco
import numpy as np

from armland.config import load_scenario
from armland.plant.landing_scene import PLATE, LandingScene, build_landing_scene
from armland.plant.magnet import OFF, ON, device, energise
from armland.plant.scene import build_scene

ROUNDS = 60
STEPS = 200
SETTLE = 500

ABOVE = np.deg2rad([-3.0, -83.0, -6.0, -49.0, 11.0, 35.0, -11.0])
"""Joint positions that carry the UAV in front of the cradle, rad."""

BELOW = np.deg2rad([-4.0, -108.0, -8.0, -58.0, 10.0, 51.0, -10.0])
"""Joint positions drawn back below the UAV on the cradle, rad."""


def settled(scene: LandingScene, q: np.ndarray, pivot: np.ndarray, command: int, thrust: float) -> mujoco.MjData:
    """The scene with the arm held at `q` and the UAV started at `pivot`, after `SETTLE` steps under the magnet's `command`."""
    m, d = scene.model, mujoco.MjData(scene.model)
    parameters, state = device(m, PLATE, scene.gear.magnet)
    d.qpos[scene.joint_qpos] = q
    d.qpos[scene.uav_qpos[:3]] = pivot + np.array([0.0, 0.0, 0.06])
    mujoco.mj_forward(m, d)
    for _ in range(SETTLE):
        d.ctrl[:] = d.qfrc_bias[scene.joint_dof] - 3000.0 * (d.qpos[scene.joint_qpos] - q)
        d.ctrl[:] -= 50.0 * d.qvel[scene.joint_dof]
        d.xfrc_applied[scene.uav_body, 2] = thrust
        d.xfrc_applied[scene.uav_body, 3:] = -d.qpos[scene.uav_qpos[4:]] - 0.12 * d.qvel[scene.uav_dof[3:]]
        energise(command, d.geom_xpos, d.geom_xmat, d.xipos, parameters, state, d.xfrc_applied)
        mujoco.mj_step(m, d)
    return d


def end_effector(scene: LandingScene, q: np.ndarray) -> np.ndarray:
    """Position of the end effector at joint positions `q`, m, world."""
    d = mujoco.MjData(scene.model)
    d.qpos[scene.joint_qpos] = q
    mujoco.mj_forward(scene.model, d)
    return d.sensordata[scene.sensor["ee_pos"] :][:3].copy()


def step_cost(m: mujoco.MjModel, d: mujoco.MjData) -> float:
    """Mean of `STEPS` steps from the state of `d`, s; the state is put back."""
    state, spec = np.zeros(mujoco.mj_stateSize(m, 0x1FFF)), 0x1FFF
    mujoco.mj_getState(m, d, state, spec)
    begin = time.perf_counter()
    for _ in range(STEPS):
        mujoco.mj_step(m, d)
    cost = (time.perf_counter() - begin) / STEPS
    mujoco.mj_setState(m, d, state, spec)
    return cost


def magnet_cost(scene: LandingScene, d: mujoco.MjData) -> float:
    parameters, state = device(scene.model, PLATE, scene.gear.magnet)
    arrays = d.geom_xpos, d.geom_xmat, d.xipos, parameters, state, d.xfrc_applied.copy()
    begin = time.perf_counter()
    for _ in range(STEPS):
        energise(ON, *arrays)
    return (time.perf_counter() - begin) / STEPS


def picture(scene: LandingScene, d: mujoco.MjData, file: str) -> None:
    import matplotlib.image

    with mujoco.Renderer(scene.model, 900, 1200) as renderer:
        renderer.update_scene(d, "landing")
        matplotlib.image.imsave(file, renderer.render())


def main() -> None:
    scenario = load_scenario("paper")
    scene, paper = build_landing_scene(scenario), build_scene(scenario)
    weight = scene.uav_mass * 9.81
    paper_data = mujoco.MjData(paper.model)
    paper_data.qpos[paper.joint_qpos] = ABOVE
    mujoco.mj_forward(paper.model, paper_data)
    paper_data.ctrl[:] = paper_data.qfrc_bias[paper.joint_dof]
    reached = end_effector(scene, ABOVE)
    flight = settled(scene, ABOVE, reached + [0.0, 0.0, 0.3], OFF, weight)
    held = settled(scene, ABOVE, reached + [0.0, 0.0, 0.0005], ON, 0.5 * weight)
    cradle = settled(scene, BELOW, scene.put_down, OFF, 0.0)
    cases: dict[str, Callable[[], float]] = {
        "paper's scene": lambda: step_cost(paper.model, paper_data),
        "in flight": lambda: step_cost(scene.model, flight),
        "held by the magnet": lambda: step_cost(scene.model, held),
        "on the cradle": lambda: step_cost(scene.model, cradle),
        "the magnet's tick": lambda: magnet_cost(scene, held),
    }
    costs: dict[str, list[float]] = {name: [] for name in cases}
    for _ in range(ROUNDS):
        for name, case in cases.items():
            costs[name].append(1e6 * case())
    for name, cost in costs.items():
        print(
            f"{name:20s} {np.median(cost):5.1f} µs median, {np.min(cost):5.1f} µs least, of {ROUNDS} interleaved rounds"
        )
    if len(sys.argv) > 1:
        picture(scene, held, sys.argv[1])


if __name__ == "__main__":
    main()
