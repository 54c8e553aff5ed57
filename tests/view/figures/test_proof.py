"""Figures and tables of the proof, drawn from a small run."""

from dataclasses import replace

import numpy as np
import pytest

from armland.experiments.proof.verification import prove
from armland.scenario import load_scenario
from armland.view.figures.canvas import paper_style
from armland.view.figures.proof import FIGURES, GROUPS, draw_proof_figures, jump_figure, times_figure
from armland.view.tables.proof import print_proof

SHORT = {"trajectory": {"moves": [{"to_m": [0.05, 0.03, 0.0], "duration_s": 0.6, "rest_s": 0.2}]}}


@pytest.fixture(scope="module")
def proof():
    return prove(load_scenario("paper", SHORT), samples=30)


def test_every_figure_is_written_twice(proof, tmp_path):
    paths = draw_proof_figures(tmp_path, proof)
    assert sorted(p.name for p in paths) == sorted(f"{n}.{e}" for n in FIGURES for e in ("pdf", "png"))
    assert all(p.stat().st_size > 5000 for p in paths)


def test_figures_of_the_demonstrator_need_a_demonstrator(proof, tmp_path):
    paths = draw_proof_figures(tmp_path, replace(proof, channels={}, ledgers={}))
    assert {p.stem for p in paths} == {"proof_decay", "proof_times", "proof_jump"}


def test_times_end_where_all_states_have_arrived(proof):
    with paper_style():
        (axes,) = times_figure(proof).axes
    full = [line for line in axes.lines if line.get_linestyle() == "-"]
    assert [line.get_ydata()[-1] for line in full] == [100.0] * 3
    assert full[0].get_xdata()[-1] == pytest.approx(proof.cases["paper"].paths["arrived"].max())


def test_jump_of_the_torque_is_drawn_from_side_to_side(proof):
    with paper_style():
        left = jump_figure(proof).axes[0]
    below, above = (line for line in left.lines if line.get_color() == "black" and len(line.get_xdata()) > 2)
    assert above.get_ydata()[0] - below.get_ydata()[0] == pytest.approx(36.0, rel=1e-3)


def test_every_term_is_in_one_group_of_the_stack(proof):
    grouped = [name for names, _ in GROUPS.values() for name in names]
    assert sorted(grouped) == sorted(
        set(proof.channels["E1"].dtype.names) - {"t", "v2", "measured", "law", "remainder"}
    )


def test_stack_and_law_make_the_measured_rate(proof):
    c = proof.channels["E2"]
    stacked = sum(c[name] for names, _ in GROUPS.values() for name in names)
    np.testing.assert_allclose(stacked + c["law"] + c["remainder"], c["measured"], atol=1e-9)


def test_tables_say_what_was_found(proof, tmp_path, capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "200")
    print_proof(proof.result(), tmp_path)
    text = capsys.readouterr().out
    for part in ("(29), true kinematics", "states that never arrive", "arm between law and hinge", "holds", "(N·m)"):
        assert part in text
    assert "disturbance" not in text
