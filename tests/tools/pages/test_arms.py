"""The table of arms that were tried counts what landed, and says what stood in the way of the others."""

from pages import arms
from pages.arms import ARMS, Arm, landings, markdown, missing

GOOD = {"arm": "a.urdf", "seed": 1, "moved": "", "result": "lands", "reason": "landed", "share": 0.4, "of": "fall_m"}
REFUSED = {"arm": "b.urdf", "seed": 1, "moved": "", "result": "refused", "reason": "too\n short | weak"}


def test_table_tells_margin_and_reason():
    page = markdown([GOOD, GOOD | {"seed": 2, "share": 0.7, "of": "rest"}, REFUSED])
    assert "2 files, 1 refused" in page
    assert "**2 of 2 flights land**" in page
    assert "| a.urdf | lands 2 of 2 | 30 %, rest |" in page
    assert "| b.urdf | refused: too short \\| weak |  |" in page


def test_failure_is_told_with_its_seed():
    page = markdown([GOOD, GOOD | {"seed": 2, "result": "fails", "reason": "fell"}])
    assert "**1 of 2 flights land**" in page
    assert "lands 1 of 2; seed 2 fails: fell" in page


def test_what_is_there_is_not_flown_again_and_a_refusal_is_told_once(monkeypatch):
    monkeypatch.setattr(arms, "ARMS", (Arm("a.urdf"), Arm("b.urdf"), Arm("c.xml", "hand")))
    assert missing([GOOD, REFUSED], range(1, 3)) == [(Arm("a.urdf"), [2]), (Arm("c.xml", "hand"), [1, 2])]
    assert missing([], range(1, 2)) == [(arm, [1]) for arm in arms.ARMS]


def test_file_that_is_not_there_is_a_refusal_and_no_crash_and_is_told_once(tmp_path):
    made = landings(tmp_path, Arm("none.urdf"), [1, 2])
    assert [r["result"] for r in made] == ["refused"]
    assert "none.urdf" in made[0]["reason"]


def test_arms_are_named_once():
    assert len({a.name for a in ARMS}) == len(ARMS) >= 40
