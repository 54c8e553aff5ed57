"""The page on the landing says what the controller's tables say."""

from pathlib import Path

from armland.mission.landing_scenario import landing_scenario
from armland.view.mission_page import mission_markdown

PAGE = Path(__file__).parents[2] / "docs" / "landing.md"


def test_page_is_up_to_date():
    assert PAGE.read_text("utf-8") == mission_markdown(), "run: python -m armland.view.mission_page > docs/landing.md"


def test_thresholds_of_the_scenario_show():
    page = mission_markdown(landing_scenario("landing", {"bounds": {"align_tilt_deg": 7.25}}))
    assert "tilt < 7.25 deg" in page
    assert "tilt < 7.25 deg" not in mission_markdown()
