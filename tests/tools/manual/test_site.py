"""The site as a whole: built without a warning, and nothing on it asks for the internet."""

import re
import shutil
from html.parser import HTMLParser
from pathlib import Path

import pytest
import yaml

ROOT = Path(__file__).parents[3]


@pytest.fixture(scope="module")
def site(tmp_path_factory) -> Path:
    from manual.__main__ import build

    place = tmp_path_factory.mktemp("site")
    build(place)
    return place


class Loaded(HTMLParser):
    """What a page has its reader's browser load by itself."""

    def __init__(self) -> None:
        super().__init__()
        self.found: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = dict(attrs)
        kinds = {"script": "src", "img": "src", "iframe": "src"} | (
            {"link": "href"} if given.get("rel") != "canonical" else {}
        )
        if value := given.get(kinds.get(tag, "")):
            self.found.append(value)


def loaded(html: str) -> list[str]:
    reader = Loaded()
    reader.feed(html)
    return reader.found


def test_pages_load_nothing_from_elsewhere(site) -> None:
    pages = list(site.rglob("*.html"))
    assert len(pages) > 80
    found = {p.relative_to(site).as_posix(): [u for u in loaded(p.read_text("utf-8")) if "//" in u] for p in pages}
    assert {page: urls for page, urls in found.items() if urls} == {}
    # The theme would fetch the program that draws these.
    assert not [p for p in pages if 'class="mermaid"' in p.read_text("utf-8")]


def test_what_would_be_loaded_from_elsewhere_is_found() -> None:
    assert loaded(
        '<script src="https://x.example/a.js"></script><a href="https://x.example">x</a><img src="a.png">'
    ) == [
        "https://x.example/a.js",
        "a.png",
    ]


def test_formulas_drawings_sources_and_docstrings_are_there(site) -> None:
    law = (site / "laws" / "backstepping.html").read_text("utf-8")
    assert law.count('<div class="formula"><math') > 10
    assert '<span class="number">(29)</span>' in law
    assert 'href="../source/src/armland/control/laws/backstepping.py.html"' in law
    assert "<svg" in (site / "architecture.html").read_text("utf-8")
    assert "def paper_law" in re.sub(
        r"<[^>]*>", "", (site / "source/src/armland/control/laws/backstepping.py.html").read_text("utf-8")
    )
    for page, name in (("flight", "armland.experiments.episode.fly"), ("laws", "armland.control.laws.exact.exact_law")):
        assert f'id="{name}"' in (site / "api" / f"{page}.html").read_text("utf-8")


def test_every_page_can_be_found_from_the_navigation() -> None:
    text = re.sub(r"!!python/\S+ \{.*", "", (ROOT / "mkdocs.yml").read_text("utf-8"))
    nav = str(yaml.safe_load(text)["nav"])
    pages = {p.relative_to(ROOT / "docs").as_posix() for p in (ROOT / "docs").rglob("*.md")}
    assert {page for page in pages if f"'{page}'" not in nav} == set()


def test_link_that_leads_nowhere_stops_the_build(tmp_path, monkeypatch) -> None:
    from mkdocs.exceptions import Abort

    from manual import __main__ as manual

    (tmp_path / "docs").mkdir()
    (tmp_path / "docs" / "index.md").write_text("# x\n\n[y](y.md)\n")
    (tmp_path / "mkdocs.yml").write_text("site_name: x\n")
    monkeypatch.setattr(manual, "ROOT", tmp_path)
    with pytest.raises(Abort):
        manual.build(tmp_path / "site")


CHROMIUM = shutil.which("chromium")


@pytest.fixture(scope="module")
def browser():
    if CHROMIUM is None:
        pytest.skip("no chromium: apt-get install chromium")
    from playwright.sync_api import sync_playwright

    with sync_playwright() as play:
        browser = play.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox", "--disable-gpu"])
        yield browser
        browser.close()


@pytest.mark.slow
def test_search_works_from_disk_without_internet(site, browser) -> None:
    page = browser.new_context(offline=True).new_page()
    page.goto((site / "laws" / "exact.html").as_uri())
    page.keyboard.press("f")
    page.keyboard.type("camera_stale")
    found = page.wait_for_selector(".md-search-result__link >> text=Troubleshooting", timeout=20_000)
    assert found is not None


@pytest.mark.slow
@pytest.mark.parametrize(
    "name", ["index", "start", "troubleshooting", "laws/exact", "architecture", "api/flight", "faults"]
)
@pytest.mark.parametrize("width", [400, 1400])
def test_page_is_no_wider_than_its_window_and_asks_for_nothing(site, browser, name: str, width: int) -> None:
    page = browser.new_context(offline=True, viewport={"width": width, "height": 900}).new_page()
    asked: list[str] = []
    page.on("request", lambda request: asked.append(request.url))
    page.goto((site / f"{name}.html").as_uri())
    page.wait_for_load_state("networkidle")
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    assert [url for url in asked if not url.startswith(("file:", "data:", "about:", "blob:"))] == []
