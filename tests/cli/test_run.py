"""`armland run`, `land` and `takeoff`: exit codes, one readable message, nothing half-written, logs that can be read."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory

from armland.cli.commands import run
from armland.control.laws.own import ARGUMENTS
from armland.errors import PlantError
from armland.mission.registry import MISSIONS
from armland.mission.supervisor.table import FAULTS
from armland.models.airframe.sizing import sized
from armland.runtime import loops
from armland.runtime.log import read_log
from armland.scenario import SCENARIOS, load_scenario

ROOT = Path(__file__).parents[2]


def sets(*settings: str) -> tuple[str, ...]:
    return tuple(word for setting in settings for word in ("--set", setting))


SCENARIO = 'title = "two"\nbase = "landing"\n[run]\nseed = 2\nduration_s = 1.5\n'

SHORT = sets("run.duration_s=1.5")


def files(folder: Path) -> list[str]:
    return sorted(p.name for p in folder.iterdir())


def test_landing_leaves_result_log_and_figures(armland, tmp_path):
    done = armland("land", "--seed", "3", "--json", "--out", "out", *sets("imperfections.hover_noise_m=0.005"))
    assert done.code == 0, done.err
    result = json.loads(done.out)
    assert result == json.loads((tmp_path / "out" / "result.json").read_text())
    assert (result["success"], result["seed"]) == (True, 3)
    names = ["landing.mcap", "landing_overview.pdf", "landing_overview.png", "report.html", "result.json"]
    assert files(tmp_path / "out") == names
    told = [line.split()[2] for line in done.err.splitlines() if line.strip()[:1].isdigit()]
    assert told == [p["name"] for p in result["phases"]]

    log = read_log(tmp_path / "out" / "landing.mcap")
    assert log.complete
    assert {k: log.metadata[k] for k in ("mission", "seed")} == {"mission": "landing", "seed": "3"}
    assert json.loads(log.metadata["overrides"]) == {
        "deviation": {"level": "published"},
        "imperfections": {"hover_noise_m": 0.005},
    }
    assert log.attachments["scenario.toml"] == (SCENARIOS / "landing.toml").read_bytes()
    assert tuple(log.metadata["faults"].split(",")) == FAULTS
    # A reader who knows nothing but the log finds the phases that were flown.
    phase = log.messages["mission"]["phase"]
    changes = np.flatnonzero(np.diff(phase)) + 1
    flown = [log.metadata["phases"].split(",")[phase[k]] for k in (0, *changes)]
    assert flown == [p["name"] for p in result["phases"]]
    np.testing.assert_allclose(log.time[changes], [p["start_s"] for p in result["phases"][1:]], atol=1e-9)
    force = np.linalg.norm(log.messages["truth"]["hinge_force"], axis=1).max()
    assert force == pytest.approx(result["hinge_force_max_n"], rel=1e-12)


def test_takeoff_s_log_decodes_with_the_library(armland, tmp_path):
    done = armland("takeoff", "--no-figures", "--out", "out", *SHORT)
    assert (done.code, files(tmp_path / "out")) == (1, ["result.json", "takeoff.mcap"]), done.err
    log, decoded = read_log(tmp_path / "out" / "takeoff.mcap"), 0
    with (tmp_path / "out" / "takeoff.mcap").open("rb") as stream:
        reader = make_reader(stream, validate_crcs=True, decoder_factories=[DecoderFactory()])
        for found in reader.iter_decoded_messages(topics=["/armland/mission", "/armland/truth"]):
            message = log.messages[found.channel.topic.removeprefix("/armland/")][found.message.sequence]
            assert found.message.log_time == 1_000_000 * message["tick"]
            for field in message.dtype.names:
                value = np.array(getattr(found.decoded_message, field), message.dtype[field].base)
                assert value.tobytes() == message[field].tobytes()
            decoded += 1
    assert decoded == 2 * 1500


def test_flight_that_fails_is_exit_code_1_and_says_why(armland):
    done = armland("land", "--no-figures", "--no-log", "--out", "out", *SHORT)
    assert done.code == 1
    assert "failure: still in phase" in done.out
    assert "Traceback" not in done.err


def test_same_scenario_and_seed_leave_the_same_log(armland, tmp_path):
    (tmp_path / "mine.toml").write_text(SCENARIO)
    (tmp_path / "other.toml").write_text(SCENARIO)
    for name, scenario, seed in (("a", "mine", ()), ("b", "other", ("--seed", "2")), ("c", "mine", ("--seed", "4"))):
        done = armland("land", f"{scenario}.toml", *seed, "--no-figures", "--out", name)
        assert done.code == 1, done.err
    logs = [(tmp_path / name / "landing.mcap").read_bytes() for name in "abc"]
    assert logs[0] == logs[1]
    assert logs[0] != logs[2]


@pytest.mark.parametrize(
    ("breaks", "code", "word"),
    [
        (KeyboardInterrupt(), 130, "stopped"),
        (PlantError("no longer finite"), 3, "no longer finite"),
        (MemoryError(), 3, "not enough memory"),
        (ZeroDivisionError("x"), 3, "an error inside armland (ZeroDivisionError: x)"),
    ],
)
def test_flight_that_dies_leaves_its_log_and_the_earlier_result(armland, tmp_path, monkeypatch, breaks, code, word):
    earlier = ["campaign.json", "landing.mcap", "landing_overview.png", "notes.txt", "result.json"]
    for name in earlier:
        (tmp_path / name).write_text("of an earlier run")
    flown = loops.fly

    def dies(simulator, controller, plan, recorder, progress=None):
        def told(phase, t):
            if phase == "guide":
                raise breaks

        return flown(simulator, controller, plan, recorder, told)

    monkeypatch.setattr(loops, "fly", dies)
    done = armland("land", "--out", ".")
    assert done.code == code
    assert word in done.err
    assert "unfinished" in done.err
    assert "Traceback" not in done.err
    assert files(tmp_path) == [*earlier, "unfinished"]
    assert (tmp_path / "result.json").read_text() == "of an earlier run"
    log = read_log(tmp_path / "unfinished" / "landing.mcap")
    ticks = log.messages["truth"]["tick"]
    assert len(ticks) >= 500
    assert ticks.tolist() == list(range(len(ticks)))


def test_killed_flight_leaves_whole_blocks(tmp_path):
    code = """
