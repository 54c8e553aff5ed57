"""The study `terms`: what each term of the control in wind and at sea gives. A further term is one line of `TERMS`."""

from armland.experiments.study.table import Change, Study
from armland.models.weather import USUAL

CALM_STATION = {"k_position": 1.2, "k_velocity": 3.0, "k_integral": 1.2, "vertical": 1.0}
"""Gains of the station keeping in calm air."""

ARM, UAV, MISSION = "the arm", "the UAV", "the mission"

TERMS = Study(
    "terms",
    "What each term of the control at sea gives",
    "all terms",
    True,
    (
        Change(
            "deck feed-forward", ARM, "torques that the base's motion asks for", {"control.deck_feedforward": False}
        ),
        Change("kept pose", ARM, "the null space returns to the pose of the approach", {"control.posture_rad_s": 0.0}),
        Change("load observer", ARM, "disturbance observer (X.3)", {"estimation.load_observer_rad_s": 0.0}),
        Change(
            "deck-following", UAV, "the station goes along with the deck (K.2)", {"control.station.rides_rad_s": 0.3}
        ),
        Change("prediction by τ", UAV, "asked beforehand by its lateness (K.2, K.4)", {"control.station.ahead": 0.0}),
        Change("accelerometers", UAV, "fused into the plate's pose", {"estimation.plate.accelerometer": False}),
        Change(
            "gusts cancelled", UAV, "the disturbance found in the plate filter", {"control.station.gust_share": 0.0}
        ),
        Change(
            "stiff station", UAV, "gains against gusts", {f"control.station.{k}": v for k, v in CALM_STATION.items()}
        ),
        Change("upright rotors", UAV, "thrust that keeps it upright on the arm", {"control.thrust.carry_share": 0.5}),
        Change("spare thrust", MISSION, "the arm waits until there is some", {"bounds.spare_least": 0.0}),
        Change("room above", MISSION, "the UAV waits 0.4 m above the catch", {"place.waits_above_m": 0.0}),
        Change("room below", MISSION, "catch and cradle 0.33 m apart", {f"place.{k}": v for k, v in USUAL.items()}),
        Change("kept hold", MISSION, "the arm keeps hold of what it put down", {"place.keep_hold": False}),
    ),
)
"""Each without one term: what it gives is what is lost without."""
