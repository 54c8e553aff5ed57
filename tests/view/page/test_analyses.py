"""Pages of studies: verdict first, the tables of the terminal, figures, and the command that does it again."""

import pytest

from armland.scenario import load_scenario
from armland.view.page.analyses import envelope_sheet, factorial_sheet, margins_sheet, proof_sheet, spread_sheet
from armland.view.page.sheet import html

SHORT = {"trajectory": {"moves": [{"to_m": [0.05, 0.03, 0.0], "duration_s": 0.6, "rest_s": 0.2}]}}


def sound(found, *words: str) -> None:
    """A page whose tags close and whose names are its own, that loads nothing and says these words."""
    assert found.open == []
    assert len(found.ids) == len(set(found.ids))
    assert not [
        a for _, a in found.tags if a.get("src", "data:").split(":")[0] != "data" or a.get("href", "#")[0] != "#"
    ]
    for word in words:
        assert word in found.text


def test_spread(made_up_spread, paper, taken_apart) -> None:
    sheet = spread_sheet(made_up_spread, paper)
    assert sheet.verdict.word == "2 points of each demonstrator"
    assert "fitted: the paper's claims hold at 75 to 75 % of them" in sheet.verdict.reason
    assert sheet.again.command == "armland paper --spread 2 --seed 1"
    sound(taken_apart(html(sheet)), "points whose UAV keeps upright", "1 of 2", "control.thrust_n")


def test_factorial(made_up_factorial, taken_apart) -> None:
    sheet = factorial_sheet(made_up_factorial, load_scenario("compare"))
    assert sheet.verdict.word == "1 laws × 3 boards × 5 arms"
    assert "1.00°, has E3 with the board as in the paper, arm right" in sheet.verdict.reason
    assert sheet.again.command == "armland paper --compare --factorial --seed 1"
    sound(taken_apart(html(sheet)), "Largest attitude error [°]", "as in observer", "2.00/2.00/2.00")


def test_envelope(made_up_envelope, landing_scenario, taken_apart) -> None:
    found = made_up_envelope
    sheet = envelope_sheet(found, landing_scenario)
    assert sheet.verdict.good == found.holds
    assert sheet.again.command == "armland envelope --flights 2"
    page = taken_apart(html(sheet))
    sound(page, "Largest swing of the plate that the arm matches", "All thresholds at once: 1 of 1")
    marks = {a["class"] for tag, a in page.tags if tag == "span" and a.get("class") in ("good", "bad")}
    assert marks == {"good" if m.holds else "bad" for m in found.margins}


def test_margins(made_up_margins, landing_scenario, taken_apart) -> None:
    sheet = margins_sheet(made_up_margins, landing_scenario, ["--rows", "uav.*"])
    assert not sheet.verdict.good
    assert sheet.verdict.word == "1 inside the published range"
    assert "link.loss" in sheet.verdict.reason
    assert sheet.again.command == "armland margins --rows 'uav.*'"
    sound(taken_apart(html(sheet)), "Worst pairs", "uav.mass × link.loss", "20 of 24 flights succeed", "too fast")
    alone = margins_sheet(made_up_margins._replace(screening=None), landing_scenario, [])
    assert [s.title for s in alone.sections][:3] == ["Margins", "First failures", "Configuration"]


def test_scenario_and_its_changes_are_in_the_command(made_up_envelope, made_up_spread) -> None:
    scenario = load_scenario("landing", {"run": {"seed": 7, "duration_s": 20.0}})
    command = envelope_sheet(made_up_envelope, scenario).again.command
    assert command == "armland envelope --flights 2 --set run.seed=7 --set run.duration_s=20.0"
    assert spread_sheet(made_up_spread, load_scenario("paper", {"run": {"seed": 7}})).again.command.endswith("--seed 7")
    # Another scenario than the command's own is named.
    assert " paper " in f"{envelope_sheet(made_up_envelope, load_scenario('paper')).again.command} "


@pytest.mark.slow
def test_proof(taken_apart) -> None:
    from armland.experiments.proof.verification import prove

    scenario = load_scenario("paper", SHORT)
    proof = prove(scenario, samples=30)
    sheet = proof_sheet(proof, scenario, 30)
    held = sum(v.holds for v in proof.verdicts)
    assert sheet.verdict.word == f"{held} of {len(proof.verdicts)} claims hold"
    assert sheet.again.command.startswith("armland verify --samples 30 --seed 1")
    page = html(sheet)
    assert len(page) < 3e6
    sound(taken_apart(page), "largest rate of rise (W)", "states that never arrive")
