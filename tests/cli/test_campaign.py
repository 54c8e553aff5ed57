"""The commands of a campaign: what is written, what is refused in one message, and that a refusal writes nothing."""

import json
import os
import signal
import subprocess
import sys
import time

import pytest

from armland.cli.commands import campaign as module
from armland.experiments.campaign.crews.threads import threads
from armland.experiments.campaign.store import Store

STUDY = """
mission = "landing"
overrides.run.duration_s = 1.2

[parameters]
air.wind_mps = {sweep = [3.0, 4.0]}
"""

RARE = """
mission = "landing"
overrides.run.duration_s = 1.0

[parameters]
uav.extra_mass_kg = {normal = [0.03, 0.01], low = 0.0, high = 0.06}

[failure]
figure = "joint_torque_max_ratio"
above = 0.26
stage = 20
"""


@pytest.fixture
def study(tmp_path, monkeypatch):
    """A file of short flights that threads of this process make."""
    monkeypatch.setattr(module, "crew_of", lambda jobs, address: threads(jobs or 2))
    (tmp_path / "study.toml").write_text(STUDY)
    return tmp_path


def files(folder):
    return sorted(p.relative_to(folder).as_posix() for p in folder.rglob("*") if p.is_file())


def test_from_a_file_to_a_report_and_a_row_flown_again(armland, study):
    done = armland("campaign", "study.toml", "--runs", "2", "--json", "--no-pictures")
    assert done.code == 0, done.err
    result = json.loads(done.out)
    assert [(p["name"], p["flights"]) for p in result["points"]] == [("air.wind_mps = 3", 2), ("air.wind_mps = 4", 2)]
    assert "4 of 4 flown" in done.err
    assert files(study / "out") == [
        "campaign/study.sqlite",
        *(f"campaign/study/{name}" for name in ("report.html", "report.json", "rows.csv", "rows.parquet")),
    ]
    assert json.loads((study / "out/campaign/study/report.json").read_text()) == result

    done = armland("campaign", "report", "out/campaign/study.sqlite", "--out", "again", "--no-figures")
    assert done.code == 0, done.err
    assert "Campaign of landings: 4 of 4 flights" in done.out
    assert files(study / "again") == ["report.json", "rows.csv", "rows.parquet"]

    done = armland("campaign", "replay", "out/campaign/study.sqlite", "3", "--no-figures", "--json")
    assert done.code == 0, done.err
    assert json.loads(done.out)["same"] is True
    assert files(study / "out/replay") == ["landing.mcap", "result.json"]

    done = armland("campaign", "study.toml", "--runs", "2")
    assert done.code == 2
    assert "out/campaign/study.sqlite is there already; --resume goes on with it" in done.err
    with Store(study / "out/campaign/study.sqlite", write=True) as store:
        store._base.execute("UPDATE runs SET digest = 'x' WHERE run = 3")
        store._base.execute("DELETE FROM runs WHERE run = 1")
    done = armland("campaign", "study.toml", "--resume", "--no-figures")
    assert (done.code, "4 of 4 flown" in done.err) == (0, True)
    done = armland("campaign", "replay", "out/campaign/study.sqlite", "3", "--no-figures")
    assert (done.code, "Row 3: NOT the same (x, " in done.out) == (1, True)


def test_rate_of_a_rare_failure_and_one_of_its_rows_flown_again(armland, study):
    (study / "study.toml").write_text(RARE)
    done = armland("campaign", "study.toml", "--rare", "--runs", "45", "--json", "--no-figures")
    assert done.code == 0, done.err
    rare = json.loads(done.out)["rare"]
    assert (rare["failure"], rare["flights"]) == ("torque ratio max above 0.26", 45)
    assert [s["flights"] for s in rare["stages"]] in ([20, 20, 5], [20, 20], [20])
    done = armland("campaign", "replay", "out/campaign/study.sqlite", "31", "--no-figures", "--json")
    assert (done.code, json.loads(done.out)["same"]) == (0, True)
    done = armland("campaign", "study.toml", "--resume", "--no-figures")
    assert (done.code, "was flown with --rare, not without" in " ".join(done.err.split())) == (2, True)
    done = armland("campaign", "study.toml", "--rare", "--resume", "--no-figures", "--runs", "50")
    assert (done.code, "50 of 50 flown" in done.err) == (0, True), done.err


def test_file_is_the_default_command(armland, study):
    assert "Fly a mission many times" in armland("campaign", "fly", "--help").out
    assert "fly" in armland("campaign", "--help").out
    done = armland("campaign", "fly", "none.toml")
    assert (done.code, "none.toml cannot be read" in done.err) == (2, True)


