"""Scenario files damaged at random: they load, or they are refused in words; nothing else happens."""

import json
import random
import tomllib
from pathlib import Path

import pytest

from armland.errors import ConfigurationError
from armland.scenario import SCENARIOS, Scenario, load_scenario

COUNT = 250

FORMER = """
base = "paper"
seed = 3
carry_share = 0.45
[place]
catch_m = [0.62, 0.0, 0.86]
[eye]
rate_hz = 60
[envelope]
tilt_deg = 25.0
[[faults]]
kind = "push"
size = 0.5
direction = [0.0, 1.0, 0.0]
[demonstrator.uav]
file = "mine.xml"
mass_kg = 0.6
inertia_kgm2 = [[0.006, 0.0, 0.0], [0.0, 0.007, 0.0], [0.0, 0.0, 0.012]]
[belief.rotors]
max_thrust_n = 2.5
[experiments.mine]
law = "a.py:f"
"""

VALUES = [
    "nan",
    "inf",
    "-inf",
    "1e308",
    "-1e308",
    "1e-320",
    "-0.0",
    "0",
    "-1",
    "9223372036854775807",
    "9223372036854775808",
    "1" * 5000,
    "0x" + "f" * 300,
    "true",
    "''",
    '"' + "x" * 5000 + '"',
    '"\\u0000"',
    '"\\U0010FFFF ﷽ \\u202e"',
    '"../../etc/passwd"',
    '"paper"',
    '"/dev/zero"',
    "[]",
    "[[[[[[[[[[[[[[1]]]]]]]]]]]]]]",
    "[1, 'a', [2.0], {a = 1}]",
    "{}",
    "{ a.b.c.d.e.f.g.h.i.j.k.l.m.n.o = 1 }",
    "1979-05-27T07:32:00Z",
    "[" + "0.0, " * 3000 + "0.0]",
]

LINES = [
    "[run]",
    "[link]",
    "[[faults]]",
    "[[faults]]\nkind = 'rotor_loss'\nsize = 2.0",
    "[demonstrator]",
    "[demonstrator.uav]\nmass_kg = 'heavy'",
    "[belief]\nuav = 3",
    "[belief.uav]\nmass_kg = -1.0",
    "[belief.experiments.x]",
    "[experiments.'../x']",
    "[experiments.'']",
    "base = 'mine.toml'",
    "base = 'landing'",
    "base = 'calibration'",
    "calibration = 'calibration.toml'",
    "calibration = 'paper.toml'",
    "calibration = 'mine.toml'",
    "a.b.c.d.e.f.g.h.i.j.k.l.m.n.o.p = 1",
    "'' = 1",
    '"a.b" = 1',
    "\ufeff",
    "\x00",
    "[envelope]\ntilt_deg = {}",
    "[eye]\ncamera_m = 'there'",
]


def damaged(text: str, rng: random.Random) -> bytes:
    """The text of a scenario with one to four mistakes of all kinds."""
    for _ in range(rng.randint(1, 4)):
        lines = text.split("\n")
        at = rng.randrange(len(lines))
        match rng.randrange(8):
            case 0 | 1 | 2 if "=" in lines[at]:
                lines[at] = lines[at].split("=")[0] + "= " + rng.choice(VALUES)
            case 3:
                lines.insert(at, rng.choice(LINES))
            case 4:
                lines.insert(at, lines[rng.randrange(len(lines))])
            case 5 if lines[at]:
                cut = rng.randrange(len(lines[at]))
                lines[at] = (
                    lines[at][:cut]
                    + chr(rng.choice([0, 9, 34, 46, 61, 91, 93, 125, 0xE9, 0x1F600]))
                    + lines[at][cut + 1 :]
                )
            case 6:
                del lines[at : at + rng.randint(1, 5)]
            case 7 if "=" in lines[at]:
                lines[at] = f"misspelt_{lines[at].strip()}"
        text = "\n".join(lines)
    content = text.encode("utf-8", "surrogatepass")
    if rng.random() < 0.05:
        at = rng.randrange(len(content) + 1)
        content = content[:at] + rng.randbytes(rng.randint(1, 20)) + content[at:]
    return content


def judge(content: bytes, file: Path) -> str:
    """What becomes of a file: `loads`, or `refused` in words that name it.

    Raises:
        AssertionError: the message is no message.
    """
    file.write_bytes(content)
    try:
        scenario = load_scenario(file)
    except ConfigurationError as e:
        message = str(e)
        assert message.startswith(file.name)
        assert len(message) < 20_000
        for internal in ("Traceback", "pydantic", "input_value", "constrained", "type="):
            assert internal not in message, message
        return "refused"
    # What has loaded is a scenario for everyone: written, read, believed, changed.
    assert Scenario.model_validate_json(scenario.model_dump_json()).model_dump() == scenario.model_dump()
    assert scenario.believed().belief == {}
    assert scenario.with_seed(5).run.seed == 5
    return "loads"


TEXTS = {
    name: (SCENARIOS / f"{name}.toml").read_text("utf-8") for name in ("paper", "landing", "compare", "calibration")
}


@pytest.mark.parametrize("name", [*TEXTS, "former"])
def test_damaged_file_loads_or_is_refused_in_words(tmp_path, name) -> None:
    rng, text = random.Random(name), TEXTS.get(name, FORMER)
    outcomes = [judge(damaged(text, rng), tmp_path / "mine.toml") for _ in range(COUNT)]
    assert outcomes.count("refused") > COUNT / 4
    assert name == "calibration" or outcomes.count("loads") > 3


def test_damaged_calibration_is_refused_in_words(tmp_path) -> None:
    rng = random.Random("calibrated")
    outcomes = []
    for _ in range(COUNT):
        (tmp_path / "calibration.toml").write_bytes(damaged(TEXTS["calibration"], rng))
        outcomes.append(judge(TEXTS["paper"].encode(), tmp_path / "mine.toml"))
    assert "refused" in outcomes


@pytest.mark.parametrize("name", ["paper", "landing", "compare"])
def test_shortened_file_loads_or_is_refused_in_words(tmp_path, name) -> None:
    content = TEXTS[name].encode()
    outcomes = [judge(content[:end], tmp_path / "mine.toml") for end in range(0, len(content), 41)]
    assert "refused" in outcomes


def outcome(overrides) -> str:
    """Whether overrides load, or which word of the message says where the mistake is."""
    try:
        load_scenario("landing", overrides)
    except ConfigurationError as e:
        return next((word for word in (*overrides, "overrides") if word in str(e)), str(e))
    return "loads"


def test_every_value_in_place_of_every_number_is_refused_or_loads() -> None:
    """One value at a time, as from the command line, with each of the odd values."""
    plain = json.loads(load_scenario("landing").model_dump_json())
    rng, odd = random.Random(1), []
    for value in VALUES:
        try:
            odd.append(tomllib.loads(f"a = {value}")["a"])
        except ValueError:
            continue
    assert len(odd) > 20
    for section, table in plain.items():
        for key in table if isinstance(table, dict) else ():
            for value in rng.sample(odd, 4):
                assert outcome({section: {key: value}}) in ("loads", section, "overrides")
