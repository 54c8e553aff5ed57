"""What a user is told of a file."""

from armland.models.arm_file.words import lines


def said(file):
    return "\n".join(lines(file))


def test_complete_file_needs_no_words_but_of_its_end_effector(arm):
    full = said(arm("ok.urdf", ee="tool0", armature=0.1))
    assert full == ""
    assert "'tool0', chosen" in said(arm("ok.urdf"))


def test_each_rule_is_said_with_its_values_and_remedy(arm):
    text = said(arm("continuous_no_limit_tag.urdf"))
    for words in (
        "no range in the file",
        "no torque in the file, so by rule: j1 200",
        "--torque-limits",
        "no speed in the file",
    ):
        assert words in text
    assert "by rule: 0.1 kg·m² each of j1" in text


def test_friction_is_said(arm):
    assert "joint friction of the file: in the plant, and made up for by the controller to 0.8: 5 N·m each" in said(
        arm("friction5.urdf")
    )
    assert "joint damping of the file" in said(arm("damping10.urdf"))
    assert "friction" not in said(arm("ok.urdf"))
