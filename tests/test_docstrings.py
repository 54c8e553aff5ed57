"""What docstrings of the parts that compute say: something beyond the name, shapes, units, errors and sources.

A docstring may leave to its module's what stands in the module's table of symbols, and a method's to its class's.
"""

import ast
import io
import re
import tokenize
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import pytest

PACKAGE = Path(__file__).parents[1] / "src" / "armland"
PARTS = ("models", "control", "estimation", "mission", "plant")
MODULES = {
    m.relative_to(PACKAGE).as_posix(): m.read_text("utf-8")
    for part in PARTS
    for m in sorted((PACKAGE / part).rglob("*.py"))
}

ARRAY = re.compile(r"\b(Array|NDArray|ndarray)\b")
SHAPE = re.compile(r"\((?:[\w+ ]+,[\w+, ]*)\)")
UNITS = (
    r"m/s[²³]?(/√Hz)?|rad/s²?|rad|deg(rees)?|1/s²?|1/m|N·m(·s)?(/rad)?|N/s|N/m|N·s/m|N|kg·m²?|kg|m²?|metres|s|seconds|ms|Hz|J"
    r"|px|pixels?|bits|ticks?|1|units?|shares?|fractions?|factors?|ratios?|quaternions?|rotations?|directions?|axis|axes"
    r"|standard normal|probabilit(y|ies)|index|indices|counts?|scalar first|covariances?|true|flags?"
)
UNIT = re.compile(rf"(?<![\w.'’])({UNITS})(?!\w)")
SUFFIX = re.compile(r"_(m|s|n|nm|rad|deg|hz|mps|mps2|kg|ms|px|share|ratio|rad_s|kgm2|kgm3|nspm|nps|tick|w|j)$")
IDLE = """
a an and are as at be by for from get gets give gives given has have if in into is it its new of on or return returns set sets that
the their them then there this to was what where which will with compute computes calculate calculates do does make makes function
method class value values one
"""
LAYOUTS = ("told_layout", "kept_layout")
"""Records' layouts; each field's unit and meaning stand beside it."""


class Item(NamedTuple):
    """A public function, method or class, and the texts that speak of it."""

    place: str
    node: ast.FunctionDef | ast.ClassDef
    own: str
    around: str
    """Docstrings of the module and of the class."""


def public(path: str, source: str) -> Iterator[Item]:
    """Public functions, classes and their public methods of a module."""
    tree = ast.parse(source)
    module = ast.get_docstring(tree) or ""
    for node in tree.body:
        if not isinstance(node, ast.FunctionDef | ast.ClassDef) or node.name.startswith("_"):
            continue
        own = ast.get_docstring(node) or ""
        yield Item(f"{path}:{node.name}", node, own, module)
        if isinstance(node, ast.ClassDef):
            for inner in node.body:
                if isinstance(inner, ast.FunctionDef) and (not inner.name.startswith("_") or inner.name == "__init__"):
                    # What a class is made of is said where the class is described.
                    text = ast.get_docstring(inner) or (own if inner.name == "__init__" else "")
                    yield Item(f"{path}:{node.name}.{inner.name}", inner, text, f"{own}\n\n{module}")


def words(text: str) -> list[str]:
    """Words of a text, small, cut to a stem: `loads`, `loading` and `load` are one."""
    return [re.sub(r"(ings?|ed|es|s|e)$", "", word) or word for word in re.findall(r"[^\W_]+", text.lower())]


def says_nothing(item: Item) -> str | None:
    """Why a docstring says nothing, or None: its first sentence must go beyond the name, and all of it by two words at least."""
    if not item.own:
        return "no docstring"
    first = re.split(r"\n\n|(?<=[.:;])\s", item.own, maxsplit=1)[0]
    called = item.place.split(":")[1]
    known = {*words(IDLE), *words(re.sub(r"([a-z])([A-Z])", r"\1 \2", called.replace("_", " ")))}
    least = 1 if called in LAYOUTS else 2
    if set(words(first)) <= known or len(set(words(item.own)) - known) < least:
        return f"`{first}` says no more than the name"
    return None


