"""A scenario without what differs from seed to seed: for studies in which only what they vary may vary."""

from armland.scenario import Scenario
from armland.scenario.sensing import Imperfections


def quiet(scenario: Scenario, camera: bool = False) -> Scenario:
    """The scenario without imperfections, faults and differences between seeds.

    Args:
        scenario: any.
        camera: whether noise, delay and drop-outs of the camera stay.
    """
    none = {name: 0.0 for name, f in Imperfections.model_fields.items() if f.annotation is not bool}
    start = {"start_offset_m": (0.0, 0.0, 0.0), "start_speed_mps": 0.0, "start_heading_deg": 0.0}
    imperfections = {**none, "camera": camera, "noise": False}
    return scenario.replaced({"imperfections": imperfections, "place": start, "faults": ()})
