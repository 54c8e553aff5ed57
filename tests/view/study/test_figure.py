"""The figure of a study: a row for each change, grouped, coloured by what is told apart."""

from armland.view.study.figure import ALIKE, BETTER, WORSE, draw_study, study_page

TOLD = {
    "fast camera": ("camera", 0.25, 0.1, 0.001, -0.5),
    "large magnet": ("magnet", 0.05, 0.1, 0.8, -0.3),
    "late camera": ("camera", -0.4, 0.1, 0.0001, 1.0),
}


def test_rows_stand_by_group_and_are_coloured_by_what_is_told_apart(findings):
    page = study_page(findings(TOLD), "calm air")
    rates, gives, misses = page.axes
    names = [t.get_text() for t in rates.get_yticklabels()]
    assert names == ["as it is", "fast camera", "late camera", "large magnet"]
    points = [line for line in gives.get_lines() if line.get_marker() == "o"]
    assert [line.get_color() for line in points] == [BETTER, WORSE, ALIKE]
    assert [float(line.get_xdata()[0]) for line in points] == [25.0, -40.0, 5.0]
    spans = [line for line in misses.get_lines() if line.get_marker() != "o" and len(set(line.get_ydata())) == 1]
    assert tuple(spans[0].get_xdata()) == (-0.6, -0.4)


def test_files_are_named_after_the_study(findings, tmp_path):
    assert [p.name for p in draw_study(tmp_path, findings(TOLD), "calm air")] == ["study_made.pdf", "study_made.png"]