ENTRY = re.compile(r"^\s*`?\w+`?(, `?\w+`?)*: ")


def passages(text: str) -> Iterator[str]:
    """What belongs together in a docstring: a row of a table, an entry of a list of arguments, a sentence."""
    for paragraph in re.split(r"\n\s*\n", text):
        lines: list[str] = []
        for line in paragraph.split("\n"):
            if not lines or line.startswith("|") or ENTRY.match(line):
                lines.append(line)
            else:
                lines[-1] += f" {line.strip()}"
        for line in lines:
            yield from [line] if line.startswith("|") or ENTRY.match(line) else re.split(r"(?<=\.)\s", line)


def mentions(name: str, text: str) -> Iterator[str]:
    """The passages that speak of an argument; of one with a name of one letter as `x`, at an entry's or in a row's beginning."""
    for passage in passages(text):
        listed = passage.startswith("|") or ENTRY.match(passage)
        head = passage if passage.startswith("|") else passage.split(":")[0]
        pattern = rf"(?<![\w.]){re.escape(name)}(?!\w)"
        if f"`{name}`" in passage or (listed and re.search(pattern, head)):
            yield passage
        elif not listed and len(name) > 1 and (match := re.search(pattern, passage)):
            yield passage[match.start() :]


def undescribed(item: Item) -> Iterator[str]:
    """Arrays without shape or unit and numbers without unit among the arguments."""
    if not isinstance(item.node, ast.FunctionDef):
        return
    a = item.node.args
    for arg in (*a.posonlyargs, *a.args, *a.kwonlyargs):
        kind = ast.unparse(arg.annotation) if arg.annotation else ""
        said = [*mentions(arg.arg, item.own), *mentions(arg.arg, item.around)]
        plain = [SHAPE.sub("", text) for text in said]
        if ARRAY.search(kind):
            if not any(SHAPE.search(text) for text in said):
                yield f"shape of `{arg.arg}`"
            if not any(UNIT.search(text) for text in plain):
                yield f"unit of `{arg.arg}`"
        elif (
            re.fullmatch(r"float( \| None)?", kind)
            and not SUFFIX.search(arg.arg)
            and not any(UNIT.search(text) for text in plain)
        ):
            yield f"unit of `{arg.arg}`"


def unannounced(item: Item) -> Iterator[str]:
    """Errors that a function raises itself and does not document."""
    if isinstance(item.node, ast.FunctionDef):
        raised = [n.exc for n in ast.walk(item.node) if isinstance(n, ast.Raise) and n.exc is not None]
        for name in sorted({ast.unparse(e.func).split(".")[-1] for e in raised if isinstance(e, ast.Call)}):
            if name not in item.own or "Raises:" not in item.own:
                yield f"raises `{name}`"


TAG = re.compile(r"#.*?\(((?:[A-Z]\.)?\d+[a-z]?)\)\s*$")


def unsourced(source: str) -> list[str]:
    """Tags of equations at the ends of lines of code that no docstring of the module names."""
    tree = ast.parse(source)
    documented = [n for n in ast.walk(tree) if isinstance(n, ast.Module | ast.FunctionDef | ast.ClassDef)]
    text = "\n".join(ast.get_docstring(n) or "" for n in documented)
    for low, high in re.findall(r"\((\d+)\)(?: to |–|-)\((\d+)\)", text):
        text += "".join(f"({number})" for number in range(int(low), int(high) + 1))
    comments = [t.string for t in tokenize.generate_tokens(io.StringIO(source).readline) if t.type == tokenize.COMMENT]
    tags = {match[1] for match in map(TAG.search, comments) if match}
    return sorted(tag for tag in tags if f"({tag})" not in text)


def complaints(path: str, source: str) -> list[str]:
    """All that the docstrings of a module leave out."""
    found = [f"{path}: no docstring names equation ({tag})" for tag in unsourced(source)]
    for item in public(path, source):
        nothing = says_nothing(item)
        found += [f"{item.place}: {nothing}"] if nothing else []
        found += [f"{item.place}: {what}" for what in (*undescribed(item), *unannounced(item))]
    return found


