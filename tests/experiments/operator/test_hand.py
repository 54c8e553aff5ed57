"""Flights that are steered: the same script gives the same bits, each message does what it says, and refusals change nothing."""

import numpy as np
import pytest

from armland.errors import ConfigurationError
from armland.experiments.episode import fly_prepared, prepare
from armland.experiments.operator.hand import Hand
from armland.experiments.operator.message import asked, message_of
from armland.experiments.operator.script import first_difference, read_script
from armland.mission.controller import Controller
from armland.runtime.log import read_log
from armland.runtime.loops import fly_in_python
from armland.runtime.recorder import Recorder
from armland.scenario.faults import Fault


def told(*messages: tuple) -> list:
    return [message_of({"tick": k, "do": do, **(more[0] if more else {})}) for k, do, *more in messages]


SCRIPT = told(
    (1500, "wind", {"value": 2.0}),
    (2503, "hold"),
    (2600, "noise", {"value": 1.5}),
    (2777, "delay", {"value": 8.0}),
    (2800, "mass", {"value": 1.02}),
    (3301, "resume"),
    (5000, "wind", {"value": 0.0}),
    (
        5200,
        "fault",
        {"fault": {"kind": "push", "body": "uav", "size": 0.3, "direction": [0.0, 1.0, 0.0], "lasts_s": 0.2}},
    ),
    (6500, "abort"),
)


@pytest.fixture(scope="module")
def plan_of(landing_scenario):
    return prepare(landing_scenario, "landing", 1).plan


@pytest.fixture
def hand(landing_scenario, plan_of):
    def make(script=(), scenario=None, known=plan_of):
        return Hand(prepare(scenario or landing_scenario, "landing", 1, known=known), script)

    return make


def flown_by(hand, log=None):
    return fly_prepared(hand.flight, log, port=hand)


def phases(episode) -> list[str]:
    return [p.name for p in episode.judgement.phases]


@pytest.fixture(scope="module")
def steered(landing_scenario, plan_of, tmp_path_factory):
    log = tmp_path_factory.mktemp("steered") / "steered.mcap"
    one = Hand(prepare(landing_scenario, "landing", 1, known=plan_of), SCRIPT)
    return flown_by(one, log), one, log


def test_without_messages_it_is_the_flight_that_nobody_steers(hand, landed) -> None:
    assert first_difference(flown_by(hand()).ticks, landed.ticks) is None


def test_steered_by_hand_it_replays_bit_for_bit(hand, steered) -> None:
    episode, port, log = steered
    assert port.done == SCRIPT
    script = read_script(log)
    assert list(script) == SCRIPT
    again = flown_by(hand(script))
    assert first_difference(again.ticks, episode.ticks) is None


@pytest.mark.slow
@pytest.mark.parametrize("k", [i for i, m in enumerate(SCRIPT) if m.do not in ("hold", "resume")])
def test_left_out_each_message_is_missed(hand, steered, k: int) -> None:
    other = flown_by(hand([m for i, m in enumerate(SCRIPT) if i != k]))
    differs = first_difference(other.ticks, steered[0].ticks)
    assert differs is not None
    assert SCRIPT[k].tick <= differs <= SCRIPT[k].tick + 60


def test_a_loop_in_python_gives_the_same_bits(hand, steered) -> None:
    one = hand([m.at(m.tick - 1500) for m in SCRIPT[:4] if m.tick - 1500 < 1200])
    two = hand(list(one._due))
    for port in (one, two):
        port.flight = port.flight._replace(plan=port.flight.plan._replace(ticks=1300))
    with Recorder(None, 7, 1_000_000) as recorder:
        fly_in_python(one, one.flight.controller, one.flight.plan, recorder)
    assert first_difference(recorder.ticks, flown_by(two).ticks) is None


