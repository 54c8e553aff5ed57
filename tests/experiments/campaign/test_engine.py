"""A campaign and its store: killed at any moment, refused where it is another one, stopped when enough is known."""

import json
import random
import signal
import subprocess
import sys
import time

import pytest

from armland.errors import ConfigurationError, StoreError
from armland.experiments.campaign.crews.processes import processes
from armland.experiments.campaign.crews.threads import threads
from armland.experiments.campaign.engine import conduct
from armland.experiments.campaign.store import Store

WIND = "[parameters]\nair.wind_mps = {uniform = [0.0, 3.0]}\n"


def stored(file):
    with Store(file) as store:
        return [row._replace(wall_s=0.0, cpu_s=0.0) for row in store.rows()]


def conducted(campaign, file, work, crew=None, **more):
    with Store(file, write=True) as store:
        return conduct(campaign, store, crew or threads(2), work=work, **more)


DRIVER = """
import json, sys
from pathlib import Path
sys.path.insert(0, sys.argv[1])
import fakes
from armland.experiments.campaign.engine import campaign_of, conduct
from armland.experiments.campaign.crews.processes import processes
from armland.experiments.campaign.store import Store
campaign = campaign_of(json.loads(sys.argv[3]))
print("ready", flush=True)
with Store(Path(sys.argv[2]), write=True) as store:
    conduct(campaign, store, processes(2), work=fakes.quick)
"""


def count(file):
    try:
        return len(stored(file))
    except (ConfigurationError, StoreError):
        # It is being made.
        return 0


def drive(campaign, tmp_path, file):
    call = [sys.executable, "-c", DRIVER, tmp_path / "modules", file, json.dumps(campaign.about())]
    return subprocess.Popen(call, stdout=subprocess.PIPE, text=True)


def test_killed_at_any_moment_and_resumed_equals_unbroken(fakes, made_up, tmp_path):
    campaign, broken = made_up(300, WIND), tmp_path / "broken.sqlite"
    moments, counts = random.Random(), [0]
    for early in (True, False):
        with drive(campaign, tmp_path, broken) as process:
            assert process.stdout.readline() == "ready\n"
            # Once while workers start, then while rows come in.
            while not early and count(broken) <= counts[-1]:
                time.sleep(0.01)
            time.sleep(0.1 * moments.random())
            process.send_signal(signal.SIGKILL)
        counts.append(count(broken))
    assert counts == sorted(counts)
    assert 0 < counts[-1] < 300
    before = stored(broken)
    conducted(campaign, broken, fakes.quick)
    conducted(campaign, tmp_path / "whole.sqlite", fakes.quick)
    whole = stored(tmp_path / "whole.sqlite")
    assert stored(broken) == whole
    assert [row for row in whole if row.run in {r.run for r in before}] == before
    assert len(whole) == 300


def test_rows_are_told_when_they_are_in_the_store(fakes, made_up, tmp_path):
    told = []
    with Store(tmp_path / "a.sqlite", write=True) as store:
        conduct(
            made_up(9), store, threads(2), told=lambda row: told.append(store.row(row.run) == row), work=fakes.quick
        )
    assert told == [True] * 9


def test_processes_and_threads_give_the_same_store(fakes, made_up, tmp_path):
    campaign = made_up(40, WIND)
    conducted(campaign, tmp_path / "a.sqlite", fakes.quick, processes(2))
    conducted(campaign, tmp_path / "b.sqlite", fakes.quick, threads(1))
    assert stored(tmp_path / "a.sqlite") == stored(tmp_path / "b.sqlite")


def test_a_store_may_grow(fakes, made_up, tmp_path):
    conducted(made_up(10, WIND), tmp_path / "a.sqlite", fakes.quick)
    few = stored(tmp_path / "a.sqlite")
    conducted(made_up(25, WIND), tmp_path / "a.sqlite", fakes.quick)
    conducted(made_up(25, WIND), tmp_path / "b.sqlite", fakes.quick)
    assert stored(tmp_path / "a.sqlite") == stored(tmp_path / "b.sqlite")
    assert stored(tmp_path / "a.sqlite")[:10] == few


OTHERS = {
    "another seed": (
        {"text": "first_seed = 5\n" + WIND},
        "another file: first_seed = nothing there, 5 here|first_seed = 0 there, 5 here",
    ),
    "another range": (
        {"text": WIND.replace("3.0", "4.0")},
        r"air.wind_mps.uniform = \[0.0, 3.0\] there, \[0.0, 4.0\] here",
    ),
    "another scenario": (
        {"text": WIND, "scenario": '{"values": {"air": {"wind_mps": 1.5}}}'},
        "another scenario: air.wind_mps = 0.0 there, 1.5 here",
    ),
    "another mission": ({"text": WIND, "mission": "takeoff"}, 'mission = "landing" there, "takeoff" here'),
    "fewer runs": ({"runs": 5, "text": WIND}, "is of --runs 10, more than 5"),
}


