"""What only the eye needs: sky, floor, lights, and the cameras from which pictures of a run are taken."""

import mujoco
import numpy as np

from armland.plant.scene.deck import FLOOR_M, ground

VIEWS = {
    "overview": ((1.42, -1.62, 1.25), (0.42, 0.04, 0.44), 30.0),
    "landing": ((1.65, -1.7, 1.2), (0.45, 0.0, 0.43), 32.0),
}
"""Camera -> where it stands and where it looks, m, and its angle of view, degrees. `landing` has the cradle in frame."""


def add_surroundings(spec: mujoco.MjSpec) -> None:
    """Add sky, floor, lights and the cameras of `VIEWS`."""
    _set_quality(spec.visual)
    T, B = mujoco.mjtTexture, mujoco.mjtBuiltin
    sky = {"type": T.mjTEXTURE_SKYBOX, "builtin": B.mjBUILTIN_GRADIENT, "width": 256, "height": 1536}
    spec.add_texture(name="sky", rgb1=[0.78, 0.85, 0.93], rgb2=[0.95, 0.96, 0.98], **sky)
    tiles = {"type": T.mjTEXTURE_2D, "builtin": B.mjBUILTIN_CHECKER, "width": 512, "height": 512}
    spec.add_texture(name="floor", rgb1=[0.84, 0.85, 0.87], rgb2=[0.80, 0.81, 0.83], **tiles)
    # A square of the checker is a quarter of a metre wide: the floor is a ruler, too.
    material = spec.add_material(name="floor", texrepeat=[4, 4], texuniform=True, specular=0.0)
    material.textures[int(mujoco.mjtTextureRole.mjTEXROLE_RGB)] = "floor"
    world = spec.worldbody
    kind = {"type": mujoco.mjtGeom.mjGEOM_PLANE, "size": [0, 0, 0.1]}
    if (under := ground(spec)) is not world:
        kind = {"type": mujoco.mjtGeom.mjGEOM_BOX, "size": FLOOR_M, "pos": [0, 0, -FLOOR_M[2]], "mass": 0}
    under.add_geom(name="floor", material="floor", contype=0, conaffinity=0, group=2, **kind)
    sun = mujoco.mjtLightType.mjLIGHT_DIRECTIONAL
    world.add_light(type=sun, pos=[0.2, -1.4, 2.5], dir=[0.05, 0.7, -1.0], diffuse=[0.48, 0.48, 0.46], castshadow=True)
    world.add_light(type=sun, pos=[1.0, 1.0, 2.0], dir=[-1.0, -0.6, -0.5], diffuse=[0.16, 0.17, 0.2], castshadow=False)
    for name, (eye, target, angle) in VIEWS.items():
        world.add_camera(name=name, pos=eye, xyaxes=_axes(np.array(eye), np.array(target)), fovy=angle)


def _set_quality(visual: mujoco.MjVisual) -> None:
    visual.global_.offwidth, visual.global_.offheight = 1600, 1200
    visual.headlight.ambient = [0.46, 0.46, 0.47]
    visual.headlight.diffuse = [0.22, 0.22, 0.22]
    visual.headlight.specular = [0.1, 0.1, 0.1]
    visual.quality.shadowsize = 4096
    # The floor has no edge: haze takes it into the sky's colour at the horizon.
    visual.map.haze, visual.rgba.haze = 0.35, [0.95, 0.96, 0.98, 1.0]


def _axes(eye: np.ndarray, target: np.ndarray) -> np.ndarray:
    # The camera looks along its -z, with its x axis level.
    z = (eye - target) / np.linalg.norm(eye - target)
    x = np.cross([0.0, 0.0, 1.0], z)
    x /= np.linalg.norm(x)
    return np.concatenate([x, np.cross(z, x)])