import os, sys, pathlib
import armland
def kill(phase, t):
    if phase == "guide":
        os._exit(9)
armland.fly(armland.load_scenario("landing"), "landing", 1, log=pathlib.Path(sys.argv[1]), progress=kill)
"""
    done = subprocess.run([sys.executable, "-c", code, tmp_path / "run.mcap"], check=False, timeout=120)
    assert done.returncode == 9
    log = read_log(tmp_path / "run.mcap.part")
    flown = len(log.messages["mission"])
    assert not log.complete
    assert flown >= 500
    assert flown % 250 == 0


def test_campaign_writes_its_outcomes_and_no_log(armland, tmp_path):
    flights = ("land", "--seeds", "2", "--seed", "5", "--jobs", "1", "--out", "out", *SHORT)
    done = armland(*flights, "--json", "--no-figures")
    assert done.code == 1
    result = json.loads(done.out)
    assert [o["seed"] for o in result["flights"]] == [5, 6]
    assert (result["summary"]["flights"], result["summary"]["successes"]) == (2, 0)
    assert files(tmp_path / "out") == ["campaign.json", "campaign.sqlite"]
    assert "1 of 2 flown, 0 succeed" in done.err
    done = armland(*flights)
    assert "0 of 2 landings succeed" in done.out
    assert "2 failed (seed 5, 6): still in phase" in done.out
    drawn = ["landing_campaign.pdf", "landing_campaign.png"]
    assert files(tmp_path / "out") == ["campaign.json", "campaign.sqlite", *drawn, "report.html"]


def test_fault_is_injected_from_the_command_line(armland, tmp_path):
    fault = 'faults=[{kind="magnet_coil", phase="self_test", size=0.6}]'
    done = armland("land", "--no-figures", "--out", "out", "--json", *sets(fault, "run.duration_s=4.0"))
    assert (done.code, json.loads(done.out)["end"]) == (1, "refused")
    assert json.loads(armland("land", "--no-figures", "--out", "out", "--json", *sets("run.duration_s=4.0")).out)[
        "end"
    ] != ("refused")


MOVE = "[[trajectory.moves]]\nto_m = [0.1, 0.0, 0.0]\nduration_s = 1.0\n"

HEAVY = ("uav.extra_mass_kg=16.0", "rotors.max_thrust_n=100.0", "magnet.rating_n=2000.0")
BAD = {
    "catch out of reach": (sets("place.catch_m=[1.6, 0.0, 0.86]"), ["out of reach by", "place.catch_m = (1.6", "mm"]),
    "put down out of reach": (sets("place.put_down_m=[1.2, 0.0, 0.7]"), ["out of reach by", "put_down_m = (1.2"]),
    "tracking out of reach": (
        sets("place.catch_m=[0.62, 0.0, 0.9]"),
        ["bounds.uav_error_m = 0.06 m", "out of reach by 7 mm"],
    ),
    "start inside the arm": (
        sets("place.start_above_m=0.0", "place.start_offset_m=[0.1, 0.1, 0.3]"),
        ["place.start_above_m = 0 ", "less than 0.05 m beside", "from 0.27"],
    ),
    "start out of sight": (sets("place.start_above_m=2.5"), ["2.5", "does not see its marker", "would do"]),
    "start box too wide": (sets("place.start_offset_m=[0.9, 0.9, 0.1]"), ["start_offset_m", "would do"]),
    "too heavy for the magnet": (sets("magnet.rating_n=5.0"), ["weighs 4.7 N", "loaded with 3.0 N", "at most 0.31 kg"]),
    "too heavy for the rotors": (
        sets("uav.extra_mass_kg=0.5"),
        ["weighs 10.08 N", "rotors give 7.44 N", "at most 0.654 kg"],
    ),
    "too heavy for both": (
        sets("uav.extra_mass_kg=0.5", "magnet.rating_n=5.0"),
        ["rotors give 7.44 N", "loaded with 3.0 N"],
    ),
    "too heavy for the arm": (sets(*HEAVY), ["joint A2 would need 193 N·m", "0.9 of its limit is 158 N·m"]),
    "two contradictions at once": (
        sets("bounds.lost_offset_m=0.001", "bounds.pull_seen_n=2.0"),
        ["2 problems", "lost_offset_m = 0.001", "pull_seen_n = 2"],
    ),
    "unknown scenario": (("nowhere.toml",), ["nowhere.toml", "does not exist", "landing"]),
    "a key that the mission does not use": (("mine.toml",), ["trajectory"]),
    "broken TOML": (("broken.toml",), ["broken.toml is not valid TOML", "line 2"]),
    "unknown key": (("unknown.toml",), ["place.catch: unknown key", "catch_m"]),
    "unknown key of the UAV": (sets("uav.mas_kg=1.0"), ["uav.mas_kg: unknown key", "mass_kg"]),
    "wrong type": (sets('place.catch_m="here"'), ["place.catch_m", "list", "'here'"]),
    "unknown fault": (sets('faults=[{kind="flood"}]'), ["faults.0.kind", "'link_loss'", "'flood'"]),
    "fault in another mission's phase": (
        sets('faults=[{kind="link_loss", phase="carry_up"}]'),
        ["no phase 'carry_up'", "carry, set_down"],
    ),
    "setting without a value": (sets("place.catch_m"), ["'place.catch_m'", "KEY=VALUE"]),
    "setting that is not TOML": (sets("title=calm"), ["'calm' is not a value of TOML", "quotes"]),
    "no time": (sets("run.duration_s=0.001"), ["duration_s", "outside 1 to 600"]),
    "too much of everything": (sets("run.duration_s=1e300", "uav.extra_mass_kg=1e9"), ["2 problems"]),
    "law file that is not there": (("--law", "nowhere.py:law"), ["nowhere.py", "there is no file"]),
    "law that is not there": (("--law", "law.py:other"), ["no function 'other'", "good"]),
    "law with other arguments": (("--law", "law.py:short"), ["its arguments are (q, omega)", "they must be"]),
    "law file that cannot be run": (("--law", "torn.py:law"), ["torn.py cannot be run", "SyntaxError"]),
    "law that is none": (("--law", "best"), ["best"]),
    "arm that is not there": (("--arm", "no.urdf"), ["no.urdf"]),
    "no seeds": (("--seeds", "0"), ["--seeds", "greater than or equal to 1"]),
    "negative seed": (("--seed", "-1"), ["--seed", "greater than or equal to 0"]),
    "out is a file": (("--out", "unknown.toml"), ["--out 'unknown.toml'", "folder"]),
    "out is below a file": (("--out", "unknown.toml/sub"), ["--out 'unknown.toml/sub'", "folder"]),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_input_is_one_message_exit_code_2_and_nothing_written(name, armland, tmp_path):
    args, words = BAD[name]
    (tmp_path / "broken.toml").write_text("seed = 1\n[[[\n")
    (tmp_path / "unknown.toml").write_text('base = "landing"\n[place]\ncatch = [0.62, 0.0, 0.86]\n')
    (tmp_path / "mine.toml").write_text('base = "landing"\n[trajectory]\nstart_m = [0.5, 0.0, 0.7]\n' + MOVE)
    (tmp_path / "law.py").write_text(
        f"def good({', '.join(ARGUMENTS)}):\n    return r, v\ndef short(q, omega):\n    pass\n"
    )
    (tmp_path / "torn.py").write_text("def law(")
    if "--out" in args:
        (tmp_path / "unknown.toml").write_text("")
    before = files(tmp_path)
    done = armland("land", *args)
    assert done.code == 2, done
    # Typer puts its messages into boxes as wide as the terminal.
    text = " ".join(done.err.replace("│", " ").split())
    assert [word for word in words if word not in text] == [], text
    assert done.out == ""
    assert "Traceback" not in done.err
    assert sum(line.startswith(("armland: ", "Usage: ")) for line in map(str.strip, done.err.splitlines())) == 1
    assert files(tmp_path) == before


def test_takeoff_refuses_a_phase_of_the_landing(armland, tmp_path):
    done = armland("takeoff", *sets('faults=[{kind="link_loss", phase="set_down"}]'))
    assert (done.code, files(tmp_path)) == (2, [])
    assert "hand_back" in done.err


@pytest.mark.parametrize(("command", "mission"), [("land", "landing"), ("takeoff", "take-off")])
def test_help_has_examples_and_says_how_faults_are_injected(armland, command, mission):
    text = " ".join(armland(command, "--help").out.replace("│", " ").split())
    for word in ("Examples", f"armland {command} --seeds 200", mission, "[[faults]]", "--log", "--set", "Exit code: 0"):
        assert word in text


@pytest.mark.parametrize("mission", MISSIONS)
def test_every_mission_runs_by_its_name(armland, tmp_path, mission):
    row = (
        ("compare", "--experiment", "exact")
        if MISSIONS[mission].start == "hinged" and not MISSIONS[mission].experiment
        else ()
    )
    done = armland("run", mission, *row, "--no-figures", "--json", "--out", "out")
    assert done.code == (0 if json.loads(done.out)["success"] else 1), done.err
    assert json.loads(done.out)["mission"] == mission
    assert files(tmp_path / "out") == sorted([f"{mission}.mcap", "result.json"])


def test_unknown_mission_names_those_there_are(armland, tmp_path):
    done = armland("run", "loop")
    assert (done.code, files(tmp_path)) == (2, [])
    assert all(mission in done.err for mission in MISSIONS)


BAD_LAWS = """
import math
def raising(q, omega, r, v, reference, thrust, tau_att, uav, gains):
    if reference.r_d[0] > 0.6:
        raise ValueError("too far")
    return 0.0 * r, 0.0 * r
