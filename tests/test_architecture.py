"""Who may know whom, and how large a thing may be: the rules of the design, read from the sources."""

import ast
import importlib.util
import io
import re
import statistics
import tokenize
from collections import defaultdict
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

import pytest

from pages.drawings import IMPORTS

ROOT = Path(__file__).parents[1]
PACKAGE = ROOT / "src" / "armland"
MODULES = {m.relative_to(PACKAGE).as_posix(): m.read_text("utf-8") for m in sorted(PACKAGE.rglob("*.py"))}

# From left to right: a part may import itself and what stands in an earlier group, not its neighbours in the same one.
LAYERS = (
    ("foundation",),
    ("models",),
    ("control", "estimation"),
    ("laws",),
    ("mission",),
    ("runtime",),
    ("plant", "links"),
    ("experiments",),
    ("vision",),
    ("view",),
    ("console",),
    ("cli",),
)
FOUNDATION = {"__init__", "errors", "rotations", "records", "native", "linking", "compiled", "scenario"}
LAYER_OF = {part: depth for depth, parts in enumerate(LAYERS) for part in parts}
FORBIDDEN_NAMES = {"utils", "helpers", "common", "manager", "base"}

MAX_LINES = 300
MAX_MEDIAN = 110
MAX_FILES = 14
MAX_CODE = 40
MAX_ARGUMENTS = 8
MAX_PACKAGE = 18_500
MIN_TEST_SHARE = 0.9

# Their signatures are the published ones: users call them as they stand.
PUBLISHED = {
    "paper_law": "(29)",
    "lyapunov": "(26) and (30)",
    "exact_law": "(X.1)",
    "exact_lyapunov": "(X.1)",
}


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
    assert MODULES
    assert [v for path, source in MODULES.items() for v in violations(source, path)] == []


def undrawn(arrows: set[tuple[str, str]]) -> set[tuple[str, str]]:
    """Imports along no path of arrows, and arrows along which nothing is imported."""
    used = set()
    for path, source in MODULES.items():
        *folders, file = Path(path).parts
        own = part_of(folders[0] if folders else Path(file).stem)
        names = [part_of(name) for _, name in imported_names(source, ".".join(["armland", *folders]))]
        used |= {(own, name if name in LAYER_OF else "foundation") for name in names}
    reached = set(arrows)
    while more := {(a, d) for a, b in reached for c, d in reached if b == c} - reached:
        reached |= more
    return {(a, b) for a, b in used - reached if a != b} | (arrows - used)


def test_drawing_shows_what_is_imported() -> None:
    arrows = set(IMPORTS)
    assert undrawn(arrows) == set()
    assert undrawn(arrows - {("mission", "estimation")}) == {("mission", "estimation"), ("plant", "estimation")}
    assert undrawn(arrows | {("runtime", "plant")}) == {("runtime", "plant")}


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
        ("control/laws/made_up.py", "from armland.laws import paper_law"),
        ("estimation/made_up.py", "from armland.control import impedance"),
        ("links/made_up.py", "from armland.plant import scene"),
        ("plant/made_up.py", "from armland.links import fri"),
        ("models/made_up.py", "from armland.control import impedance"),
        ("mission/made_up.py", "from armland.runtime import loops"),
        ("runtime/made_up.py", "from armland.plant import scene"),
        ("experiments/made_up.py", "from armland.view import figures"),
        ("experiments/made_up.py", "from armland.vision import study"),
        ("view/made_up.py", "from armland.cli import main"),
        ("vision/made_up.py", "from armland.view import figures"),
        ("records.py", "from armland.models import arm"),
        ("scenario/made_up.py", "from armland.models import arm"),
        ("laws.py", "from armland.mission import act"),
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
        ("scenario/made_up.py", "from armland.errors import ConfigurationError\nfrom armland.records import layout"),
        ("plant/made_up.py", "from ..runtime import ports\nfrom armland.models import uav"),
        ("cli.py", "from armland import __version__\nfrom armland.view import report"),
        ("__main__.py", "from armland.cli import main"),
        ("laws.py", "from armland.control.laws.exact import exact_law"),
    ],
)
def test_import_along_the_arrows_passes(path: str, source: str) -> None:
    assert violations(source, path) == []


def lengths() -> dict[str, int]:
    return {path: len(source.splitlines()) for path, source in MODULES.items()}


def test_modules_are_short() -> None:
    assert {path: lines for path, lines in lengths().items() if lines > MAX_LINES} == {}


