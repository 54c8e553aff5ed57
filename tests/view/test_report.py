"""Report of a run from its log, and of a log that is not what it should be."""

import pytest

from armland.errors import LogError
from armland.runtime.log import Log
from armland.view import report
from armland.view.flown import flown, scenario_of
from armland.view.page import flight, study
from armland.view.page.sheet import Section, Sheet, Verdict


def changed(log: Log, **metadata: str | None) -> Log:
    found = {k: v for k, v in {**log.metadata, **metadata}.items() if v is not None}
    return Log(log.ticks, found, log.attachments, True)


def test_one_log_is_a_flight_and_several_are_experiments(landing_log, monkeypatch, tmp_path) -> None:
    asked = []

    def sheet(name: str):
        def make(*args: object) -> Sheet:
            asked.append((name, args))
            return Sheet(name, "", Verdict("x", True, ""), [], [Section("S")], None)

        return make

    monkeypatch.setattr(flight, "flight_sheet", sheet("flight"))
    monkeypatch.setattr(study, "paper_sheet", sheet("paper"))
    one = report.write_report(tmp_path / "one", [landing_log], {"success": True})
    several = report.write_report(tmp_path / "several", [landing_log], {"experiments": {}})
    assert [name for name, _ in asked] == ["flight", "paper"]
    assert asked[0][1] == (landing_log, {"success": True})
    assert "<h1>flight</h1>" in one.read_text()
    assert "<h1>paper</h1>" in several.read_text()


def test_result_is_that_of_the_flight(landing_log, landing) -> None:
    found = report.result_of([landing_log])
    assert found.items() <= {**landing.result, **found}.items()
    assert all(landing.result[key] == value for key, value in found.items())
    assert report.succeeded(found)


def test_scenario_of_the_log_is_the_one_that_flew(landing_log) -> None:
    scenario = scenario_of(landing_log)
    assert scenario.run.seed == 1
    assert scenario.model_dump_json() == landing_log.metadata["scenario"]


@pytest.mark.parametrize(
    ("metadata", "says"),
    [
        ({"scenario": None}, "holds no scenario"),
        (
            {"scenario": '{"title": 3}', "version": "9.9"},
            r"does not know the log's scenario .*read it with armland 9\.9",
        ),
        ({"limits": None}, "no 'limits'"),
        ({"phases": "one"}, "do not fit together"),
    ],
)
def test_log_of_another_kind_is_one_readable_error(landing_log, tmp_path, metadata, says) -> None:
    log = changed(landing_log, **metadata)
    with pytest.raises(LogError, match=says):
        report.write_report(tmp_path, [log], report.result_of([log]))
    assert list(tmp_path.iterdir()) == []


def test_run_has_its_experiment_s_name_or_its_mission_s(landing_log) -> None:
    assert flown(landing_log).name == "landing"
    assert flown(changed(landing_log, experiment="E9")).name == "E9"
