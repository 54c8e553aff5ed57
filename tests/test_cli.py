"""The command line: exit codes, one readable message, nothing half-written; in a process of its own where that matters."""

import json
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from armland.scenario import SCENARIOS

PAPER = (SCENARIOS / "paper.toml").read_text(encoding="utf-8")
CALIBRATION = (SCENARIOS / "calibration.toml").read_text(encoding="utf-8")


Call = Callable[..., Any]
"""The command in this process: see the fixture `armland`."""


def process(*args: str, cwd: Path | None = None, **environment: str) -> subprocess.CompletedProcess[str]:
    call = [sys.executable, "-m", "armland", *args]
    return subprocess.run(call, capture_output=True, text=True, cwd=cwd, timeout=300, env=os.environ | environment)


def shell(command: str, cwd: Path, **environment: str) -> subprocess.CompletedProcess[str]:
    """Run a line of a shell in which `armland` is the command."""
    line = f'armland() {{ "{sys.executable}" -m armland "$@"; }}; set -o pipefail; {command}'
    return subprocess.run(
        ["bash", "-c", line], capture_output=True, text=True, cwd=cwd, timeout=300, env=os.environ | environment
    )


def test_paper_json_is_alone_on_standard_output(tmp_path: Path) -> None:
    done = process("paper", "--json", "--no-figures", "--out", str(tmp_path / "out"))
    assert done.returncode == 0, done.stderr
    result = json.loads(done.stdout)
    assert set(result) == {"experiments", "published", "verdicts", "run"}
    assert set(result["experiments"]["E1"]) == {
        "attitude_max_deg",
        "attitude_rms_deg",
        "position_max_m",
        "position_rms_m",
        "overshoot_m",
        "delta_tau_max_nm",
        "hinge_force_max_n",
    }
    assert set(result["verdicts"][0]) == {"claim", "value", "bound", "holds"}
    assert set(result["run"]) == {"ticks", "simulated_s", "wall_s", "real_time_factor"}
    assert json.loads((tmp_path / "out" / "result.json").read_text()) == result
    assert sorted(p.name for p in (tmp_path / "out").glob("*.mcap")) == ["E1.mcap", "E2.mcap", "E3.mcap"]


def test_a_failed_verdict_is_exit_code_1(armland: Call, tmp_path: Path) -> None:
    (tmp_path / "weak.toml").write_text(PAPER.replace('extra_torque = "full"', 'extra_torque = "none"'))
    (tmp_path / "calibration.toml").write_text(CALIBRATION)
    done = armland("paper", "--scenario", "weak.toml", "--no-figures", "--json")
    assert done.code == 1, done.err
    assert not all(v["holds"] for v in json.loads(done.out)["verdicts"])


URDF = """<robot name="r"><link name="base"/>
<link name="l1"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="j1" type="revolute"><parent link="base"/><child link="l1"/><axis xyz="0 0 1"/>
<limit lower="-1" upper="1" effort="9" velocity="1"/></joint></robot>"""

