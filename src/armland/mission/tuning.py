"""Gains of an experiment: those given, or those that its rule makes for ground and board."""

from armland.control.design.gains import DERIVATIVE_LAG_S, Design, Wanted, onboard_rule, rule
from armland.control.design.margins import Delays
from armland.models.parameters import uav_parameters
from armland.scenario import Scenario
from armland.scenario.control import Poles
from armland.scenario.uav import Onboard


def tuned(scenario: Scenario, experiment: str) -> Scenario:
    """The scenario with the experiment's own attitude controller and, where it asks for the rule, the rule's gains.

    Raises:
        ConfigurationError: poles that the delays do not allow; the message says what they allow.
    """
    e = scenario.experiments[experiment]
    onboard, control = e.onboard or scenario.onboard, scenario.control
    if e.rule is not None:
        design = designed(scenario, e.rule, True, onboard)
        gains = design.gains
        onboard = onboard.model_copy(update={"kp_nm": tuple(design.kp), "kd_nms": tuple(design.kd)})
        k1, k2 = tuple(gains.k1), tuple(gains.k2)
        k3 = {"k3": gains.k3_position, "k3_attitude": gains.k3_attitude}
        control = control.model_copy(update={"k1": k1, "k2": k2, **k3})
    return scenario.model_copy(update={"onboard": onboard, "control": control})


def fitted(scenario: Scenario, believed: Scenario, experiment: str) -> Scenario:
    """What flies in an experiment: the plant's `scenario` with the row's own attitude controller on board.

    Args:
        scenario: the plant's.
        believed: of `tuned`; a rule's gains come from it, as whoever sets them on board knows no better.
        experiment: row of `[experiments]`.
    """
    row, made = scenario.experiments[experiment], believed.onboard
    onboard = row.onboard or scenario.onboard
    if row.rule is not None:
        onboard = onboard.model_copy(update={"kp_nm": made.kp_nm, "kd_nms": made.kd_nms})
    return scenario.model_copy(update={"onboard": onboard})


def designed(scenario: Scenario, poles: Poles, on_board: bool = True, onboard: Onboard | None = None) -> Design:
    """Gains by rule with their margins: attitude feedback on board beside a feed-forward (X.6), or all of it over the link.

    Args:
        scenario: believed.
        poles: wanted.
        on_board: whether the attitude's feedback is on board.
        onboard: attitude controller there; a cascade that makes up for the rotors' lag if absent.

    Raises:
        ConfigurationError: poles that the delays do not allow.
    """
    link, rotors = scenario.link, scenario.rotors
    onboard = onboard or Onboard(controller="cascade", lead_s=rotors.time_constant_s)
    uav = uav_parameters(scenario)
    position = Wanted(poles.position_rad_s, poles.position_damping)
    attitude = Wanted(poles.attitude_rad_s, poles.attitude_damping)
    lag, arm_s, travel_s = rotors.time_constant_s, 1.5 / scenario.run.rate_hz, 1e-3 * link.uplink_delay_ms
    travel_s += 1e-3 * link.downlink_delay_ms + 0.5 / link.rate_hz
    if not on_board:
        return rule(position, attitude, uav, Delays(travel_s + 0.5 / onboard.rate_hz, arm_s, lag))
    if onboard.controller == "cascade":
        # The derivative makes up for the lag; what is left of it is the derivative's own low pass.
        lag = max(lag - onboard.lead_s, 0.0) + DERIVATIVE_LAG_S
    return onboard_rule(position, attitude, uav, Delays(1.0 / onboard.rate_hz, arm_s, lag), travel_s)
