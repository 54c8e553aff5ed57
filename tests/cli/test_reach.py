"""The command `reach`."""

import pytest

from armland.experiments import reach as module


def test_it_prints_whether_the_place_works(armland, monkeypatch, tmp_path):
    monkeypatch.setattr(module, "everywhere", lambda bench: [])
    done = armland("reach", "--no-figures", "--out", str(tmp_path / "out"))
    assert done.code == 0
    assert "place.catch_m = [0.62, 0.0, 0.86] with place.put_down_m = [0.68, 0.0, 0.701] works" in " ".join(
        done.out.split()
    )
    assert (tmp_path / "out" / "reach.json").is_file()


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (("--arm", "nowhere.urdf"), "there is no such file"),
        (("--set", "place.catch_m=1"), "place.catch_m"),
        (("--torque-limits", "much"), "expected numbers by commas"),
    ],
)
def test_bad_input_is_one_message_and_exit_code_2(armland, given, words):
    done = armland("reach", *given)
    assert done.code == 2
    assert words in done.err
    assert "Traceback" not in done.err