@pytest.mark.parametrize(("given", "words"), OTHERS.values(), ids=OTHERS)
def test_a_store_of_another_campaign_is_refused_with_both_named(fakes, made_up, tmp_path, given, words):
    conducted(made_up(10, WIND), tmp_path / "a.sqlite", fakes.quick)
    before = stored(tmp_path / "a.sqlite")
    with pytest.raises(ConfigurationError, match=words):
        conducted(made_up(given.pop("runs", 10), **given), tmp_path / "a.sqlite", fakes.quick)
    assert stored(tmp_path / "a.sqlite") == before


def test_a_store_of_another_version_is_refused_with_both_named(fakes, made_up, tmp_path, monkeypatch):
    from armland.experiments.campaign import engine

    conducted(made_up(10), tmp_path / "a.sqlite", fakes.quick)
    here = engine.versions()
    monkeypatch.setattr(engine, "versions", lambda: {**here, "mujoco": "5.1.0"})
    with pytest.raises(ConfigurationError, match=f'another version: mujoco = "{here["mujoco"]}" there, "5.1.0" here'):
        conducted(made_up(10), tmp_path / "a.sqlite", fakes.quick)


def test_a_scenario_whose_files_have_changed_is_refused(fakes, made_up, tmp_path):
    wind = tmp_path / "wind.csv"
    wind.write_text("time_s,x\n0,1\n")
    campaign = made_up(10, scenario=json.dumps({"values": {"air": {"trace": str(wind)}}}))
    conducted(campaign, tmp_path / "a.sqlite", fakes.quick)
    conducted(campaign, tmp_path / "a.sqlite", fakes.quick)
    wind.write_text("time_s,x\n0,2\n")
    with pytest.raises(ConfigurationError, match=r"contents of the scenario's files: .*wind.csv"):
        conducted(campaign, tmp_path / "a.sqlite", fakes.quick)


def test_comments_of_a_scenario_fly_nothing(fakes, made_up, tmp_path):
    conducted(made_up(5, scenario='{"values": {}, "_text": "# a"}'), tmp_path / "a.sqlite", fakes.quick)
    conducted(made_up(5, scenario='{"values": {}, "_text": "# b"}'), tmp_path / "a.sqlite", fakes.quick)
    with Store(tmp_path / "a.sqlite") as store:
        assert len(list(store.rows())) == 5


def test_a_hypercube_does_not_grow(fakes, made_up, tmp_path):
    text = 'design = "latin"\n' + WIND
    conducted(made_up(10, text), tmp_path / "a.sqlite", fakes.quick)
    with pytest.raises(ConfigurationError, match="a hypercube cannot be made larger; --runs 10 goes on"):
        conducted(made_up(20, text), tmp_path / "a.sqlite", fakes.quick)


def test_it_stops_when_the_rate_is_known_and_resumes_with_nothing_to_do(fakes, made_up, tmp_path):
    watch = conducted(made_up(5000, WIND), tmp_path / "a.sqlite", fakes.hasty, threads(4), until=0.1)
    assert watch.enough
    assert watch.intervals()[0].half <= 0.1
    rows = stored(tmp_path / "a.sqlite")
    assert watch.rows <= len(rows) <= watch.rows + 10
    again = conducted(made_up(5000, WIND), tmp_path / "a.sqlite", fakes.hasty, threads(4), until=0.1)
    assert (again.rows, again.counts) == (watch.rows, watch.counts)
    assert stored(tmp_path / "a.sqlite") == rows


@pytest.mark.parametrize("design", ["latin", "sobol"])
def test_flights_that_depend_on_each_other_do_not_stop_early(fakes, made_up, tmp_path, design):
    with pytest.raises(ConfigurationError, match=f"design = '{design}' are not; design = 'random' works"):
        conducted(made_up(50, f'design = "{design}"\n{WIND}'), tmp_path / "a.sqlite", fakes.quick, until=0.1)


def test_a_disk_that_is_full_ends_it_and_it_goes_on_from_there(fakes, made_up, tmp_path):
    campaign, file = made_up(2000, WIND), tmp_path / "a.sqlite"
    with Store(file, write=True) as store:
        store._base.execute("PRAGMA max_page_count = 30")
        with pytest.raises(
            StoreError, match="full; rows that were written stay: free some space, and --resume goes on"
        ):
            conduct(campaign, store, threads(2), work=fakes.quick)
        some = len(list(store.outcomes()))
        assert 0 < some < 2000
    conducted(campaign._replace(runs=2000), file, fakes.quick, threads(8))
    rows = stored(file)
    assert [row.run for row in rows] == list(range(2000))
