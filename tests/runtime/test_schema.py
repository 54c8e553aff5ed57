import numpy as np
import pytest

from armland.errors import LogError
from armland.mission.records import LANDING_TABLE
from armland.records import PAPER_TABLE as PAPER
from armland.records import MessageTable
from armland.runtime.schema import check_schema, schema_layout, schema_name, schema_text, topic

TABLES = (PAPER, LANDING_TABLE)


@pytest.mark.parametrize("joints", [1, 6, 7])
@pytest.mark.parametrize(("table", "message"), [(t, m) for t in TABLES for m in t.messages])
def test_definition_describes_the_layout(table: MessageTable, message: str, joints: int) -> None:
    assert schema_layout(schema_text(table, message, joints)) == table.layout(message, joints)


def test_a_type_has_one_definition() -> None:
    names = [schema_name(t, m) for t in TABLES for m in t.messages]
    assert len(set(names)) == len(names)


def test_line_says_type_name_meaning_unit_and_frame() -> None:
    lines = schema_text(PAPER, "measurement", 7).splitlines()
    assert lines[0] == "int64 tick  # time of the message in ticks of the base rate [ms]"
    assert lines[2] == "float64[7] q  # joint positions [rad], frame joint"


def test_names_on_the_wire() -> None:
    assert (topic("estimate"), schema_name(PAPER, "estimate")) == ("/armland/estimate", "armland_msgs/msg/Estimate")
    assert schema_name(LANDING_TABLE, "estimate") == "armland_msgs/msg/LandingEstimate"


def test_comments_and_blank_lines_do_not_matter() -> None:
    text = "# an older meaning\n\nuint64 tick\nfloat64[3] r  # somewhere else\n"
    assert schema_layout(text) == np.dtype([("tick", "u8"), ("r", "f8", (3,))])


@pytest.mark.parametrize("line", ["float32 x", "float64[] x", "string name", "float64[3]", "float64 A=1"])
def test_line_that_is_no_fixed_number_is_refused(line: str) -> None:
    with pytest.raises(LogError, match="expected e"):
        schema_layout(line)


@pytest.mark.parametrize(
    ("old", "new", "difference"),
    [
        ("float64[3] r ", "float64[2] r ", r"has 'float64\[2\] r' where this version has 'float64\[3\] r'"),
        ("float64[3] v ", "float64[3] w ", r"has 'float64\[3\] w' where this version has 'float64\[3\] v'"),
        ("int64 tick", "uint64 tick", "has 'uint64 tick' where this version has 'int64 tick'"),
        ("float64[3] tau_att", "# ", r"has no further field where this version has 'float64\[3\] tau_att'"),
        ("int64 tick", "float64 extra\nint64 tick", "has 'float64 extra' where this version has 'int64 tick'"),
    ],
)
def test_other_layout_is_named(old: str, new: str, difference: str) -> None:
    text = schema_text(PAPER, "estimate", 7)
    assert old in text
    with pytest.raises(LogError, match=difference):
        check_schema(PAPER, "estimate", 7, text.replace(old, new))


def test_other_number_of_joints_is_named() -> None:
    check_schema(PAPER, "measurement", 7, schema_text(PAPER, "measurement", 7))
    with pytest.raises(LogError, match=r"'float64\[6\] q' where this version has 'float64\[7\] q'"):
        check_schema(PAPER, "measurement", 7, schema_text(PAPER, "measurement", 6))
