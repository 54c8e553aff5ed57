"""The command `study`: from changes to a table and a figure, and what is refused with nothing written."""

import json

import pytest


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["motors"], "'motors' is not one of"),
        (["terms", "--only", "luck"], "'luck' is none; terms has: deck feed-forward, kept pose"),
        (["terms", "--sea", "9"], "sea states are 0"),
        (["terms", "--runs", "0"], "Invalid value for '--runs'"),
        (["terms", "--wind", "30"], "wind"),
        (["sensors", "--set", "camera.rate=9"], "camera.rate"),
        (["sensors", "--no-fly"], "does not exist"),
    ],
)
def test_bad_input_is_one_message_and_nothing_is_written(armland, tmp_path, options, words):
    done = armland("study", *options)
    assert done.code == 2
    assert words in done.err
    assert [p for p in tmp_path.rglob("*") if p.is_file()] == []


@pytest.mark.slow
def test_a_term_is_flown_with_and_without_and_flown_on(armland, tmp_path):
    asked = ("study", "terms", "--only", "load observer", "--wind", "0", "--sea", "0", "--workers", "1", "--json")
    first = armland(*asked, "--runs", "2", "--seed", "7")
    assert first.code == 0, first.err
    data = json.loads(first.out)
    assert (data["usual"]["flights"], [g["name"] for g in data["gains"]]) == (2, ["load observer"])
    assert "calm air, on land, deviations published, 2 seeds" in data["conditions"]
    folder = tmp_path / "out" / "study"
    made = {p.name for p in (folder / "terms").iterdir()}
    assert {"study.json", "report.html", "rows.csv", "study_terms.pdf", "study_terms.png"} <= made
    assert "load observer" in (folder / "terms" / "rows.csv").read_text()
    again = armland(*asked, "--runs", "2", "--seed", "7")
    assert (again.code, "--resume goes on with it" in again.err) == (2, True)
    further = armland(*asked, "--runs", "3", "--seed", "7", "--resume")
    assert json.loads(further.out)["usual"]["flights"] == 3
    # Said again from the rows alone, and a row is the same flown again.
    told = armland("study", "terms", "--no-fly", "--json")
    assert json.loads(told.out) == json.loads(further.out)
    assert armland("campaign", "replay", str(folder / "terms.sqlite"), "1", "--no-figures").code == 0
