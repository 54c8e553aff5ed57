"""Each file of the table in `docs/arm.md` does today what the table says, and the UAVs of a package land. Slow: 50 flights.

The packages are fetched into a cache; where they cannot be had the tests are skipped.
"""

import re

import pytest

from armland.cli.options import load
from armland.experiments.episode import fly
from pages.arms import ARMS, PAGE, landings
from pages.packages import PackageError, unpacked

UAVS = ("cf2x_T350", "cf2x_P250", "cf2x_L250", "cf21B_500", "hb_x500")
"""Files of crazyflow."""


def there(name):
    """The package's folder; skips where it cannot be had."""
    try:
        return unpacked(name)
    except PackageError as e:
        pytest.skip(str(e))


def rows(page):
    """Arm -> what its row of the table says."""
    found = re.findall(r"^\| (\S+\.(?:urdf|xml)\S*) \| (.*?) \|[^|]*\|$", page, re.MULTILINE)
    return dict(found)


def said(row):
    """What a row says of seed 1: how it went, and why; of a reason the words, for numbers may differ in their last place."""
    if row.startswith("refused: "):
        return "refused", words(row.removeprefix("refused: "))
    failed = re.search(r"(?:^|; seed 1 )(fails|breaks):", row)
    return (failed[1] if failed else "lands"), None


def words(reason):
    return re.sub(r"[-\d.]+", "#", " ".join(reason.split()).replace("\\|", "|"))


def test_rows_of_the_table_are_read():
    page = "| a/b.urdf | lands 15 of 16; seed 11 fails: x | 3 % |\n| c.xml:hand | refused: 3.5 mm\\|off |  |\n"
    found = rows(page)
    assert {name: said(row) for name, row in found.items()} == {
        "a/b.urdf": ("lands", None),
        "c.xml:hand": ("refused", "# mm|off"),
    }
    assert said("lands 15 of 16; seed 1 fails: fell") == ("fails", None)


def test_table_tells_of_every_arm():
    assert set(rows(PAGE.read_text("utf-8"))) == {arm.name for arm in ARMS}


@pytest.mark.slow
@pytest.mark.parametrize("arm", ARMS, ids=lambda arm: arm.name)
def test_arm_does_what_the_table_says(arm):
    package = there(arm.file.partition("/")[0])
    (record,) = landings(package.parent, arm, [1])
    result, reason = said(rows(PAGE.read_text("utf-8"))[arm.name])
    assert record["result"] == result, record["reason"]
    if reason is not None:
        assert words(record["reason"]) == reason


@pytest.mark.slow
@pytest.mark.parametrize("name", UAVS)
def test_uav_lands_with_nothing_set_but_its_file(name):
    file = there("crazyflow") / "crazyflow" / "drones" / f"{name}.xml"
    result = fly(load("landing", {"uav": str(file), "deviation": "published"}), "landing", 1).result
    assert result["success"], result["reason"]