BAD = {
    "no runs": (STUDY, ("--runs", "0"), "'--runs'"),
    "no width": (STUDY, ("--until", "much"), "--until 'much': expected half the width"),
    "empty range": (
        STUDY.replace("sweep = [3.0, 4.0]", "uniform = [4.0, 3.0]"),
        (),
        "uniform = [4.0, 3.0] is an empty range",
    ),
    "no distribution": (
        STUDY.replace("sweep", "gamma"),
        (),
        "air.wind_mps.gamma: unknown key; known here: choice, fixed",
    ),
    "no value": (STUDY.replace("air.wind_mps", "air.winds"), (), "air.winds"),
    "too windy": (STUDY.replace("4.0]", "45.0]"), (), "air.wind_mps"),
    "no mission": (STUDY.replace("landing", "hovering"), (), "hovering"),
    "no scenario": (STUDY + '[[points]]\nscenario = "x"\n', (), "scenario"),
    "rare in points": (STUDY, ("--rare",), "--rare finds one rate, and the file has 2 points"),
    "rare until": (RARE, ("--rare", "--until", "1%"), "--until is for plain flights"),
    "rare few": (RARE, ("--rare", "--runs", "30"), "--runs 30: with --rare 40 to"),
    "no figure": (RARE.replace("joint_torque", "bone_torque"), ("--rare",), "figure = 'bone_torque_max_ratio' is none"),
    "no threshold": (RARE.replace("above = 0.26", ""), ("--rare",), "figure and above belong together"),
    "no cluster": (STUDY, ("--ray", "203.0.113.1:1"), "--ray"),
}


@pytest.mark.parametrize(("text", "options", "words"), BAD.values(), ids=BAD)
def test_bad_input_is_one_message_and_nothing_is_written(armland, tmp_path, text, options, words):
    if "--ray" in options:
        pytest.importorskip("ray")
    (tmp_path / "study.toml").write_text(text)
    done = armland("campaign", "study.toml", *options)
    assert done.code == 2
    assert words in " ".join(done.err.split())
    assert "Traceback" not in done.err
    assert files(tmp_path) == ["study.toml"]


def test_ray_that_is_not_installed_is_named(armland, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "ray", None)
    (tmp_path / "study.toml").write_text(STUDY)
    done = armland("campaign", "study.toml", "--ray", "auto")
    assert (done.code, "install armland[cluster]" in done.err) == (2, True)
    assert files(tmp_path) == ["study.toml"]


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (("report", "none.sqlite"), "none.sqlite does not exist"),
        (("replay", "none.sqlite", "3"), "none.sqlite does not exist"),
        (("report", "study.toml"), "study.toml is no store of a campaign"),
        (("replay", "study.toml", "3"), "study.toml is no store of a campaign"),
        (("study.toml", "--out", "study.toml", "--resume"), "study.toml is no store of a campaign"),
    ],
)
def test_what_is_no_store_is_refused_and_left_alone(armland, study, call, words):
    done = armland("campaign", *call)
    assert (done.code, words in " ".join(done.err.split())) == (2, True), done.err
    assert files(study) == ["study.toml"]
    assert (study / "study.toml").read_text() == STUDY


def test_a_store_that_another_process_writes_is_refused(armland, study):
    with Store(study / "a.sqlite", write=True):
        done = armland("campaign", "study.toml", "--out", "a.sqlite", "--resume")
    assert done.code == 2
    assert f"is being written by another process (process {os.getpid()} on" in " ".join(done.err.split())


def test_seeds_of_a_stopped_command_are_kept(tmp_path):
    call = [sys.executable, "-m", "armland", "land", "--seeds", "500", "--jobs", "1", "--set", "run.duration_s=1.0"]
    with subprocess.Popen(call, cwd=tmp_path, stderr=subprocess.PIPE, text=True) as process:
        part, end = tmp_path / "out" / "land" / f"part-{process.pid}" / "campaign.sqlite", time.monotonic() + 120.0
        while not (part.is_file() and rows(part) > 2):
            assert time.monotonic() < end
            time.sleep(0.05)
        process.send_signal(signal.SIGINT)
        assert "unfinished" in process.stderr.read()
    assert process.returncode == 130
    assert 3 <= rows(tmp_path / "out" / "land" / "unfinished" / "campaign.sqlite") < 500


def rows(file):
    from armland.errors import ConfigurationError, StoreError

    try:
        with Store(file) as store:
            return len(list(store.outcomes()))
    except (ConfigurationError, StoreError):
        return 0
