"""Flights that several tests look at, flown once."""

import pytest


@pytest.fixture(scope="session")
def landing_scenario():
    from armland.scenario import load_scenario

    return load_scenario("landing")


@pytest.fixture(scope="session")
def paper_scenario():
    from armland.scenario import load_scenario

    return load_scenario("paper")


@pytest.fixture(scope="session")
def flown(landing_scenario, tmp_path_factory):
    """A landing and a take-off with seed 1, each with its log and the phases that were told of."""
    from armland.experiments.episode import fly

    folder, out = tmp_path_factory.mktemp("flown"), {}
    for mission in ("landing", "takeoff"):
        told = []
        log = folder / f"{mission}.mcap"
        episode = fly(landing_scenario, mission, 1, log=log, progress=lambda *phase, told=told: told.append(phase))
        out[mission] = episode, told
    return out


@pytest.fixture(scope="session")
def landed(flown):
    return flown["landing"][0]


@pytest.fixture(scope="session")
def taken_off(flown):
    return flown["takeoff"][0]


@pytest.fixture(scope="session")
def reproduced(paper_scenario, tmp_path_factory):
    """The paper's experiments, and the folder of their logs."""
    from armland.experiments.paper import prepare, run_experiments

    folder = tmp_path_factory.mktemp("paper")
    return run_experiments(prepare(paper_scenario), folder), folder
