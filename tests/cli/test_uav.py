"""The command `uav`."""

import json
from pathlib import Path

UAVS = Path(__file__).parents[1] / "data" / "uavs"


def test_table_says_values_and_sources(armland):
    done = armland("uav", "x500")
    assert done.code == 0
    text = " ".join(done.out.split())
    for words in ("motorConstant", "needs a magnet rated", "hover takes 0.62"):
        assert words in text


def test_data_of_an_mjcf_file(armland):
    data = json.loads(armland("uav", str(UAVS / "hexa.xml"), "--json").out)
    assert data["values"]["uav.mass_kg"] == {"value": 1.0, "unit": "kg", "source": "hexa.xml"}
    assert len(data["values"]["rotors.place_m"]["value"]) == 6
    assert data["values"]["rotors.max_thrust_n"]["source"].startswith("rule: ")


def test_three_rotors_and_unknown_names_are_refused(armland):
    for name, words in ((str(UAVS / "tri.xml"), "3 rotors make 3"), ("nosuch", "UAVs that come with armland")):
        done = armland("uav", name)
        assert done.code == 2
        assert words in done.err
