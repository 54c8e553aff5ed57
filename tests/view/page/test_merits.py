import pytest

from armland.view.flown import flown
from armland.view.page.merits import figures, limits, tiles
from armland.view.report import result_of


@pytest.fixture(scope="module")
def run(landing_log):
    return flown(landing_log)


@pytest.fixture(scope="module")
def result(landing_log):
    return result_of([landing_log])


def test_tiles_name_group_value_and_bound(result, run) -> None:
    found = {t.name: t for t in tiles(result, run)}
    assert found["touchdown speed"].bound == "at most 0.15 m/s"
    assert found["touchdown speed"].value == f"{result['touchdown']['speed_mps']:.3f} m/s"
    assert found["duration"].bound == "ended in done"
    assert all(t.mark == "good" for t in found.values() if t.name != "duration")


def test_missed_bound_is_marked(result, run) -> None:
    spoilt = {**result, "touchdown": {**result["touchdown"], "tilt_deg": 3.1}}
    found = {t.name: t.mark for t in tiles(spoilt, run)}
    assert (found["touchdown tilt"], found["touchdown speed"]) == ("bad", "good")
    verdicts = [r[3] for r in figures(spoilt, run).rows if r[0] == "tilt [°]"]
    assert [v.text for v in verdicts] == ["fails"]


def test_figure_that_never_came_holds_nothing(result, run) -> None:
    lost = {**result, "touchdown": dict.fromkeys(result["touchdown"])}
    rows = [r for r in figures(lost, run).rows if r[0] == "beside the middle [mm]"]
    assert (rows[0][1], rows[0][3].text) == ("-", "fails")
    assert not any(t.name.startswith("touchdown") for t in tiles(lost, run))


def test_violated_limits_are_marked_and_others_added(result, run) -> None:
    spoilt = {**result, "limits_violated": ["joint_speed", "uav_fell"]}
    rows = {r[0]: r[3] for r in limits(spoilt, run).rows}
    assert {name for name, cell in rows.items() if cell.mark == "bad"} == {"joint speed, of the limit", "uav fell"}
