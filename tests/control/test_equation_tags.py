"""One home per equation: a tag at the end of a line of code, `# (29)`, stands in one module only."""

import io
import re
import tokenize
from collections import defaultdict
from pathlib import Path

PACKAGE = Path(__file__).parents[2] / "src" / "armland"
TAG = re.compile(r"\((\d{1,2}|[A-Z]\.\d{1,2})\)")

ORACLES = (
    "experiments/proof/",
    "experiments/subsystem.py",
    "experiments/poses.py",
    "experiments/attribution.py",
    "experiments/cases.py",
)
"""Second derivations of (9) to (11) and of the proof, by which the laws are checked: they may not share the laws' lines."""


def tags(source: str) -> set[str]:
    """Equation tags of a module's lines of code: comments that begin with one. Elsewhere it only speaks of an equation."""
    found = set()
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        behind_code = token.type == tokenize.COMMENT and token.line[: token.start[1]].strip()
        if behind_code and TAG.match(token.string, 2):
            found |= set(TAG.findall(token.string))
    return found


def homes() -> dict[str, list[str]]:
    """Modules of each tag, relative to the package."""
    found = defaultdict(list)
    for module in sorted(PACKAGE.rglob("*.py")):
        name = module.relative_to(PACKAGE).as_posix()
        if not name.startswith(ORACLES):
            for tag in tags(module.read_text(encoding="utf-8")):
                found[tag].append(name)
    return found


def test_no_equation_is_implemented_in_two_modules() -> None:
    assert {tag: modules for tag, modules in homes().items() if len(modules) > 1} == {}


def test_the_laws_have_their_homes() -> None:
    known = homes()
    for tag, part in {
        "6": "control/laws/impedance.py",
        "29": "control/laws/backstepping.py",
        "33": "control/laws/backstepping.py",
        "35": "control/laws/realisation.py",
        "X.1": "control/laws/exact.py",
        "X.2": "control/laws/realisation.py",
        "X.3": "estimation/disturbance.py",
        "X.4": "control/laws/limits.py",
        "X.5": "models/environment.py",
        "X.6": "control/laws/attitude.py",
        "K.1": "control/laws/station_keeping.py",
    }.items():
        assert known[tag] == [part]


def test_a_tag_is_found_at_code_and_nowhere_else() -> None:
    source = '"""Source: (6)."""\n# (7)\nx = 1  # (29), (X.1)\ny = "(33)"  # of (B.3)\n'
    assert tags(source) == {"29", "X.1"}
