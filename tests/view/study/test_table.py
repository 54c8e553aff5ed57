"""What a study says in words: what helps, what harms, and what is not told apart."""

from armland.view.study.table import print_study, sentences

TOLD = {
    "fast camera": ("camera", 0.25, 0.1, 0.001, -0.5),
    "large magnet": ("magnet", 0.05, 0.1, 0.8, -0.3),
    "late camera": ("camera", -0.4, 0.1, 0.0001, 1.0),
}


def test_hardware_is_bought_and_not_saved_on_by_what_is_told_apart(findings):
    lines = sentences(findings(TOLD))
    assert lines[:3] == [
        "To buy first: fast camera (+25 %).",
        "Not to save on: late camera (-40 %).",
        "Not told apart by success: large magnet.",
    ]
    assert "fewer with large magnet" in lines[3]
    assert "no difference below 15.0 %" in lines[4]


def test_where_nothing_is_told_apart_nothing_is_to_be_bought(findings):
    lines = sentences(findings({"large magnet": ("magnet", 0.05, 0.1, 0.8, 0.0)}))
    assert lines[0] == "To buy first: nothing: no exchange is told apart from chance as better."
    assert lines[1] == "Not to save on: nothing that these flights tell apart from chance."


def test_terms_earn_their_place_or_do_harm(findings):
    lines = sentences(findings(TOLD, removes=True))
    assert lines[:2] == ["Earn their place: fast camera (+25 %).", "Do harm here: late camera (-40 %)."]


def test_what_never_comes_into_play_is_said(findings):
    assert "spare: 40 of 40 flights are the same with and without, bit for bit." in sentences(
        findings({"spare": ("mission", 0.0, 0.1, 1.0, 0.0, 40), "other": ("mission", 0.0, 0.1, 1.0, 0.0, 19)})
    )


def test_too_few_flights_are_said_to_tell_nothing(findings):
    assert sentences(findings(TOLD, least=None))[-1].startswith("So few flights tell no difference")


def test_table_counts_seeds_of_a_term_on_the_side_that_has_it(findings, capsys, tmp_path):
    told = {"fast camera": TOLD["fast camera"]}
    for removes, counts in ((False, "12 : 2"), (True, "2 : 12")):
        print_study(findings(told, removes), "calm air", tmp_path)
        first, second = [line for line in capsys.readouterr().out.splitlines() if "fast camera" in line and "│" in line]
        cells = [cell.strip() for cell in first.split("│") if cell.strip()]
        assert cells == ["fast camera", "30/40", "+25 (+15 to +35)", counts, "0.0005"]
        assert "-0.50" in second
        assert "-0.60 to -0.40" in second
