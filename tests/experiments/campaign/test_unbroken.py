"""True flights: a campaign that is killed twenty times, workers and all, ends with the store of one that nobody disturbed."""

import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from armland.errors import ConfigurationError, StoreError
from armland.experiments.campaign.crews.threads import threads
from armland.experiments.campaign.engine import campaign_of, conduct
from armland.experiments.campaign.store import Store

STUDY = """
mission = "landing"
overrides.run.duration_s = 2.0

[parameters]
air.wind_mps = {sweep = [3.0, 5.0]}
uav.extra_mass_kg = {uniform = [0.0, 0.05]}
"""
KILLS, RUNS = 20, 100


def stored(file):
    """Rows without times."""
    with Store(file) as store:
        rows = [row._replace(wall_s=0.0, cpu_s=0.0, result=dict(row.result or {})) for row in store.rows()]
    for row in rows:
        for name in ("wall_s", "real_time_factor"):
            row.result.pop(name, None)
    return rows


def count(file):
    try:
        return len(stored(file))
    except (ConfigurationError, StoreError):
        # It is being made.
        return 0


def workers_of(parent):
    found = Path(f"/proc/{parent}/task/{parent}/children")
    return [int(n) for n in found.read_text().split()] if found.exists() else []


def alive(number):
    try:
        return Path(f"/proc/{number}/stat").read_text().split(") ")[1][0] != "Z"
    except OSError:
        return False


@pytest.mark.slow
def test_twenty_kills_and_dead_workers_leave_the_store_of_an_unbroken_campaign(tmp_path):
    (tmp_path / "study.toml").write_text(STUDY)
    file, moments, kept = tmp_path / "a.sqlite", random.Random(), 0
    call = [
        sys.executable,
        "-m",
        "armland",
        "campaign",
        "study.toml",
        "--runs",
        str(RUNS),
        "--out",
        str(file),
        "--resume",
        "--jobs",
        "2",
    ]
    path = {"PYTHONPATH": os.pathsep.join(os.path.abspath(p) for p in sys.path if p)}
    for k in range(KILLS):
        with subprocess.Popen(call, cwd=tmp_path, env=os.environ | path, stderr=subprocess.DEVNULL) as process:
            # Every other time while it starts, else when rows come in.
            begun = time.monotonic()
            while k % 2 and count(file) <= kept and process.poll() is None:
                assert time.monotonic() < begun + 200.0
                time.sleep(0.05)
            time.sleep((0.5 if k % 2 else 5.0) * moments.random())
            workers = workers_of(process.pid)
            if k % 4 == 3 and workers:
                # A worker first: the campaign goes on without it.
                os.kill(moments.choice(workers), signal.SIGKILL)
                time.sleep(0.5)
                assert process.poll() is None
                workers += workers_of(process.pid)
            process.send_signal(signal.SIGKILL)
        end = time.monotonic() + 20.0
        while any(alive(w) for w in workers):
            assert time.monotonic() < end, "a worker has outlived its parent"
            time.sleep(0.05)
        now = count(file)
        assert now >= kept
        kept = now
    subprocess.run([*call, "--no-figures"], cwd=tmp_path, env=os.environ | path, check=True, capture_output=True)
    with Store(file) as store:
        campaign = campaign_of(store.about)
    with Store(tmp_path / "b.sqlite", write=True) as other:
        conduct(campaign, other, threads(2))
    assert stored(file) == stored(tmp_path / "b.sqlite")
    assert len(stored(file)) == 2 * RUNS
    assert 0 < kept < 2 * RUNS