BAD = {
    "unknown key": ("\n[sensors]\nnoise = 1.0\n", {}, [], ["sensors.noise", "unknown key", "force_n"]),
    "wrong unit type": ('\n[run]\nsettle_s = "1 s"\n', {}, [], ["run.settle_s", "valid number"]),
    "NaN gain": ("\n[control]\nk3 = nan\n", {}, [], ["control.k3"]),
    "negative gain": (
        "\n[control]\nk1 = [1.0, 1.0, 1.0, 30.0, -30.0, 30.0]\n",
        {},
        [],
        ["control.k1.4", "lies outside"],
    ),
    "inertia not positive definite": (
        "",
        {"[uav]\n": "[uav]\ninertia_kgm2 = [[0.006, 0.0, 0.0], [0.0, -0.007, 0.0], [0.0, 0.0, 0.012]]\n"},
        [],
        ["uav.inertia_kgm2", "positive definite"],
    ),
    "rate that does not divide": (
        "\n[link]\nrate_hz = 300\n",
        {},
        [],
        ["link.rate_hz = 300", "does not divide", "250"],
    ),
    "trajectory out of reach": (
        "",
        {"to_m = [0.10, 0.0, 0.0]": "to_m = [0.60, 0.0, 0.0]"},
        [],
        ["out of reach by", "t = "],
    ),
    "start out of reach": (
        "",
        {"start_m = [0.58, 0.0, 0.74]": "start_m = [2.0, 0.0, 0.74]"},
        [],
        ["misses it by", "mm"],
    ),
    "calibrated value outside its range": (
        "",
        {},
        ["value = 2.35", "value = 9.0"],
        ["control.thrust_n", "outside", "4.7"],
    ),
    "not TOML": ("\n[[[\n", {}, [], ["not valid TOML"]),
    "arm file missing": ("", {'file = "lwr4.xml"': 'file = "nowhere.urdf"'}, [], ["nowhere.urdf", "does not exist"]),
    "arm without the frame": ("", {'ee = "flange"': 'ee = "gripper"'}, [], ["no frame 'gripper'", "flange"]),
    "unknown elbow": ("", {'elbow_joint = "A3"': 'elbow_joint = "B3"'}, [], ["no joint 'B3'", "A3"]),
    "delay too long": ("", {}, ["value = 25.0", "value = 2500.0"], ["link.uplink_delay_ms", "outside"]),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_scenario_is_one_message_exit_code_2_and_nothing_written(armland: Call, name: str, tmp_path: Path) -> None:
    tail, changes, calibration, words = BAD[name]
    text = PAPER
    for old, new in changes.items():
        assert old in text
        text = text.replace(old, new)
    (tmp_path / "bad.toml").write_text(text + tail)
    (tmp_path / "calibration.toml").write_text(CALIBRATION.replace(*calibration) if calibration else CALIBRATION)
    done = armland("paper", "--scenario", "bad.toml", "--out", "out")
    assert done.code == 2, (done.out, done.err)
    for word in words:
        assert word in done.err
    assert "Traceback" not in done.err
    assert sum(line.startswith("armland: ") for line in done.err.splitlines()) == 1
    assert not (tmp_path / "out").exists()
    assert not (tmp_path / "MUJOCO_LOG.TXT").exists()


@pytest.mark.parametrize(
    ("args", "words"),
    [
        (("--scenario", "nowhere.toml"), ["nowhere.toml", "does not exist", "paper"]),
        (("--arm", "short.urdf", "--ee", "l1"), ["1 joints", "at least 6"]),
        (("--arm", "short.urdf", "--ee", "tool0"), ["no frame 'tool0'", "l1"]),
        (("--arm", "torn.urdf", "--ee", "l1"), ["not well-formed XML"]),
        (("--seed", "-1"), ["--seed"]),
        (("--law", "exact"), ["--compare", "armland run E3 --law exact"]),
        (("--compare", "--law", "nowhere.py:law"), ["nowhere.py"]),
        (("--factorial",), ["--factorial needs --compare"]),
        (("--compare", "--factorial", "--law", "exact"), ["leave --law out"]),
        (("--spread", "4", "--scenario", "compare"), ["--spread", "paper_bench", "leave"]),
        (("--spread", "1"), ["--spread"]),
    ],
)
def test_bad_option_is_one_message_and_exit_code_2(
    armland: Call, args: tuple[str, ...], words: list[str], tmp_path: Path
) -> None:
    (tmp_path / "short.urdf").write_text(URDF)
    (tmp_path / "torn.urdf").write_text(URDF[:-20])
    done = armland("paper", *args)
    assert done.code == 2, (done.out, done.err)
    for word in words:
        assert word in done.err
    assert "Traceback" not in done.err
    assert not (tmp_path / "out").exists()


def test_out_that_cannot_be_a_folder(armland: Call, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    done = armland("paper", "--out", str(tmp_path / "file" / "sub"))
    assert done.code == 2
    assert "--out" in done.err
    assert "Traceback" not in done.err


ASCII = {"PYTHONIOENCODING": "ascii", "LANG": "C"}


def test_ascii_terminal_gets_words(tmp_path: Path) -> None:
    done = process("gains", cwd=tmp_path, **ASCII)
    assert done.returncode == 0, done.stderr
    assert "Margins" in done.stdout
    assert done.stdout.isascii()
    assert "phase [ deg]" in done.stdout
    help_text = process("land", "--help", cwd=tmp_path, **ASCII)
    assert (help_text.returncode, help_text.stderr) == (0, "")
    assert json.loads(process("schema", cwd=tmp_path, **ASCII).stdout)


def test_closed_pipe_is_no_error(tmp_path: Path) -> None:
    done = shell("armland schema | head -1", tmp_path)
    assert (done.returncode, done.stdout, done.stderr) == (0, "{\n", "")
    done = shell("armland --help >&-", tmp_path)
    assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full")
def test_full_disk_is_said(tmp_path: Path) -> None:
    done = shell("armland schema > /dev/full", tmp_path)
    assert done.returncode == 3
    assert done.stderr == "armland: standard output cannot be written: No space left on device\n"


def test_nothing_is_left_in_the_working_directory(tmp_path: Path) -> None:
    for args in (("--version",), ("gains",), ("land", "nowhere.toml")):
        process(*args, cwd=tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_importing_armland_imports_nothing_heavy() -> None:
    code = (
        "import armland, sys; print([m for m in ('numba', 'mujoco', 'numpy', 'pydantic', 'typer') if m in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "[]\n"


def test_schema_is_json_and_help_has_examples(armland: Call) -> None:
    done = armland("schema")
    assert done.code == 0
    assert "trajectory" in json.loads(done.out)["properties"]
    help_text = armland("paper", "--help").out
    assert "Examples" in help_text
    assert "--arm" in help_text


@pytest.mark.parametrize("arm", ["seven_axis.urdf", pytest.param("six_axis.urdf", marks=pytest.mark.slow)])
def test_another_arm_takes_the_lwr_s_place(armland: Call, arm: str, tmp_path: Path) -> None:
    file = Path(__file__).parents[1] / "examples" / arm
    done = armland("paper", "--arm", str(file), "--ee", "tool0", "--json", "--no-figures", "--out", str(tmp_path))
    assert done.code in (0, 1), done.err
    experiments = json.loads(done.out)["experiments"]
    assert max(experiments["E3"]["position_max_m"]) < 0.05


def test_gains_by_rule_are_printed_with_their_margins(armland: Call) -> None:
    done = armland("gains", "--json")
    assert done.code == 0, done.err
    data = json.loads(done.out)
    assert set(data) == {"gains", "onboard", "margins"}
    assert set(data["margins"]) == {"position", "roll", "pitch", "yaw"}
    assert 0.0 < data["margins"]["roll"]["delay"] < 0.1
    assert "Margins" in armland("gains").out


@pytest.mark.parametrize(
    ("args", "words"),
    [
        (
            ("--attitude", "39", "--over-link", "--delay-ms", "30"),
            ["39 rad/s is not feasible", "keep the feedback on board"],
        ),
        (("--attitude", "60"), ["not feasible", "feasible at this delay are"]),
        (("--attitude", "-3"), ["attitude bandwidth is -3.0", "above 0"]),
        (("--position-damping", "nan"), ["position damping is nan"]),
        (("--scenario", "nowhere"), ["does not exist"]),
    ],
)
def test_infeasible_gains_are_refused_with_what_would_work(
    armland: Call, args: tuple[str, ...], words: list[str]
) -> None:
    done = armland("gains", *args)
    assert done.code == 2, (done.out, done.err)
    for word in words:
        assert word in done.err
    assert "Traceback" not in done.err


def test_verify_runs_the_proof(armland: Call, tmp_path: Path) -> None:
    done = armland("verify", "--samples", "10", "--json", "--no-figures", "--out", str(tmp_path / "out"))
    assert done.code == 0, done.err
    result = json.loads(done.out)
    assert {"subsystem", "demonstrator", "verdicts"} <= set(result)
    assert all(v["holds"] for v in result["verdicts"])
    assert (tmp_path / "out" / "proof_E3.csv").is_file()


@pytest.mark.parametrize("args", [("--samples", "0"), ("--scenario", "nowhere"), ("--seed", "-4")])
def test_verify_refuses_bad_input(armland: Call, args: tuple[str, ...], tmp_path: Path) -> None:
    done = armland("verify", *args)
    assert done.code == 2
    assert "Traceback" not in done.err
    assert not (tmp_path / "out").exists()


def test_takeoff_weight_by_theory_alone(armland: Call, tmp_path: Path) -> None:
    done = armland("takeoff-weight", "--no-flights", "--json", "--no-figures", "--out", str(tmp_path / "out"))
    assert done.code == 0, done.err
    result = json.loads(done.out)
    assert {"arm_speed_mps", "sustained", "thrown", "speed_for_gain", "flights", "verdict"} <= set(result)
    assert json.loads((tmp_path / "out" / "takeoff_weight.json").read_text()) == result


def test_takeoff_weight_refuses_bad_input(armland: Call, tmp_path: Path) -> None:
    (tmp_path / "far.toml").write_text('base = "landing"\n[place]\nlaunch_m = [1.5, 0.0, 0.9]\n')
    done = armland("takeoff-weight", "far.toml", "--no-flights")
    assert done.code == 2, done.err
    assert "out of reach" in done.err
    assert "Traceback" not in done.err


def test_sums_of_a_flight_have_one_order_however_many_cores_there_are() -> None:
    code = (
        "import os, sys; from armland.cli import main\n"
        "assert 'numpy' not in sys.modules\n"
        "sys.argv = ['armland', '--version']\n"
        "try:\n    main()\nexcept SystemExit:\n    print(os.environ['OPENBLAS_NUM_THREADS'])"
    )
    many = os.environ | {"OPENBLAS_NUM_THREADS": "8"}
    done = subprocess.run([sys.executable, "-c", code], env=many, capture_output=True, text=True)
    assert done.stdout.split()[-1] == "1", done.stderr