def test_half_of_the_modules_are_very_short() -> None:
    assert (
        statistics.median(lines for path, lines in lengths().items() if not path.endswith("__init__.py")) <= MAX_MEDIAN
    )


@pytest.mark.xfail(strict=True, reason="55,400 lines; docstrings with shapes, units and frames are a third of them")
def test_package_is_small() -> None:
    assert sum(lengths().values()) <= MAX_PACKAGE


@pytest.mark.parametrize("part", ["", "mission"])
def test_tests_are_as_long_as_what_they_test(part: str) -> None:
    package = sum(lines for path, lines in lengths().items() if path.startswith(part))
    tests = sum(len(f.read_text("utf-8").splitlines()) for f in (ROOT / "tests" / part).rglob("*.py"))
    assert tests >= MIN_TEST_SHARE * package, f"{tests} lines of tests for {package}"


def test_folders_are_narrow() -> None:
    width: dict[str, int] = defaultdict(int)
    for path in MODULES:
        width[Path(path).parent.as_posix()] += 1
    assert {folder: files for folder, files in width.items() if files > MAX_FILES} == {}


def code_lines(function: ast.FunctionDef, source: str) -> int:
    """Lines of a function that hold code: neither its docstring nor blank or comment alone."""
    text = "\n".join(source.splitlines()[function.lineno - 1 : function.end_lineno])
    docstrings: set[int] = set()
    for node in ast.walk(function):
        if isinstance(node, ast.FunctionDef | ast.ClassDef) and ast.get_docstring(node) is not None:
            first = node.body[0]
            docstrings |= set(range(first.lineno, (first.end_lineno or first.lineno) + 1))
    idle = (tokenize.COMMENT, tokenize.NL, tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT, tokenize.ENDMARKER)
    lines: set[int] = set()
    indent = len(text) - len(text.lstrip())
    plain = "\n".join(line[indent:] for line in text.splitlines())
    for token in tokenize.generate_tokens(io.StringIO(plain).readline):
        if token.type not in idle:
            lines |= set(range(token.start[0], token.end[0] + 1))
    return len({line + function.lineno - 1 for line in lines} - docstrings)


def arguments(function: ast.FunctionDef) -> int:
    """Number of arguments of a function without `self`."""
    a = function.args
    names = [arg.arg for arg in (*a.posonlyargs, *a.args, *a.kwonlyargs)]
    return len(names) - (names[:1] in (["self"], ["cls"])) + (a.vararg is not None) + (a.kwarg is not None)


def functions(source: str) -> Iterator[ast.FunctionDef]:
    yield from (node for node in ast.walk(ast.parse(source)) if isinstance(node, ast.FunctionDef))


def test_functions_are_short() -> None:
    found = {f"{p}:{f.name}": code_lines(f, s) for p, s in MODULES.items() for f in functions(s)}
    assert {name: lines for name, lines in found.items() if lines > MAX_CODE} == {}


def test_functions_take_few_arguments() -> None:
    found = {f"{p}:{f.name}": arguments(f) for p, s in MODULES.items() for f in functions(s) if f.name not in PUBLISHED}
    assert {name: count for name, count in found.items() if count > MAX_ARGUMENTS} == {}


def test_published_laws_are_there() -> None:
    names = {f.name for p, s in MODULES.items() if p.startswith("control/laws/") for f in functions(s)}
    assert set(PUBLISHED) <= names


COUNTED = '''
class A:
    def f(self, a, *rest, b=1, **more):
        """Says.

        More.
        """
        # Why.

        x = (
            1,
            # Because.
            2,
        )
        text = """a

        b"""
        def inner():
            """Says."""
            return x
        return text + """c"""  # (29)
'''


def test_lines_of_code_and_arguments_are_counted_without_what_is_none() -> None:
    outer, inner = list(functions(COUNTED))
    assert (code_lines(outer, COUNTED), code_lines(inner, COUNTED)) == (11, 2)
    assert (arguments(outer), arguments(inner)) == (4, 0)


TAG = re.compile(r"#.*?\(((?:[A-Z]\.)?\d+[a-z]?)\)\s*$")


def tags(source: str) -> set[str]:
    """Tags of equations in the comments at the ends of lines of code."""
    found = set()
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        match = TAG.search(token.string) if token.type == tokenize.COMMENT else None
        if match and token.line[: token.start[1]].strip():
            found.add(match[1])
    return found


def test_every_equation_has_one_home() -> None:
    homes: dict[str, list[str]] = defaultdict(list)
    for path, source in MODULES.items():
        for tag in tags(source):
            homes[tag].append(path)
    assert len(homes) > 15
    assert {tag: paths for tag, paths in homes.items() if len(paths) > 1} == {}


