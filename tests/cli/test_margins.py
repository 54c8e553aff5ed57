"""The command `margins`, and `--deviation` of the commands that fly: exit codes, refusals, what is written."""

import json

import pytest

from armland.experiments.margins import study as module
from armland.experiments.margins.corners import chosen, largest
from armland.experiments.margins.screening import Listed, Screening
from armland.experiments.margins.search import Bracket, Failure
from armland.experiments.margins.study import Margin, Margins
from armland.scenario.deviation import LEVELS


def made_up(lands, asked):
    def study(scenario, rows, terms, pairs, progress):
        asked.update(terms._asdict(), rows=[r.path for r in rows], pairs=pairs, first=scenario.run.seed)
        failure = Failure(2, "too fast", "lost")
        margins = [Margin(r, Bracket(lands, 1.05 * lands, failure, 6), largest(r)) for r in rows]
        screening = Screening(24, 20, 1.0, (), (Listed(("uav.mass", "link.loss"), ("high", "there"), 0.2, 0.1, False),))
        return Margins(terms, (1, 2), tuple(margins), screening if pairs else None)

    return study


def test_all_inside_is_exit_code_0_and_json_alone(armland, monkeypatch, tmp_path):
    asked = {}
    monkeypatch.setattr(module, "study", made_up(1.5, asked))
    options = ("--rows", "uav.mass,link.*", "--first-seed", "7", "--seeds", "2", "--around", "mild", "--share", "0.5")
    done = armland("margins", *options, "--jobs", "1", "--no-figures", "--json", "--out", "out")
    assert done.code == 0, done.err
    assert json.loads(done.out) == json.loads((tmp_path / "out" / "margins.json").read_text())
    assert json.loads(done.out)["screening"]["pairs"][0]["rows"] == ["uav.mass", "link.loss"]
    assert asked["rows"] == [r.path for r in chosen("uav.mass,link.*")]
    assert {k: asked[k] for k in ("first", "seeds", "around", "share", "jobs", "pairs", "level", "mission")} == {
        "first": 7,
        "seeds": 2,
        "around": "mild",
        "share": 0.5,
        "jobs": 1,
        "pairs": True,
        "level": "published",
        "mission": "landing",
    }


def test_a_narrow_margin_is_exit_code_1_and_named(armland, monkeypatch, tmp_path):
    monkeypatch.setattr(module, "study", made_up(0.4, {}))
    done = armland("margins", "--rows", "uav.mass", "--no-pairs", "--out", "out")
    assert done.code == 1
    text = " ".join(done.out.split())
    assert "uav.mass alone, inside its published range" in text
    assert "too fast (seed 2, high end; UAV lost)" in text
    assert sorted(p.name for p in (tmp_path / "out").iterdir()) == [
        "margins.json",
        "margins.pdf",
        "margins.png",
        "report.html",
    ]


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--rows", "uav.mas"), "near: uav.mass"),
        (("--rows", "uav.mass", "--level", "nominal"), "no pair can be found"),
        (("--around", "calm"), "'nominal', 'mild', 'published', 'harsh'"),
        (("--mission", "E3"), "'landing', 'takeoff'"),
        (("--seeds", "0"), "--seeds"),
        (("--set", "deviation.uav.mass=0.9"), "-0.5 to 0.5"),
    ],
)
def test_bad_input_is_refused_before_anything_is_written(armland, tmp_path, options, words):
    done = armland("margins", *options, "--out", "out")
    assert done.code == 2
    assert words in " ".join(done.err.replace("│", " ").split())
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("command", [("land",), ("takeoff",), ("run", "landing")])
def test_unknown_level_is_refused_with_those_there_are(armland, tmp_path, command):
    done = armland(*command, "--deviation", "calm", "--out", "out")
    assert (done.code, list(tmp_path.iterdir())) == (2, [])
    assert all(f"'{name}'" in done.err for name in LEVELS)


def test_level_reaches_the_flight_and_a_setting_goes_before_it(armland, tmp_path):
    short = ("--set", "run.duration_s=1.0", "--no-figures", "--json")
    armland("land", "--deviation", "harsh", "--out", "a", *short)
    armland("land", "--deviation", "harsh", "--set", 'deviation.level="mild"', "--out", "b", *short)
    from armland.runtime.log import read_log

    levels = [
        json.loads(read_log(tmp_path / n / "landing.mcap").metadata["overrides"])["deviation"]["level"] for n in "ab"
    ]
    assert levels == ["harsh", "mild"]
    truth = [read_log(tmp_path / n / "landing.mcap").messages["truth"]["r"][-1, 2] for n in "ab"]
    assert truth[0] != truth[1]


def flown_level(armland, tmp_path, *args):
    from armland.runtime.log import read_log

    armland("land", *args, "--out", "out", "--set", "run.duration_s=1.0", "--no-figures", "--json")
    log = read_log(tmp_path / "out" / "landing.mcap")
    return json.loads(log.metadata["overrides"]).get("deviation", {}).get("level"), log.messages["truth"].tobytes()


def test_landing_flies_what_the_published_ranges_give_unless_told_otherwise(armland, tmp_path):
    """Without options as with the level `published`; the level of option, setting or scenario goes before."""
    (tmp_path / "calm.toml").write_text('title = "calm"\nbase = "landing"\n[deviation]\nlevel = "nominal"\n')
    (tmp_path / "harsh.toml").write_text('title = "rough"\nbase = "landing"\n[deviation]\nlevel = "harsh"\n')
    asked = {name: flown_level(armland, tmp_path, "--deviation", name)[1] for name in ("nominal", "published", "harsh")}
    assert len(set(asked.values())) == 3
    # The log says which level was flown, so it can be flown again.
    assert flown_level(armland, tmp_path) == ("published", asked["published"])
    assert flown_level(armland, tmp_path, "--set", 'deviation.level="nominal"')[1] == asked["nominal"]
    assert flown_level(armland, tmp_path, "calm.toml")[1] == asked["nominal"]
    assert flown_level(armland, tmp_path, "harsh.toml")[1] == asked["harsh"]
    # Ranges of the user's own do not change the level.
    assert flown_level(armland, tmp_path, "--set", "deviation.uav.mass=0.0")[1] != asked["nominal"]


def test_mission_without_deviations_refuses_a_level(armland):
    done = armland("run", "E3", "--deviation", "mild", "--out", "out")
    assert done.code == 2
    assert "deviation.level: not used by the mission 'E3'" in done.err


@pytest.mark.parametrize("command", ["land", "takeoff", "run"])
def test_help_names_the_levels(armland, command):
    text = " ".join(armland(command, "--help").out.replace("│", " ").split())
    assert "--deviation" in text
    assert all(name in text for name in LEVELS)


def test_help_of_margins_has_examples(armland):
    text = " ".join(armland("margins", "--help").out.replace("│", " ").split())
    for word in ("armland margins --rows", "--around mild", "--mission takeoff", "Exit code: 0"):
        assert word in text
