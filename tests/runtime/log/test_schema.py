import numpy as np
import pytest

from armland.errors import LogError
from armland.records import MESSAGES, layout
from armland.runtime.log.schema import LARGEST, converted, schema_layout, schema_name, schema_text, topic


@pytest.mark.parametrize("joints", [1, 6, 7])
@pytest.mark.parametrize("message", MESSAGES)
def test_definition_describes_the_layout(message: str, joints: int) -> None:
    stored, kept = schema_layout(schema_text(message, joints)), layout(message, joints)
    assert stored.names == kept.names
    assert [(stored.fields[n][1], stored[n].base) for n in stored.names] == [
        (kept.fields[n][1], kept[n].base) for n in kept.names
    ]


def test_a_type_has_one_definition() -> None:
    assert len({schema_name(m) for m in MESSAGES}) == len(MESSAGES)


def test_line_says_type_name_meaning_unit_and_frame() -> None:
    lines = schema_text("measurement", 7).splitlines()
    assert lines[0] == "int64 tick  # time of the message in ticks of the base rate [ticks]"
    assert "float64[7] q  # joint positions [rad], frame joint" in lines


def test_names_on_the_wire() -> None:
    assert (topic("estimate"), schema_name("estimate")) == ("/armland/estimate", "armland_msgs/msg/Estimate")


def test_comments_and_blank_lines_do_not_matter() -> None:
    text = "# an older meaning\n\nuint64 tick\nfloat64[3] r  # somewhere else\n"
    assert schema_layout(text) == np.dtype([("tick", "u8"), ("r", "f8", (3,))])


@pytest.mark.parametrize(
    "line", ["float32 x", "float64[] x", "string name", "float64[3]", "float64 A=1", "int64[1234567890] x"]
)
def test_line_that_is_no_fixed_number_is_refused(line: str) -> None:
    with pytest.raises(LogError, match="expected e"):
        schema_layout(line)


@pytest.mark.parametrize(
    "text",
    [
        "",
        "int64 a\nint64 a",
        f"float64[{LARGEST + 1}] a",
        "float64[0] a",
        "".join(f"int64 a{i}\n" for i in range(LARGEST + 1)),
    ],
)
def test_definition_that_asks_for_too_much_is_refused(text: str) -> None:
    with pytest.raises(LogError, match=f"1 to {LARGEST}"):
        schema_layout(text)


def test_older_layout_is_taken_over_field_by_field() -> None:
    then = np.dtype([("v", "f8", (3,)), ("gone", "f8"), ("tick", "u8"), ("R", "f8", (9,))])
    now = np.dtype([("tick", "i8"), ("v", "f8", (3,)), ("new", "f8", (2,)), ("count", "i8"), ("R", "f8", (3, 3))])
    rows, target = np.zeros(2, then), np.ones(2, now)
    rows["tick"], rows["v"], rows["R"] = [7, 8], [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]], np.arange(18.0).reshape(2, 9)
    converted(rows, target, "estimate")
    assert target["tick"].tolist() == [7, 8]
    assert target["v"][1].tolist() == [4.0, 5.0, 6.0]
    assert target["R"][1, 2].tolist() == [15.0, 16.0, 17.0]
    assert np.isnan(target["new"]).all()
    assert target["count"].tolist() == [0, 0]


def test_field_that_had_another_length_is_refused() -> None:
    rows, target = np.zeros(2, [("r", "f8", (2,))]), np.zeros(2, [("r", "f8", (3,))])
    with pytest.raises(LogError, match=r"its field truth\.r has 2 numbers where this version has 3"):
        converted(rows, target, "truth")


def test_without_an_arm_the_fields_of_joints_are_left_out_and_read_as_none():
    text = schema_text("measurement", 0)
    assert "[0]" not in text
    assert " q " not in text
    rows, target = np.zeros(3, schema_layout(text)), np.zeros(3, layout("measurement", 0))
    rows["tick"] = [1, 2, 3]
    converted(rows, target, "measurement")
    assert target["tick"].tolist() == [1, 2, 3]
    assert target["q"].shape == (3, 0)
    assert rows.dtype.itemsize == target.dtype.itemsize