def test_the_log_says_who_ended_it(steered) -> None:
    episode, _, log = steered
    assert episode.result["reason"].startswith("ended in abort after ")
    assert "the operator aborted it" in episode.result["reason"]
    found = read_log(log)
    assert found.names("faults")[int(found.messages["mission"]["fault"][-1])] == "operator"
    assert "held_by_operator" in found.names("phases")
    k = int(np.argmax(found.messages["mission"]["fault"] > 0))
    assert k == 6500
    assert found.names("phases")[int(found.messages["mission"]["phase"][k])] == "abort"


def test_held_and_let_go_it_lands_all_the_same(hand) -> None:
    episode = flown_by(hand(told((8000, "hold"), (9500, "resume"))))
    assert episode.result["success"], episode.result["reason"]
    at = phases(episode).index("held_by_operator")
    assert phases(episode)[at - 1 : at + 2] == ["carry", "held_by_operator", "carry"]
    held = next(p for p in episode.judgement.phases if p.name == "held_by_operator")
    assert (held.start_s, held.end_s) == (8.0, 9.5)
    # The arm rests, the UAV hangs on it.
    v = np.linalg.norm(episode.ticks["truth"]["ee_v"][8600:9500], axis=1)
    assert v.max() < 0.02


@pytest.mark.slow
def test_while_it_is_held_the_supervisor_watches_as_before(hand) -> None:
    failure = {"fault": {"kind": "link_loss"}}
    episode = flown_by(hand(told((8000, "hold"), (8500, "fault", failure))))
    assert phases(episode)[-2:] == ["held_by_operator", "holding"]
    assert "uav_silent" in episode.result["reason"]


@pytest.mark.parametrize(
    ("tick", "end"), [(300, "refused"), (1500, "abort"), (8000, "holding"), (10000, "secured")], ids=str
)
def test_an_abort_ends_where_the_kind_of_phase_asks(hand, tick: int, end: str) -> None:
    episode = flown_by(hand(told((tick, "abort"))))
    assert phases(episode)[-1] == end
    assert episode.ticks["mission"]["phase"][tick] != episode.ticks["mission"]["phase"][tick - 1]


@pytest.mark.slow
def test_an_abort_while_held_ends_as_one_of_the_phase_before(hand) -> None:
    assert phases(flown_by(hand(told((8000, "hold"), (8600, "abort")))))[-3:] == [
        "carry",
        "held_by_operator",
        "holding",
    ]


@pytest.mark.slow
def test_a_fault_thrown_in_for_a_phase_waits_for_it(hand) -> None:
    failure = {"fault": {"kind": "link_loss", "phase": "carry", "after_s": 0.2}}
    episode = flown_by(hand(told((1000, "fault", failure))))
    carry = next(p for p in episode.judgement.phases if p.name == "carry")
    assert phases(episode)[-1] == "holding"
    assert carry.end_s - carry.start_s == pytest.approx(0.2 + 0.28, abs=0.05)


def test_what_cannot_be_done_is_refused_and_changes_nothing(hand, landed) -> None:
    port = hand()
    refused = []

    def try_all():
        for message in (asked("resume"), asked("sea", 2.0), asked("fault", fault=Fault(kind="push", phase="lunch"))):
            with pytest.raises(ConfigurationError) as no:
                port.do(message)
            refused.append(str(no.value))

    port.connect()
    with pytest.raises(ConfigurationError, match="the flight has not begun"):
        port.do(asked("hold"))
    with pytest.raises(ConfigurationError, match="the flight has not begun"):
        port.do(asked("abort"))
    controller, rows = port.flight.controller, np.empty(3000, landed.ticks.dtype)
    flown = 0
    while flown < 3000:
        done, _ = port.advance(controller, rows[flown : flown + 250])
        flown += done
        if flown <= 500:
            try_all()
    assert first_difference(rows, landed.ticks[:3000]) is None
    assert port.done == []
    assert "the mission is not held, it is in self_test" in refused[0]
    assert "this flight is on land" in refused[1]
    assert "no phase 'lunch'" in refused[2]


def test_an_ended_mission_is_neither_held_nor_aborted(hand) -> None:
    port = hand(told((300, "abort")))
    flown_by(port)
    for verb in ("hold", "abort"):
        with pytest.raises(ConfigurationError, match="the mission has ended in refused"):
            port.do(asked(verb))


