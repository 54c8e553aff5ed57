"""Reports in a real browser, with the network off: nothing is loaded, nothing overflows, and axe finds no fault.

Needs Chromium (Debian: `apt-get install chromium`) and axe-core: a folder with `node_modules/axe-core`, named by the variable
`ARMLAND_AXE`, or npm, which fetches it.
"""

import os
import shutil
import subprocess
from pathlib import Path

import pytest

from armland.experiments.campaign.summary import summarise
from armland.experiments.episode import prepare
from armland.experiments.judge.figures import bounds
from armland.experiments.proof.verification import prove
from armland.scenario import load_scenario
from armland.view.page.analyses import envelope_sheet, factorial_sheet, margins_sheet, proof_sheet, spread_sheet
from armland.view.page.flight import flight_sheet
from armland.view.page.sheet import html
from armland.view.page.study import campaign_sheet, comparison_sheet
from armland.view.report import result_of

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or "/usr/bin/chromium"
ARGUMENTS = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-background-networking", "--no-first-run"]
VIEWS = {"light": ("light", 1200), "dark": ("dark", 1200), "narrow": ("dark", 390)}
SVG_TEXT = """
() => [...document.querySelectorAll('svg text')].map(t => t.getBoundingClientRect()).filter(b => b.width > 0)
    .map(b => [b.left + 2, b.top + 0.22 * b.height, b.right - 2, b.bottom - 0.22 * b.height])
"""
"""Boxes of letters without the air above and below them."""


@pytest.fixture(scope="module")
def axe(tmp_path_factory) -> str:
    """The text of axe-core."""
    folder = Path(os.environ.get("ARMLAND_AXE") or tmp_path_factory.mktemp("axe"))
    script = folder / "node_modules" / "axe-core" / "axe.min.js"
    if not script.is_file():
        if shutil.which("npm") is None:
            pytest.skip("no axe-core: name a folder that has it by ARMLAND_AXE, or install npm")
        done = subprocess.run(["npm", "install", "axe-core", "--silent"], cwd=folder, capture_output=True, check=False)
        if done.returncode or not script.is_file():
            pytest.skip(f"npm gives no axe-core: {done.stderr.decode(errors='replace')[-200:]}")
    return script.read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def browser():
    if not Path(CHROMIUM).exists():
        pytest.skip("no Chromium: apt-get install chromium")
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        started = playwright.chromium.launch(executable_path=CHROMIUM, args=ARGUMENTS)
        yield started
        started.close()


@pytest.fixture(scope="module")
def pages(landing_log, failed_log, tmp_path_factory) -> dict[str, Path]:
    folder, out = tmp_path_factory.mktemp("pages"), {}
    for name, log in {"landing": landing_log, "failed": failed_log}.items():
        out[name] = folder / f"{name}.html"
        out[name].write_text(html(flight_sheet(log, result_of([log]))), encoding="utf-8")
    return out


@pytest.fixture(scope="module")
def studies(request, made_up_spread, made_up_factorial, made_up_envelope, made_up_margins, tmp_path_factory):
    """Pages of studies, of campaigns and of laws compared, by name."""
    folder, out = tmp_path_factory.mktemp("studies"), {}
    paper, compare, landing = (load_scenario(name) for name in ("paper", "compare", "landing"))
    row = {"metrics": {"attitude_max_deg": 5.0, "position_rms_m": [1e-3] * 3, "position_max_m": [2e-3] * 3}}
    laws = [{"condition": "as modelled", "law": law, "resting_swing_deg": 0.5, **row} for law in ("E2", "exact")]
    claims = [{"claim": "E2 is better", "value": 0.5, "bound": [0.0, 1.0], "holds": True}]
    flight = prepare(landing, "landing", seed=1)
    rows = [request.getfixturevalue("make_row")(1 + i, 0.02 + 0.001 * i, success=i != 3) for i in range(6)]
    limits = bounds(flight.brief)
    for name, sheet in {
        "spread": spread_sheet(made_up_spread, paper),
        "factorial": factorial_sheet(made_up_factorial, compare),
        "envelope": envelope_sheet(made_up_envelope, landing),
        "margins": margins_sheet(made_up_margins, landing, []),
        "proof": proof_sheet(prove(paper, samples=100), paper, 100),
        "comparison": comparison_sheet({"rows": laws, "verdicts": claims}, compare, None),
        "campaign": campaign_sheet(summarise(rows, limits), rows, limits, flight),
    }.items():
        out[name] = folder / f"{name}.html"
        out[name].write_text(html(sheet), encoding="utf-8")
    return out