def test_tags_are_found_at_the_end_of_code_alone() -> None:
    source = "x = 1  # (29)\n# as in (30)\ny = 2  # law, (X.3)\nz = 3  # (31) holds\ns = '# (32)'\nw = 1  # (18a)\n"
    assert tags(source) == {"29", "X.3", "18a"}


LONGEST_PAIR = 12


def logic(source: str) -> list[tuple[int, str]]:
    """Line number and text of each line of logic: no imports, docstrings, comments, signatures, brackets and tables alone."""
    tree = ast.parse(source)
    skipped: set[int] = set()
    for node in ast.walk(tree):
        text = isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)
        if text or isinstance(node, ast.Import | ast.ImportFrom):
            skipped |= set(range(node.lineno, (node.end_lineno or node.lineno) + 1))
    lines = [
        (i, line.split("  #")[0].strip()) for i, line in enumerate(source.splitlines(), start=1) if i not in skipped
    ]
    return [(i, line) for i, line in lines if len(line) > 2 and not line.startswith("#")]


def pairs(sources: dict[str, str]) -> list[str]:
    """Places where `LONGEST_PAIR` + 1 lines of logic are the same as elsewhere."""
    seen: dict[tuple[str, ...], str] = {}
    found: list[str] = []
    for path, source in sources.items():
        lines = logic(source)
        for start in range(len(lines) - LONGEST_PAIR):
            window = lines[start : start + LONGEST_PAIR + 1]
            key, place = tuple(line for _, line in window), f"{path}:{window[0][0]}"
            if key in seen:
                found.append(f"{place} = {seen[key]}")
            seen.setdefault(key, place)
    return found


def test_logic_stands_once() -> None:
    assert pairs(MODULES) == []


def test_logic_that_stands_twice_is_found() -> None:
    body = "".join(f"    x{i} = compute({i})\n" for i in range(LONGEST_PAIR + 1))
    twice = {"a.py": f"def f():\n{body}", "b.py": f"import os\n\ndef g(y):\n    # Why.\n{body}"}
    assert pairs(twice) == ["b.py:5 = a.py:2"]
    assert pairs({"a.py": twice["a.py"], "b.py": twice["b.py"].replace("x7 = compute(7)", "x7 = 7")}) == []


def test_modules_are_named_by_a_noun_that_says_something() -> None:
    files = [f.relative_to(ROOT) for top in ("src", "tests", "benchmarks", "tools") for f in (ROOT / top).rglob("*.py")]
    names = {f.as_posix(): {Path(part).stem.removeprefix("test_") for part in f.parts} for f in files}
    assert [name for name, words in names.items() if words & FORBIDDEN_NAMES] == []


HEAVY = re.compile(
    r"(load_scenario|fly|fly_in_python|plan|prepare|build\w*|compose\w*|survey|assemble|Simulator|Controller|ArmModel|Bench"
    r"|from_xml_\w+|from_file|MjSpec|MjModel|MjData|read_log|main|run)$"
)


def heavy_at_import(source: str) -> list[str]:
    """Calls in a test's module that load, build or fly something while it is imported."""
    found: list[str] = []

    def search(node: ast.AST) -> None:
        # The body of a function runs later; its decorators and defaults run at import.
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            inner: list[ast.AST] = [*node.decorator_list, *node.args.defaults, *filter(None, node.args.kw_defaults)]
        elif isinstance(node, ast.Lambda):
            inner = []
        else:
            inner = list(ast.iter_child_nodes(node))
        if isinstance(node, ast.Call) and HEAVY.search(ast.unparse(node.func).split(".")[-1]):
            found.append(f"{node.lineno}: {ast.unparse(node.func)}")
        for one in inner:
            search(one)

    search(ast.parse(source))
    return found


def test_tests_set_nothing_up_at_import() -> None:
    tests = sorted((ROOT / "tests").rglob("*.py"))
    found = {t.relative_to(ROOT).as_posix(): heavy_at_import(t.read_text("utf-8")) for t in tests}
    assert {name: calls for name, calls in found.items() if calls} == {}


def test_set_up_at_import_is_found() -> None:
    source = (
        "S = load_scenario('paper')\nclass T:\n    x = plant.Simulator(1)\n"
        "@pytest.mark.parametrize('n', fly(S).names)\ndef test(n, m=plan(S)):\n    fly(S)\n"
        "build = lambda: fly(S)\ndef f():\n    return load_scenario('paper')\n"
    )
    assert [call.split(": ")[1] for call in heavy_at_import(source)] == [
        "load_scenario",
        "plant.Simulator",
        "fly",
        "plan",
    ]


