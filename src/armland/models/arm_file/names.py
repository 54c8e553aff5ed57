"""Arms by name: files that the packages `mujoco-menagerie` and `robot_descriptions` have, where those are installed."""

import importlib
import importlib.util
from pathlib import Path
from typing import Any

from armland.errors import ModelError

INSTALL = "pip install mujoco-menagerie (MJCF) or pip install robot_descriptions (URDF and MJCF)"


def arm_path(name: str) -> Path:
    """The file that `name` means: itself, or what an installed package calls so.

    Raises:
        ModelError: there is no such file and no package that has the name; says what would help.
    """
    try:
        if Path(name).is_file():
            return Path(name).resolve()
    except (OSError, ValueError):
        pass
    if "/" in name or name.endswith((".urdf", ".xml", ".mjcf", ".xacro")):
        raise ModelError(f"--arm {name!r}: there is no such file")
    tried = []
    for package, find in (("mujoco_menagerie", _menagerie), ("robot_descriptions", _described)):
        if importlib.util.find_spec(package) is None:
            tried.append(f"{package} is not installed")
            continue
        try:
            found = find(name)
        except Exception as e:  # They ask the internet, and say in their own errors what failed.
            tried.append(f"{package}: {' '.join(str(e).split())[:200]}")
            continue
        if found is not None:
            return found
        tried.append(f"{package} has no arm of that name")
    raise ModelError(f"--arm {name!r}: there is no such file, and {'; '.join(tried)}; {INSTALL} gives arms by name")


def _menagerie(name: str) -> Path | None:
    package: Any = importlib.import_module("mujoco_menagerie")
    if name not in package.names():
        return None
    robot = package.get(name)
    # Its scene has a floor and lights besides.
    return _file(robot.xml(robot.default_model))


def _described(name: str) -> Path | None:
    for module in (name, f"{name}_mj_description", f"{name}_description"):
        if importlib.util.find_spec(f"robot_descriptions.{module}") is not None:
            found: Any = importlib.import_module(f"robot_descriptions.{module}")
            return _file(getattr(found, "MJCF_PATH", None) or getattr(found, "URDF_PATH", None))
    return None


def _file(path: Any) -> Path | None:
    return None if path is None or not Path(path).is_file() else Path(path).resolve()
