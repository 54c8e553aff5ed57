"""Which joint of an arm is its elbow: the one far from both the shoulder and the hand, so that it alone brings them together.

| symbol | name | unit |
|---|---|---|
| s, e | shoulder, the second hinge's anchor, and end effector (3,) | m |
| d_i(x) = \\|a_i × (x − o_i)\\| | distance of a point from the axis of joint i | m |

A turn of joint i changes the distance between s and e by at most d_i(s) d_i(e)/\\|e − s\\|. It is nothing for the shoulder's joints,
whose axes meet in s, and for rolls along a link; little for the wrist's, whose axes pass near e; most for the elbow's.
"""

import mujoco
import numpy as np

from armland.models.arm_file.strength import place, poses
from armland.models.description import EE_SITE

SAMPLED = 60


def elbow(model: mujoco.MjModel) -> int:
    """Index of the elbow's joint of a serial arm with its end effector marked; the middle one where none stands out.

    Least of both distances, averaged over poses drawn from the joints' ranges: always the same.
    """
    data, at = mujoco.MjData(model), model.site(EE_SITE).id
    hinges = np.flatnonzero(model.jnt_type == int(mujoco.mjtJoint.mjJNT_HINGE))
    if len(hinges) < 3:
        return model.njnt // 2
    lever = np.zeros(model.njnt)
    for q in poses(model)[:SAMPLED]:
        place(model, data, q)
        apart = [
            np.linalg.norm(np.cross(data.xaxis, x - data.xanchor), axis=1)
            for x in (data.xanchor[hinges[1]], data.site_xpos[at])
        ]
        lever += np.minimum(*apart)
    lever[np.setdiff1d(np.arange(model.njnt), hinges[2:])] = -1.0
    return int(lever.argmax())
