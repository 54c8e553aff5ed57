"""Each mission's page says what its value says."""

from pathlib import Path

import pytest

from armland.mission.registry import MISSIONS, UNAIDED
from armland.scenario import load_scenario
from pages.missions import mission_markdown, pages

FOLDER = Path(__file__).parents[3] / "docs" / "missions"


def test_pages_are_up_to_date() -> None:
    made = dict(pages())
    kept = {p.name: p.read_text("utf-8") for p in FOLDER.glob("*.md")}
    assert kept == made, "run: make pages"


def test_every_mission_has_a_page_with_its_phases() -> None:
    made = dict(pages())
    missions = {**MISSIONS, **UNAIDED}
    assert set(made) == {f"{name}.md" for name in missions}
    for name, mission in missions.items():
        assert mission.summary in made[f"{name}.md"]
    for phase in ("self_test", "align", "hand_over", "withdraw"):
        assert f"| `{phase}` | " in made["landing.md"]


@pytest.mark.parametrize("degrees", [5.25, 7.25])
def test_thresholds_of_the_scenario_show(degrees: float) -> None:
    page = mission_markdown("landing", load_scenario("landing", {"bounds": {"align_tilt_deg": degrees}}))
    assert f"tilt < {degrees:g} deg" in page