@pytest.mark.parametrize("path", MODULES)
def test_docstrings_say_what_a_reader_needs(path: str) -> None:
    assert complaints(path, MODULES[path]) == []


def test_there_is_something_to_read() -> None:
    assert len(MODULES) > 60
    assert sum(len(list(public(path, source))) for path, source in MODULES.items()) > 200


GOOD = '''"""Laws of something.

| symbol | name | unit |
|---|---|---|
| q | `q` (4,) | 1 |
| v, ω | `v`, `omega` (3,) | m/s, D; rad/s, body |

Source: (14) to (16).
"""

def load_force(q: Array, v: Array, pull: NDArray[np.float64], mass: float, delay_s: float, k: int) -> Array:
    """Newtons that the arm feels under a UAV, D.

    Args:
        pull: of the rotors (3,), N, body.
        mass: of the plate, kg.

    Raises:
        ModelError: the mass is not positive.
    """
    if mass < 0.0:
        raise ModelError("no mass")
    return q  # (15)

def _private(x: Array) -> Array:
    return x

class Filter:
    """Low-pass of a force that the sensor reads.

    Args:
        rate: Hz.
        start: first output (3,), N.
    """

    def __init__(self, rate: float, start: Array) -> None:
        self.rate = rate

    def update(self, force: Array) -> Array:
        """The filtered force after one more sample `force` (3,), N."""
        return force
'''


def test_docstrings_that_say_what_a_reader_needs_pass() -> None:
    assert complaints("good.py", GOOD) == []


SPOILT = [
    ('"""Newtons that the arm feels under a UAV, D.', '"""', "no docstring", False),
    ("Newtons that the arm feels under a UAV, D.", "The load force.", "says no more than the name", True),
    (
        "Newtons that the arm feels under a UAV, D.",
        "Computes the forces of the load.",
        "says no more than the name",
        True,
    ),
    (
        "Newtons that the arm feels under a UAV, D.",
        "Get and return load_force values.",
        "says no more than the name",
        True,
    ),
    ("Newtons that the arm feels under a UAV, D.", "Load force: loaded.", "says no more than the name", True),
    ("Low-pass of a force that the sensor reads.", "A filter.", "Filter: `A filter.` says no more", True),
    ("pull: of the rotors (3,), N, body", "pull: of the rotors, N, body", "shape of `pull`", True),
    ("pull: of the rotors (3,), N, body", "pull: of the rotors (3,), body", "unit of `pull`", True),
    ("pull: of the rotors (3,), N, body.", "", "shape of `pull`", True),
    ("| q | `q` (4,) | 1 |", "| q | `q` | 1 |", "shape of `q`", True),
    ("| q | `q` (4,) | 1 |", "| q | `q` (4,) | |", "unit of `q`", True),
    ("| v, ω | `v`, `omega` (3,)", "| ẋ, ω | `velocity`, `omega` (3,)", "shape of `v`", True),
    ("mass: of the plate, kg.", "mass: of the plate.", "unit of `mass`", True),
    ("rate: Hz.", "rate: of it.", "Filter.__init__: unit of `rate`", True),
    ("one more sample `force` (3,), N", "one more sample `force`", "Filter.update: shape of `force`", True),
    ("ModelError: the mass is not positive.", "", "raises `ModelError`", True),
    ("(14) to (16)", "(14)", "no docstring names equation (15)", True),
]


@pytest.mark.parametrize(("old", "new", "says", "exact"), SPOILT)
def test_docstring_that_leaves_something_out_is_found(old: str, new: str, says: str, exact: bool) -> None:
    assert GOOD.count(old) == 1
    if exact:
        found = complaints("bad.py", GOOD.replace(old, new))
    else:
        # Without its docstring altogether.
        start = GOOD.index(old)
        end = GOOD.index('"""', start + 3) + 3
        found = complaints("bad.py", GOOD[:start] + GOOD[end:])
    assert any(says in line for line in found), found
