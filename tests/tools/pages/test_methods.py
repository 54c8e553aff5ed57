"""The table of methods over wind and sea says what `compare.json` has."""

from pages.methods import markdown, page, short


def comparison(conditions, rates):
    def rate(number):
        return {"number": number, "of": 40, "low": max(number / 40 - 0.1, 0.0), "high": min(number / 40 + 0.1, 1.0)}

    return {
        "conditions": conditions,
        "runs": 40,
        "methods": [{"name": n, "success": rate(a), "stands": rate(b)} for n, (a, b) in rates.items()],
    }


FOUND = [
    comparison("calm air, on land, 40 flights of each", {"arm": (39, 40), "tether": (32, 40)}),
    comparison("wind 8 m/s at 20 ft, sea state 2, hull 4 m, 40 flights of each", {"arm": (38, 39), "tether": (20, 35)}),
]


def test_conditions_are_said_shortly():
    assert [short(c["conditions"]) for c in FOUND] == ["calm, land", "8 m/s, sea state 2"]


def test_table_has_a_row_for_each_weather():
    head, _, calm, windy = markdown(FOUND).splitlines()
    assert head == "| wind at 20 ft, sea, flights | arm | tether |"
    assert calm == "| calm, land, 40 | 98 [88, 100]; 40 stand | 80 [70, 90]; 40 stand |"
    assert windy.startswith("| 8 m/s, sea state 2, 40 | 95 [85, 100]; 39 stand | 50 [40, 60]; 35 stand |")


def test_figure_has_a_line_for_each_method_at_its_rates():
    left, right = page(FOUND).axes
    for axes, key in ((left, "success"), (right, "stands")):
        drawn = [line.get_ydata().tolist() for line in axes.lines if len(line.get_ydata()) == 2]
        for k, name in enumerate(("arm", "tether")):
            wanted = [100.0 * c["methods"][k][key]["number"] / 40 for c in FOUND]
            assert wanted in drawn, name
