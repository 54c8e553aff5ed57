"""What is printed of a UAV: every key can be read in a terminal of 80 columns."""

from armland.models.airframe.sizing import sized
from armland.models.airframe.survey import survey
from armland.models.airframe.table import rows_of
from armland.scenario import load_scenario
from armland.view.tables.uav import print_uav


def test_no_key_is_cut_off_in_a_narrow_terminal(monkeypatch, capsys):
    monkeypatch.setenv("COLUMNS", "80")
    scenario = sized(load_scenario("landing", {"airframe": "crazyflie"}))
    rows = rows_of(scenario)
    print_uav(rows, survey(scenario), [], [])
    printed = capsys.readouterr().out
    assert all(row.key in printed for row in rows)
    assert max(map(len, printed.splitlines())) <= 80
