"""The page of an arm's reach has a dot for each place, and none where there is no place."""

from armland.experiments.reach import Reach, Spot
from armland.scenario import load_scenario
from armland.view.figures.canvas import paper_style
from armland.view.figures.reach import draw_reach, reach_figure

SPOTS = [Spot(0.4, 0.8, 0.5, 0.0, 0.1), Spot(0.5, 0.9, 0.6, 180.0, 0.9)]


def found(spots):
    return Reach(load_scenario("landing"), "", None, spots, 0.62)


def test_page_is_written_as_pdf_and_png_where_there_is_a_place(tmp_path):
    assert [f.name for f in draw_reach(tmp_path, found(SPOTS))] == ["reach.pdf", "reach.png"]
    assert draw_reach(tmp_path, found([])) == []


def test_dots_are_where_the_places_are():
    with paper_style():
        catch, cradle, *_ = reach_figure(found(SPOTS)).axes
    assert catch.collections[0].get_offsets().tolist() == [[0.4, 0.8], [0.5, 0.9]]
    assert cradle.collections[0].get_offsets().tolist() == [[0.5, 0.0], [0.6, 180.0]]
