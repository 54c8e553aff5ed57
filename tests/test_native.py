"""MuJoCo called from compiled code: the same bytes as from Python, also from the cache of another process."""

import subprocess
import sys

import mujoco
import numpy as np
import pytest
from numba import njit

from armland.errors import ModelError
from armland.native import library, mj_step

PENDULUM = """
<mujoco><worldbody><body><joint name="a" type="hinge" axis="0 1 0" damping="0.1"/><geom size="0.1" mass="1" pos="0.3 0 0"/>
<body pos="0.6 0 0"><joint type="ball"/><geom size="0.1" mass="2" pos="0 0.2 0"/></body></body></worldbody>
<actuator><motor joint="a"/></actuator></mujoco>
"""


@njit
def steps(model: int, data: int, number: int) -> None:
    for _ in range(number):
        mj_step(model, data)


def test_compiled_step_gives_the_bytes_of_python_s() -> None:
    model = mujoco.MjModel.from_xml_string(PENDULUM)
    here, there = mujoco.MjData(model), mujoco.MjData(model)
    for data in (here, there):
        data.qvel[:], data.ctrl[:] = [1.0, 2.0, -3.0, 0.5], 0.7
    steps(model._address, here._address, 500)
    for _ in range(500):
        mujoco.mj_step(model, there)
    assert here.time == there.time
    for name in ("qpos", "qvel", "qacc", "xpos"):
        assert getattr(here, name).tobytes() == getattr(there, name).tobytes()
    # Negative control: it moved.
    assert np.abs(here.qpos - model.qpos0).max() > 0.1


CACHED = """
import sys
import mujoco
from numba import njit
from armland.native import mj_step

@njit(cache=True, nogil=True)
def steps(model, data, number):
    for _ in range(number):
        mj_step(model, data)

model = mujoco.MjModel.from_xml_string(sys.argv[1])
data = mujoco.MjData(model)
steps(model._address, data._address, 100)
print(data.qpos.tobytes().hex(), sum(steps.stats.cache_hits.values()))
"""


def test_code_from_the_cache_calls_the_library_of_its_own_process(tmp_path) -> None:
    script = tmp_path / "steps.py"
    script.write_text(CACHED, encoding="utf-8")

    def run() -> tuple[str, str]:
        command = [sys.executable, str(script), PENDULUM]
        found = subprocess.run(command, capture_output=True, text=True, check=True).stdout.split()
        return found[0], found[1]

    (first, compiled), (second, cached) = run(), run()
    assert first == second
    assert (compiled, cached) == ("0", "1")


def test_warning_is_counted_and_leaves_no_file(tmp_path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    model = mujoco.MjModel.from_xml_string(PENDULUM)
    data = mujoco.MjData(model)
    data.qvel[:] = np.nan
    steps(model._address, data._address, 1)
    assert data.warning.number[int(mujoco.mjtWarning.mjWARN_BADQVEL)] == 1
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("name", ["libmujoco.so.4.0.0", "libmujoco.4.0.0.dylib", "mujoco.dll"])
def test_library_is_found_by_its_name_on_each_system(tmp_path, name) -> None:
    (tmp_path / name).touch()
    (tmp_path / "_structs.cpython-311-x86_64-linux-gnu.so").touch()
    assert library(tmp_path) == tmp_path / name


def test_package_without_library_is_named(tmp_path) -> None:
    with pytest.raises(ModelError, match="holds no library of MuJoCo"):
        library(tmp_path)
