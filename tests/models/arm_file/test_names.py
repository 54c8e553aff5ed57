"""Arms by name, from packages that stand in for the real ones: they would ask the internet."""

import sys
from types import SimpleNamespace

import pytest

from armland.errors import ModelError
from armland.models.arm_file import names
from armland.models.arm_file.names import arm_path


@pytest.fixture
def packages(monkeypatch):
    """Install modules of these names for the test."""

    def install(**modules):
        found = {name.replace("__", "."): SimpleNamespace(**what) for name, what in modules.items()}
        monkeypatch.setattr(names.importlib.util, "find_spec", lambda name: found.get(name))
        monkeypatch.setattr(names.importlib, "import_module", lambda name: found[name])
        for name in ("mujoco_menagerie", "robot_descriptions"):
            monkeypatch.delitem(sys.modules, name, raising=False)

    return install


def test_file_is_itself(arms):
    assert arm_path(str(arms / "ok.urdf")) == (arms / "ok.urdf").resolve()


def test_name_without_packages_says_what_to_install(packages):
    packages()
    with pytest.raises(
        ModelError, match="mujoco_menagerie is not installed; robot_descriptions is not installed; pip install"
    ):
        arm_path("panda")


@pytest.mark.parametrize("name", ["nowhere.urdf", "folder/arm", "x.xacro"])
def test_missing_file_is_not_looked_for_by_name(packages, name):
    packages()
    with pytest.raises(ModelError, match=r"there is no such file$"):
        arm_path(name)


def test_menagerie_gives_the_robot_and_not_its_scene(packages, arms):
    robot = SimpleNamespace(default_model="panda", xml=lambda entry: arms / "ok.xml" if entry == "panda" else None)
    packages(mujoco_menagerie={"names": lambda: ["panda"], "get": {"panda": robot}.get})
    assert arm_path("panda") == (arms / "ok.xml").resolve()
    with pytest.raises(ModelError, match="mujoco_menagerie has no arm of that name"):
        arm_path("ur5e")


def test_descriptions_give_mjcf_before_urdf(packages, arms):
    mjcf, urdf = {"MJCF_PATH": str(arms / "ok.xml")}, {"URDF_PATH": str(arms / "ok.urdf")}
    packages(
        robot_descriptions={}, robot_descriptions__arm_mj_description=mjcf, robot_descriptions__arm_description=urdf
    )
    assert arm_path("arm").name == "ok.xml"
    assert arm_path("arm_description").name == "ok.urdf"


def test_package_that_fails_is_quoted(packages):
    def refuse():
        raise OSError("no route to host")

    packages(mujoco_menagerie={"names": refuse})
    with pytest.raises(ModelError, match="mujoco_menagerie: no route to host"):
        arm_path("panda")