@pytest.fixture(params=VIEWS)
def view(request, browser):
    """A window with the network off, and what it asked for and complained of."""
    scheme, width = VIEWS[request.param]
    context = browser.new_context(
        color_scheme=scheme, viewport={"width": width, "height": 900}, offline=True, bypass_csp=True
    )
    page, heard = context.new_page(), []
    page.on("request", lambda r: heard.append(r.url) if not r.url.startswith(("file:", "data:")) else None)
    page.on("console", lambda m: heard.append(m.text) if m.type == "error" else None)
    page.on("pageerror", lambda e: heard.append(str(e)))
    yield page, heard
    context.close()


@pytest.mark.slow
@pytest.mark.parametrize("name", ["landing", "failed"])
def test_axe_finds_no_fault(pages, view, axe, name) -> None:
    check(pages[name], view, axe)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["spread", "factorial", "envelope", "margins", "proof", "comparison", "campaign"])
def test_axe_finds_no_fault_in_a_study(studies, view, axe, name) -> None:
    check(studies[name], view, axe)


def check(file: Path, view, axe: str) -> None:
    """No fault, nothing beside the window, nothing asked for, and below 3 MB."""
    page, heard = view
    assert file.stat().st_size < 3e6
    page.goto(file.as_uri())
    assert page.evaluate("document.documentElement.scrollWidth <= window.innerWidth")
    page.evaluate(axe)
    found = page.evaluate("axe.run()")
    assert [(v["id"], v["nodes"][0]["html"][:200]) for v in found["violations"]] == []
    assert len(found["passes"]) > 20
    assert heard == []


@pytest.mark.slow
def test_axe_finds_what_is_wrong(pages, view, axe) -> None:
    """The same page without names of its pictures, and with letters that are too pale."""
    page, _ = view
    page.goto(pages["failed"].as_uri())
    page.add_style_tag(content="p, td { color: #999 !important; background: #aaa !important; }")
    page.evaluate("document.querySelectorAll('[role=img]').forEach(e => e.removeAttribute('aria-label'))")
    page.evaluate(axe)
    wrong = {v["id"] for v in page.evaluate("axe.run()")["violations"]}
    assert {"color-contrast", "role-img-alt"} <= wrong


@pytest.mark.slow
def test_letters_of_figures_do_not_cover_each_other(pages, view) -> None:
    page, _ = view
    page.goto(pages["landing"].as_uri())
    boxes = page.evaluate(SVG_TEXT)
    assert len(boxes) > 40

    def apart(a: list[float], b: list[float]) -> bool:
        return a[2] <= b[0] or b[2] <= a[0] or a[3] <= b[1] or b[3] <= a[1]

    assert [(a, b) for i, a in enumerate(boxes) for b in boxes[:i] if not apart(a, b)] == []


@pytest.mark.slow
def test_colours_follow_the_scheme_and_print_is_light(pages, browser) -> None:
    found = {}
    for name, scheme, media in (("light", "light", "screen"), ("dark", "dark", "screen"), ("print", "dark", "print")):
        page = browser.new_page(color_scheme=scheme)
        page.emulate_media(media=media, color_scheme=scheme)
        page.goto(pages["landing"].as_uri())
        found[name] = page.evaluate("getComputedStyle(document.body).backgroundColor")
        lines = page.evaluate("getComputedStyle(document.querySelector('svg')).color")
        assert (sum(map(int, lines.strip("rgba()").split(",")[:3])) > 380) == (name == "dark")
        page.close()
    assert found["light"] == found["print"] == "rgb(255, 255, 255)"
    assert found["dark"] != found["light"]
