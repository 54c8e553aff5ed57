"""The page: all of the report, nothing from elsewhere, nothing that a title could break."""

import re
from html.parser import HTMLParser

import pytest

from armland.view.campaign.page import page

VOID = {"meta", "img", "br", "link", "hr", "input"}


class Tags(HTMLParser):
    def __init__(self):
        super().__init__()
        self.open, self.sources, self.wrong = [], [], []

    def handle_starttag(self, tag, attributes):
        self.sources += [v for k, v in attributes if k in ("src", "href")]
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            self.wrong.append(tag)


@pytest.fixture(scope="module")
def text(made):
    file, report, table = made
    return page(report, table, file)


def test_page_is_whole_and_needs_nothing_beside_it(text):
    tags = Tags()
    tags.feed(text)
    assert (tags.open, tags.wrong) == ([], [])
    assert len(tags.sources) == 4
    assert all(source.startswith("data:image/svg+xml;base64,") for source in tags.sources)
    assert not re.search(r"<script|@import|url\(|https?://", text)


def test_page_says_what_the_report_says(text, made):
    file, report, _ = made
    for p in report.points:
        assert f"<td>{p.flights}</td><td>{p.successes}</td>" in text
    assert f"armland campaign replay {file} {report.worst[0].run}" in text
    assert "Against sea.state = calm, seed by seed" in text
    assert "refused: no place" in text
    assert report.versions["mujoco"] in text


def test_page_is_read_by_ear_and_in_the_dark(text):
    assert text.count("<main>") == text.count("</main>") == 1
    assert text.index("<main>") < text.index("<h1>")
    assert re.findall(r"<th[^>]*></th>", text) == []
    light, dark = (dict(re.findall(r"(--\w+): (#\w+)", rule)) for rule in re.findall(r":root \{[^}]*\}", text))
    assert light.keys() == dark.keys()
    assert set(re.findall(r"var\((--\w+)\)", text)) == light.keys()


def test_titles_are_text_and_no_tags(text):
    assert "Wind &amp; &lt;load&gt;" in text
    assert "<load>" not in text


def test_a_single_point_has_its_rate_on_top_and_early_stops_are_explained(made):
    file, report, table = made
    one = report._replace(points=report.points[:1], pairings=(), until=0.02)
    text = page(one, table, file)
    assert 'class="card"' in text
    assert "95 % interval at all looks" in text
    assert "Confidence sequences" in text
