"""Who may know whom: the arrows of the design, read from the imports."""

import ast
import importlib.util
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PACKAGE = ROOT / "src" / "armland"

# From left to right: a part may import itself and what stands in an earlier group, not its neighbours in the same one.
LAYERS = (
    ("foundation",),
    ("models",),
    ("control", "estimation"),
    ("mission",),
    ("runtime",),
    ("plant", "links"),
    ("experiments",),
    ("view",),
    ("cli",),
)
FOUNDATION = {"__init__", "compiled", "records", "rotations", "scenario", "config", "errors"}
LAYER_OF = {part: depth for depth, parts in enumerate(LAYERS) for part in parts}
FORBIDDEN_NAMES = {"utils", "helpers", "common", "manager", "base"}
MAX_LINES = 300


def part_of(name: str) -> str:
    """Part of the design to which a top-level name inside the package belongs."""
    if name in FOUNDATION:
        return "foundation"
    return "cli" if name == "__main__" else name


def imported_names(source: str, package: str) -> list[tuple[int, str]]:
    """Line and top-level name inside `armland` of each import, wherever it stands and however it is written."""
    targets: list[tuple[int, str]] = []
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            targets += [(node.lineno, alias.name) for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            module = importlib.util.resolve_name("." * node.level + (node.module or ""), package)
            targets += [(node.lineno, f"{module}.{alias.name}") for alias in node.names]
        elif isinstance(node, ast.Call) and ast.unparse(node.func).endswith("import_module") and node.args:
            target = node.args[0]
            if isinstance(target, ast.Constant):
                targets.append((node.lineno, importlib.util.resolve_name(str(target.value), package)))
    inside = [(line, target.split(".")) for line, target in targets if target.split(".")[0] == "armland"]
    return [(line, names[1] if len(names) > 1 else "__init__") for line, names in inside]


def violations(source: str, path: str) -> list[str]:
    """Imports against the arrows in the source of the module at `path`, relative to the package."""
    *folders, file = Path(path).parts
    own = part_of(folders[0] if folders else Path(file).stem)
    if own not in LAYER_OF:
        return [f"{path}: '{own}' is no part of the design; its parts are {', '.join(LAYER_OF)}"]
    found = []
    for line, name in imported_names(source, ".".join(["armland", *folders])):
        # A name of the package itself, such as `__version__`, is no module and lives in `__init__`.
        other = part_of(name) if part_of(name) in LAYER_OF else "foundation"
        if other != own and LAYER_OF[other] >= LAYER_OF[own]:
            found.append(f"{path}:{line}: {own} may not import {other}")
    return found


def test_imports_follow_the_arrows() -> None:
    modules = sorted(PACKAGE.rglob("*.py"))
    assert modules
    found = [v for m in modules for v in violations(m.read_text("utf-8"), m.relative_to(PACKAGE).as_posix())]
    assert found == []


@pytest.mark.parametrize(
    ("path", "source"),
    [
        ("control/made_up.py", "from armland.plant import scene"),
        ("control/made_up.py", "from armland.plant.scene import compose"),
        ("control/made_up.py", "from armland import errors, plant"),
        ("control/made_up.py", "import numpy, armland.plant.scene as scene"),
        ("control/made_up.py", "from ..plant import scene"),
        ("control/made_up.py", "from .. import plant"),
        ("control/made_up.py", "def law():\n    from armland.plant import scene"),
        ("control/made_up.py", "if TYPE_CHECKING:\n    from armland.plant import scene"),
        ("control/made_up.py", "scene = importlib.import_module('armland.plant.scene')"),
        ("control/__init__.py", "from ..plant import scene"),
        ("control/made_up.py", "from armland.estimation import bias"),
        ("estimation/made_up.py", "from armland.control import impedance"),
        ("links/made_up.py", "from armland.plant import scene"),
        ("plant/made_up.py", "from armland.links import fri"),
        ("models/made_up.py", "from armland.control import impedance"),
        ("runtime/made_up.py", "from armland.plant import scene"),
        ("experiments/made_up.py", "from armland.view import figures"),
        ("view/made_up.py", "from armland.cli import main"),
        ("records.py", "from armland.models import arm"),
        ("__init__.py", "from .runtime import loop"),
        ("made_up.py", "import numpy"),
    ],
)
def test_import_against_the_arrows_is_found(path: str, source: str) -> None:
    assert len(violations(source, path)) == 1


@pytest.mark.parametrize(
    ("path", "source"),
    [
        ("control/made_up.py", "from armland.models import arm\nfrom .impedance import law\nfrom . import limits"),
        ("control/made_up.py", "import plant\nfrom planting import armland_plant"),
        ("config.py", "from armland.errors import ConfigurationError"),
        ("plant/made_up.py", "from ..runtime import ports\nfrom armland.models import uav"),
        ("cli.py", "from armland import __version__\nfrom armland.view import report"),
        ("__main__.py", "from armland.cli import main"),
    ],
)
def test_import_along_the_arrows_passes(path: str, source: str) -> None:
    assert violations(source, path) == []


def test_modules_are_short() -> None:
    lengths = {m.relative_to(PACKAGE).as_posix(): len(m.read_text("utf-8").splitlines()) for m in PACKAGE.rglob("*.py")}
    assert {name: lines for name, lines in lengths.items() if lines > MAX_LINES} == {}


def test_modules_are_named_by_a_noun_that_says_something() -> None:
    files = [f.relative_to(ROOT) for top in ("src", "tests", "benchmarks") for f in (ROOT / top).rglob("*.py")]
    names = {f.as_posix(): {Path(part).stem.removeprefix("test_") for part in f.parts} for f in files}
    assert [name for name, words in names.items() if words & FORBIDDEN_NAMES] == []