def infinite(q, omega, r, v, reference, thrust, tau_att, uav, gains):
    return 0.0 * r, r / 0.0 if reference.r_d[0] > 0.6 else 0.0 * r
"""


@pytest.mark.parametrize(
    ("law", "words"),
    [("raising", ["raised", "ValueError", "too far"]), pytest.param("infinite", ["tick"], marks=pytest.mark.slow)],
)
def test_law_that_fails_in_flight_ends_in_a_safe_state_and_is_named(armland, tmp_path, law, words):
    (tmp_path / "bad.py").write_text(BAD_LAWS)
    done = armland("run", "E3", "--law", f"bad.py:{law}", "--no-figures", "--json", "--out", "out")
    assert done.code == 1, done.err
    result = json.loads(done.out)
    assert result["fault"] == "law_failed"
    for word in ("bad.py", law, "tick", *words):
        assert word in result["law_failure"]
    assert result["state"] == "held"


@pytest.mark.parametrize("file", ["seven_axis.urdf", pytest.param("six_axis.urdf", marks=pytest.mark.slow)])
def test_another_arm_lands_without_being_told_its_pose(armland, tmp_path, file):
    """Another number of joints is compiled anew."""
    arm = str(ROOT / "examples" / file)
    done = armland("land", "--arm", arm, "--ee", "tool0", "--no-figures", "--no-log", "--out", "out", "--json")
    assert (done.code, json.loads(done.out)["state"]) == (0, "standing"), done.err


def test_film_is_made_at_the_end_where_it_is_asked_for(armland, tmp_path, monkeypatch):
    from armland.view.film import film as films

    def film(take, path, cut, progress):
        assert take.run.name == "landing"
        progress(1, 1)
        path.write_text(f"{cut.fps}")

    monkeypatch.setattr(films, "film", film)
    done = armland("land", "--seed", "3", "--no-figures", "--no-log", "--film", "--out", "out", *SHORT)
    assert done.err.count("armland:") == 0
    assert files(tmp_path / "out") == ["film.mp4", "result.json"]
    assert armland("land", "--seed", "3", "--no-figures", "--out", "out", *SHORT).code == 1
    assert files(tmp_path / "out") == ["landing.mcap", "result.json"]


def test_film_that_cannot_be_drawn_changes_no_verdict(armland, tmp_path, monkeypatch):
    monkeypatch.setenv("MUJOCO_GL", "disable")
    done = armland("land", "--seed", "3", "--no-figures", "--film", "--out", "out")
    assert done.code == 0
    assert "armland: no film: no OpenGL for off-screen pictures" in done.err
    assert files(tmp_path / "out") == ["landing.mcap", "result.json"]


@pytest.mark.parametrize(("wind", "told"), [(8.0, "place.put_down_m = [0.7, 0.0, 0.6]"), (0.0, "")])
def test_rough_weather_says_where_it_puts_catch_and_cradle(wind, told):
    wanted = load_scenario("landing", {"air": {"wind_mps": wind}})
    found = run._roomier(wanted, sized(wanted))
    assert told in found
    assert bool(found) is bool(told)
