"""Rows as columns, and what failures have in common."""

import numpy as np
import pytest

from armland.experiments.campaign.answers.table import cause, tabulate
from armland.experiments.campaign.rows import Row
from armland.experiments.campaign.store import Store


@pytest.fixture
def table(tmp_path):
    def flight(run, reason="landed", **more):
        result = {
            "seed": run,
            "success": reason == "landed",
            "reason": reason,
            "touchdown": {"offset_m": 0.001 * run},
            **more,
        }
        return Row(run, run % 2, run // 2, {"air.wind_mps": 1.0 * run}, result["success"], "done", result, cpu_s=0.5)

    with Store(tmp_path / "a.sqlite", write=True) as store:
        store.add(flight(2, hinge_force_max_n=20.0), "v")
        store.add(flight(0, "limits violated: a (in guide at 3.1 s); and more"), "v")
        store.add(flight(1, "limits violated: a (in carry at 4.2 s)"), "v")
        store.add(Row(3, 1, 1, {"air.wind_mps": 3.0}, False, "refused", error="too windy"), "v")
        yield tabulate(store)


def test_columns_are_in_the_order_of_the_rows(table):
    assert list(table.run) == [0, 1, 2, 3]
    assert list(table.success) == [False, False, True, False]
    assert table.values == {"air.wind_mps": [0.0, 1.0, 2.0, 3.0]}
    np.testing.assert_allclose(table.figures["touchdown.offset_m"], [0.0, 1.0, 2.0, np.nan])
    np.testing.assert_array_equal(table.figures["hinge_force_max_n"], [np.nan, np.nan, 20.0, np.nan])
    assert "release.speed_mps" not in table.figures
    assert list(table.at(1)) == [False, True, False, True]
    assert table.odd == {"refused": 1}


def test_failures_of_one_kind_are_counted_together_with_the_first_ones_words(table):
    assert table.reasons == {"limits violated: a (in guide at 3.1 s); and more": (2, 0), "refused: too windy": (1, 3)}


def test_a_cause_has_no_numbers():
    assert cause("limits violated: uav_touched_cradle (in guide at 6.07 s, up to 58 N), arm_touched_uav") == (
        "limits violated: uav_touched_cradle"
    )
    assert cause("distance: 0.02 m, above 0.015 m") == cause("distance: 0.03 m, above 0.015 m")


def test_variants_are_columns_by_their_name(tmp_path):
    """What each sets differs in kind, so its name stands for it, beside what is drawn."""
    variants = [{"name": "usual", "values": {}}, {"name": "fast", "values": {"camera.rate_hz": 60}}]
    described = {"variants": variants, "parameters": {"uav.extra_mass_kg": {"uniform": [0.0, 0.1]}}}
    with Store(tmp_path / "c.sqlite", write=True) as store:
        store.describe({"description": described})
        for run, (point, more) in enumerate([(0, {}), (1, {"camera.rate_hz": 60})]):
            result = {"seed": 1, "success": True, "reason": "landed"}
            store.add(Row(run, point, 1, {"uav.extra_mass_kg": 0.05, **more}, True, "done", result), "v")
        assert tabulate(store).values == {"variant": ["usual", "fast"], "uav.extra_mass_kg": [0.05, 0.05]}


def test_a_store_without_rows_has_empty_columns(tmp_path):
    with Store(tmp_path / "b.sqlite", write=True) as store:
        table = tabulate(store)
    assert (len(table.run), table.figures, table.odd) == (0, {}, {})
