"""The public Python interface: names, and what they lead to."""

import numpy as np
import pytest

import armland


def test_every_public_name_leads_somewhere() -> None:
    assert set(armland.HOMES) <= set(dir(armland))
    for name in armland.HOMES:
        assert getattr(armland, name) is not None
    with pytest.raises(AttributeError, match="it has load_scenario, fly"):
        armland.land  # noqa: B018


def test_laws_are_those_that_fly() -> None:
    from armland.control.laws import backstepping, exact

    assert armland.laws.paper_law is backstepping.paper_law
    assert armland.laws.exact_law is exact.exact_law
    assert all(hasattr(armland.laws, name) for name in armland.laws.__all__)


@pytest.fixture(scope="module")
def episode():
    return armland.fly(armland.load_scenario("landing", {"run": {"duration_s": 1.2}}), "landing", seed=3)


def test_episode_has_result_ticks_and_flat_columns(episode) -> None:
    assert (episode.result["mission"], episode.result["seed"], episode.log) == ("landing", 3, None)
    columns = episode.table()
    assert len({len(column) for column in columns.values()}) == 1
    assert all(column.ndim == 1 for column in columns.values())
    np.testing.assert_array_equal(columns["truth.r.2"], episode.ticks["truth"]["r"][:, 2])
    np.testing.assert_array_equal(columns["mission.phase"], episode.ticks["mission"]["phase"])
    numbers = sum(np.dtype(episode.ticks.dtype[m]).itemsize // 8 for m in episode.ticks.dtype.names)
    assert len(columns) == numbers + len(["time"])


def test_same_seed_is_the_same_flight(episode) -> None:
    again = armland.fly(armland.load_scenario("landing", {"run": {"duration_s": 1.2}}), "landing", seed=3)
    assert again.ticks.tobytes() == episode.ticks.tobytes()