def test_held_twice_is_refused(hand) -> None:
    port = hand(told((1500, "hold"), (1600, "hold")))
    with pytest.raises(ConfigurationError, match="held already"):
        flown_by(port)


@pytest.mark.slow
def test_a_path_by_the_clock_is_not_held_but_aborted(paper_scenario) -> None:
    port = Hand(prepare(paper_scenario, "E1", 1), told((3000, "hold")))
    with pytest.raises(ConfigurationError, match="follows a path by the clock"):
        flown_by(port)
    episode = flown_by(Hand(prepare(paper_scenario, "E1", 1), told((3000, "abort"))))
    assert phases(episode)[-1] == "resting"


@pytest.mark.slow
def test_the_sea_calms_down_and_the_deck_with_it(landing_scenario) -> None:
    scenario = landing_scenario.replaced({"sea": {"state": "ss2"}})
    port = Hand(prepare(scenario, "landing", 1), told((2000, "sea", {"value": 0.0})))
    episode = flown_by(port)
    deck = episode.ticks["truth"]["deck"][:, 2]
    before, after = np.ptp(deck[:2000]), np.ptp(deck[6000:9000])
    assert before > 0.05
    assert after < 1e-3
    # Nothing jumps: the deck's own speed stays what a hull's is.
    assert np.abs(np.diff(deck)).max() < 2e-3
    rough = Hand(prepare(scenario, "landing", 1))
    assert np.ptp(flown_by(rough).ticks["truth"]["deck"][6000:9000, 2]) > 0.05


def test_the_mass_weighs_at_once(hand) -> None:
    port = hand()
    model, uav = port.flight.simulator.scene.model, port.flight.simulator.scene.uav_body
    mass, whole = float(model.body_mass[uav]), float(model.body_subtreemass[uav])
    port.connect()
    port.do(asked("mass", 1.5))
    assert model.body_mass[uav] == pytest.approx(1.5 * mass)
    assert model.body_subtreemass[uav] == pytest.approx(whole + 0.5 * mass)
    port.do(asked("mass", 1.0))
    assert model.body_mass[uav] == mass


def test_noise_and_delay_count_from_what_the_scenario_says(hand) -> None:
    port = hand()
    told_ = port.flight.simulator.world["told"]
    sigma, up = told_["wrench"]["sigma"].copy(), int(told_["link"]["up"][0])
    for factor in (3.0, 0.5, 1.0):
        port.do(asked("noise", factor))
        np.testing.assert_array_equal(told_["wrench"]["sigma"], factor * sigma)
    for more in (40.0, 10.0, 0.0):
        port.do(asked("delay", more))
        assert told_["link"]["up"][0] == up + more
    port.do(asked("delay", 400.0))
    assert told_["link"]["up"][0] < 1024


def test_a_recorded_wind_is_not_steered(landing_scenario, tmp_path) -> None:
    trace = tmp_path / "wind.csv"
    rows = "\n".join(f"{t},0.5,0,0" for t in range(0, 130))
    trace.write_text(f"time_s,x,y,z\n{rows}\n")
    scenario = landing_scenario.replaced({"air": {"trace": str(trace)}})
    port = Hand(prepare(scenario, "landing", 1))
    with pytest.raises(ConfigurationError, match="recorded one"):
        port.do(asked("wind", 3.0))


@pytest.mark.slow
def test_there_is_room_for_a_hundred_faults(hand) -> None:
    port = hand()
    for _ in range(100):
        port.do(asked("fault", fault=Fault(kind="push", phase="carry", size=0.1)))
    with pytest.raises(ConfigurationError, match="room for 100"):
        port.do(asked("fault", fault=Fault(kind="push")))


def test_the_controller_is_the_flight_s(hand) -> None:
    port = hand()
    assert isinstance(port.flight.controller, Controller)
    assert port.flight.controller.plan.names[-2:] == ("held_by_operator", "held_on_cradle")
    assert port.compilable
    assert port.tick == 0
