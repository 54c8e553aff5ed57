"""Which changes are tried: each kind of the table, once for each place, and nothing that does not compute."""

import importlib.util
import sys
from pathlib import Path

import pytest

TOOLS = Path(__file__).parents[2] / "tools"


@pytest.fixture(scope="module")
def changes():
    spec = importlib.util.spec_from_file_location("changes", TOOLS / "changes.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules["changes"] = module
    spec.loader.exec_module(module)
    return module


def variants(changes, expression):
    """What an expression in a function may become."""
    source = f"def f(a, b, k, x):\n    return {expression}\n"
    return {c.applied(source).split("return ")[1].strip() for c in changes.changes("m.py", source)}


KINDS = [
    ("a + b", {"(a - b)", "a", "b"}),
    ("a - b", {"(a + b)", "a", "(-b)"}),
    ("a * b", {"(a / b)"}),
    ("-a", {"a"}),
    ("not a", {"a"}),
    ("a and b", {"(a or b)"}),
    ("a < b", {"(a >= b)"}),
    ("k < 3", {"(k >= 3)", "(k <= 3)"}),
    ("a == b", {"(a != b)"}),
    ("k + 1", {"(k - 1)", "k", "1", "(k + 2)"}),
    ("range(3)", {"range(4)"}),
    ("0.5", {"1.0"}),
    ("2.0", {"1.0"}),
    ("min(a, b)", {"max(a, b)"}),
    ("np.minimum(a, b)", {"np.maximum(a, b)"}),
    ("math.sin(a)", {"math.cos(a)"}),
    ("x[0]", {"(x[1])"}),
    ("x[2]", {"(x[1])"}),
    ("x[:3]", {"(x[3:])"}),
    ("x[a, b]", {"(x[b, a])"}),
    ("x[a, 0]", {"(x[0, a])", "(x[a, 1])"}),
    ("a.T @ b", {"(a @ b)"}),
    ("a", set()),
    ("f'{a + 1}'", set()),
    ("'a' + b", set()),
]


@pytest.mark.parametrize(("expression", "expected"), KINDS)
def test_each_kind_of_change_is_made(changes, expression, expected) -> None:
    assert variants(changes, expression) == expected


SOURCE = '''"""Module - text."""

from a import b

SIZE = 3 - 1


def told_layout(joints):
    return [("x", "f8", (3 - 1,))]


class Law:
    """Class - text."""

    def act(self, a: "x - y", size=2 - 1):
        """Function - text."""
        if a is None:
            raise ValueError("no " + str(a - 1))
        ä = a - 1  # Why - because.
        ä -= a * 0.5
        return ä - 1
'''


def test_only_what_computes_is_changed_and_each_change_compiles(changes) -> None:
    found = changes.changes("m.py", SOURCE)
    assert {c.function for c in found} == {"Law.act"}
    assert {c.line for c in found} == {17, 19, 20, 21}
    for change in found:
        new = change.applied(SOURCE)
        compile(new, "m.py", "exec")
        assert new != SOURCE
        assert len([1 for a, b in zip(new.split("\n"), SOURCE.split("\n"), strict=True) if a != b]) == 1


def test_change_keeps_its_name_when_lines_move_and_names_are_unique(changes) -> None:
    keys = [c.key for c in changes.changes("m.py", SOURCE)]
    assert keys == [c.key for c in changes.changes("m.py", SOURCE.replace('"""Module', '"""\n\nModule'))]
    assert len(set(keys)) == len(keys)
    assert "m.py:Law.act: a - 1 -> (a + 1)" in keys
    twice = "def f(a, b):\n    return a - b, a - b\n"
    assert [c.number for c in changes.changes("m.py", twice)] == [1, 1, 1, 2, 2, 2]
    last = changes.changes("m.py", twice)[-1]
    assert last.key.endswith(" #2")
    assert last.applied(twice) == "def f(a, b):\n    return a - b, (-b)\n"


def test_changed_operand_stays_one_operand(changes) -> None:
    source = "def f(a, b, c):\n    return c * (a - b)\n"
    results = {
        eval(c.applied(source).split("return ")[1], {"a": 5.0, "b": 3.0, "c": 2.0})
        for c in changes.changes("m.py", source)
    }
    assert results == {2.0 * 8.0, 2.0 * 5.0, 2.0 * -3.0, 2.0 / 2.0}