def test_names_of_the_layers_are_folders_or_modules() -> None:
    present = {Path(path).parts[0].removesuffix(".py") for path in MODULES}
    assert {part for part in LAYER_OF if part not in ("foundation", "links")} <= present
    assert all(LAYER_OF[a] <= LAYER_OF[b] for a, b in pairwise(LAYER_OF))


def defined(source: str) -> Iterator[tuple[str, int]]:
    """Name and lines of each function, class, method and constant of a module that has a name of its own."""
    tree = ast.parse(source)
    # A method of a class with a base may be what the base calls.
    hooks = {f for c in ast.walk(tree) if isinstance(c, ast.ClassDef) and c.bases for f in c.body}
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef | ast.ClassDef) and not node.name.startswith("__") and node not in hooks:
            # A decorator may register what it decorates, a check of pydantic or a command.
            called = any(isinstance(d, ast.Call) and "njit" not in ast.unparse(d) for d in node.decorator_list)
            if not called or "lru_cache" in ast.unparse(node.decorator_list[0]):
                yield node.name, (node.end_lineno or node.lineno) - node.lineno + 1
    for node in tree.body:
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name):
            yield node.targets[0].id, 1


def unused(sources: dict[str, str], users: list[str]) -> dict[str, int]:
    """What is defined in `sources` and named nowhere else there or in the texts of `users`: path and name -> lines."""
    words: dict[str, int] = defaultdict(int)
    for text in (*sources.values(), *users):
        for word in re.findall(r"\w+", text):
            words[word] += 1
    return {f"{path}:{name}": n for path, source in sources.items() for name, n in defined(source) if words[name] < 2}


def reachable(sources: dict[str, str], roots: list[str]) -> set[str]:
    """Paths of the modules that the modules `roots` import, directly or not."""
    known = {path.removesuffix(".py").removesuffix("/__init__").replace("/", "."): path for path in sources}
    done, todo = set(), list(roots)
    while todo:
        path = todo.pop()
        if path in done:
            continue
        done.add(path)
        package = ".".join(["armland", *Path(path).parts[:-1]])
        for node in ast.walk(ast.parse(sources[path])):
            names: list[str] = []
            if isinstance(node, ast.ImportFrom):
                module = importlib.util.resolve_name("." * node.level + (node.module or ""), package)
                names = [module, *(f"{module}.{alias.name}" for alias in node.names)]
            elif isinstance(node, ast.Import):
                names = [alias.name for alias in node.names]
            elif isinstance(node, ast.Constant) and isinstance(node.value, str) and node.value.startswith("armland."):
                names = [node.value]
            todo += [known[n] for name in names if (n := name.removeprefix("armland.")) in known]
            todo += [
                known[p] for name in names for p in (name.removeprefix("armland.").rpartition(".")[0],) if p in known
            ]
    return done


def test_every_module_is_used() -> None:
    assert set(MODULES) - reachable(MODULES, ["__init__.py", "__main__.py", "cli/__init__.py"]) <= {
        path for path, source in MODULES.items() if path.endswith("__init__.py") and len(source) < 200
    }


def test_everything_is_used_by_more_than_tests() -> None:
    texts = [
        f.read_text("utf-8")
        for top in ("examples", "benchmarks", "tools", "docs")
        for f in (ROOT / top).rglob("*.[pm][yd]")
    ]
    found = unused(MODULES, [*texts, (ROOT / "README.md").read_text("utf-8")])
    assert found == {}


def test_what_nobody_uses_is_found() -> None:
    sources = {
        "a.py": "SIZE = 1\n\ndef used():\n    return 1\n\ndef idle():\n    return used()\n",
        "b.py": "@njit(cache=True)\ndef law():\n    return 1\n\n@app.command()\ndef fly():\n    pass\n",
    }
    assert unused(sources, []) == {"a.py:SIZE": 1, "a.py:idle": 2, "b.py:law": 2}
    assert unused(sources, ["`idle` and SIZE, law"]) == {}
    linked = {
        "__init__.py": "HOMES = {'x': 'armland.a'}",
        "a.py": "from . import b",
        "b.py": "",
        "c/d.py": "",
        "c/__init__.py": "",
    }
    assert reachable(linked, ["__init__.py"]) == {"__init__.py", "a.py", "b.py"}
