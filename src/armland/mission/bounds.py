"""The thresholds that the procedures name, and the shares of the weight that a scenario wants."""

from armland.mission.landing_scenario import Landing
from armland.mission.launch_procedure import CURRENT_GONE_S, FLOWN_S
from armland.mission.phases import Phase


def thresholds(landing: Landing) -> dict[str, float]:
    """The thresholds that the tables name, in the units of their signals."""
    b = landing.bounds
    return {
        "half": 0.5,
        "almost_one": 0.999,
        "uav_error_m": b.uav_error_m,
        "uav_speed_mps": b.uav_speed_mps,
        "align_offset_m": b.align_offset_m,
        "align_speed_mps": b.align_speed_mps,
        "align_tilt_deg": b.align_tilt_deg,
        # A UAV that the onboard loop cannot hold level, a weak rotor for one, is not let go.
        "level_tilt_deg": 2.0,
        "lost_offset_m": b.lost_offset_m,
        "pull_seen_n": b.pull_seen_n,
        "let_go_m": 0.01,
        "settled_s": 0.3,
        "thrust_left_n": 0.05,
        "share_carried": b.share_carried,
        "share_touched": 0.15,
        "share_resting": b.share_resting,
        "force_free_n": b.force_free_n,
        "force_balanced_n": 0.4,
        "rotors_off_n": 0.3,
        "arm_error_m": 0.005,
        "coil_off_s": 0.2,
        "force_light_n": 0.15,
        "force_launched_n": 0.6,
        "current_gone_s": CURRENT_GONE_S,
        "flown_s": FLOWN_S,
        "retreat_m": 0.8 * landing.place.withdraw_m,
        "retries_allowed": landing.bounds.retries + 0.5,
    }


def tuned(phases: tuple[Phase, ...], landing: Landing, weight_n: float) -> tuple[Phase, ...]:
    """The phases with the scenario's shares: what the rotors carry on the way, and the pull that tests the grip."""
    out = []
    for p in phases:
        if p.uav == "ramp" and 0.0 < p.share < 1.0:
            p = p._replace(share=landing.carry_share)
        elif p.name == "capture":
            p = p._replace(share=1.0 + landing.bounds.pull_test_n / weight_n)
        out.append(p)
    return tuple(out)
