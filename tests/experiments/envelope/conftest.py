"""One bench for captures and one small study, shared."""

import pytest


@pytest.fixture(scope="session")
def bench(landing_scenario):
    from armland.experiments.envelope.bench import CaptureBench

    return CaptureBench(landing_scenario)


@pytest.fixture(scope="session")
def coarse():
    from armland.experiments.envelope.bounds import Detail

    return Detail(directions=2, corners=1, points=2, coarse=3, fine=3)


@pytest.fixture(scope="session")
def small(landing_scenario, coarse):
    from armland.experiments.envelope.study import study

    return study(landing_scenario, coarse, flights=1, frequencies=(0.7,))
