"""Flights that several tests look at, flown once."""

import pytest


@pytest.fixture(scope="session")
def paper_scenario():
    from armland.scenario import load_scenario

    return load_scenario("paper")


@pytest.fixture(scope="session")
def reproduced(paper_scenario, tmp_path_factory):
    """The paper's experiments, and the folder of their logs."""
    from armland.experiments.paper import prepare, run_experiments

    folder = tmp_path_factory.mktemp("paper")
    return run_experiments(prepare(paper_scenario), folder), folder
