"""A browser drives the console and the replay, as a person would: headless Chromium from Debian's packages, by Playwright.

One quick test goes through all of it in small windows; the slow ones look closer, at other logs and at doors that stay shut.

Pictures of each step are kept in the folder that ARMLAND_SCREENSHOTS names, for somebody to look at.
"""

import os
import shutil
import subprocess
import sys
import tempfile
from contextlib import contextmanager
from pathlib import Path

import pytest

from armland.experiments.operator.script import read_script
from armland.runtime.log import read_log

ROOT = Path(__file__).parents[2]

ARGUMENTS = [
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-dev-shm-usage",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    # WebGL in software.
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
]

MS = 120_000


@pytest.fixture(scope="module")
def browser():
    api = pytest.importorskip("playwright.sync_api", reason="Playwright is not installed: pip install playwright")
    file = next(filter(None, map(shutil.which, ("chromium", "chromium-browser"))), None)
    if file is None:
        pytest.skip("no Chromium to drive: apt-get install chromium")
    with api.sync_playwright() as playwright:
        made = playwright.chromium.launch(executable_path=file, args=ARGUMENTS)
        yield made
        made.close()


class View:
    """A page in the browser; what its scripts complain of is in `errors`."""

    def __init__(self, browser, address: str, width: int, height: int, name: str) -> None:
        self.page = browser.new_page(viewport={"width": width, "height": height})
        self.page.context.grant_permissions(["clipboard-read", "clipboard-write"])
        self.page.set_default_timeout(MS)
        self.name, self.errors = name, []
        self.page.on("pageerror", lambda e: self.errors.append(str(e)))
        self.page.goto(address)

    def sees(self, text: str) -> None:
        self.page.get_by_text(text).first.wait_for()

    def phase(self, *names: str) -> None:
        """Wait for one of the phases."""
        self.page.locator(", ".join(f'[data-phase="{name}"]' for name in names)).first.wait_for()

    def passed(self, name: str) -> None:
        """Wait until a phase has been flown, or is: a page that is drawn late may never show it as the one in progress."""
        self.page.locator("[data-phase]").filter(has_text=name).first.wait_for()

    def press(self, name: str) -> None:
        self.page.get_by_role("button", name=name, exact=True).first.click()

    def tab(self, name: str) -> None:
        self.page.get_by_role("tab", name=name).click()

    def choose(self, label: str, value: str) -> None:
        self.page.get_by_label(label, exact=True).first.click()
        self.page.get_by_role("option", name=value, exact=True).first.click()

    def slide_to_end(self, label: str) -> None:
        self.slider(label).press("End")

    def slider(self, label: str):
        number = self.page.locator("label", has_text=label).first.get_attribute("for")
        return (
            self.page.locator(f'[id="{number}"]')
            .locator("xpath=ancestor-or-self::*[.//*[@role='slider']][1]")
            .get_by_role("slider")
            .first
        )

    def field(self, label: str):
        return self.page.locator("label", has_text=label).first.locator(
            "xpath=following::*[self::input or self::textarea][1]"
        )

    def key(self, key: str) -> None:
        # Keys are the page's while no field has the focus.
        self.page.evaluate("document.activeElement && document.activeElement.blur()")
        self.page.keyboard.press(key)

    def picture(self, step: str) -> None:
        if folder := os.environ.get("ARMLAND_SCREENSHOTS"):
            # Drawn in software a scene is late.
            self.page.wait_for_timeout(2500)
            close = "document.querySelectorAll('.mantine-Notification-closeButton').forEach(b => b.click())"
            self.page.evaluate(close)
            self.page.screenshot(path=str(Path(folder) / f"{self.name}_{step}.png"))

    def covered(self) -> float:
        """How much of the scene the panel hides in a narrow window, px."""
        scene = self.page.locator("canvas").first.bounding_box()
        panel = self.page.locator(".mantine-Paper-root").filter(has_text="armland").first.bounding_box()
        assert panel["width"] == self.page.viewport_size["width"]
        assert scene["height"] > 200
        return scene["y"] + scene["height"] - panel["y"]

    def width_overflow(self) -> int:
        return self.page.evaluate("document.documentElement.scrollWidth - window.innerWidth")


@contextmanager
def served(*arguments: str):
    """The address of a command that serves a page, while it does."""
    # Should it crash, the stacks of its threads are told.
    command = [sys.executable, "-X", "faulthandler", "-m", "armland", *arguments, "--no-browser", "--port", "0"]
    with (
        tempfile.TemporaryFile("w+") as said,
        subprocess.Popen(command, stdout=subprocess.PIPE, stderr=said, text=True, cwd=ROOT) as run,
    ):
        try:
            line = run.stdout.readline()
            assert "http" in line, line
            yield line.split()[2]
        finally:
            run.send_signal(2)
            ended = run.wait(timeout=60)
            said.seek(0)
            assert ended in (0, 130), said.read()


def test_a_landing_is_steered_and_scrubbed_through(browser, log_file, tmp_path) -> None:
    """In small windows, of which a software renderer draws a picture soon."""
    logs = tmp_path / "logs"
    with served("console", "--out", str(logs), "--set", "imperfections.camera=false") as address:
        view = View(browser, address, 1000, 500, "quick")
        view.sees("press start")
        view.tab("next flight")
        view.field("arm (file, name)").fill(str(ROOT / "examples" / "seven_axis.urdf"))
        view.press("pause")
        view.press("start")
        view.press("10 ticks")
        view.phase("self_test")
        view.tab("steer")
        view.slider("wind").press("ArrowRight")
        view.tab("faults")
        view.choose("phase", "approach")
        view.sees("in approach the supervisor goes to abort")
        view.press("throw it in")
        view.choose("times real time", "4")
        view.press("run")
        view.phase("abort")
        view.sees("went to abort, as the table says")
        strip = view.page.locator("[data-phase]").first.inner_text().split("\n")
        assert [strip[0], strip[-2], strip[-1]] == ["self test", "approach", "abort"]
        view.picture("fault")

        # Held and aborted by hand, in the dark.
        view.key("l")
        view.choose("times real time", "1/32")
        view.press("next seed")
        view.phase("find", "self_test", "guide")
        view.key("Space")
        view.phase("held_by_operator")
        view.key("Escape")
        view.phase("refused", "abort")
        view.sees("aborted by hand in")
        view.page.set_viewport_size({"width": 420, "height": 640})
        view.picture("narrow")
        assert view.width_overflow() <= 0
        assert view.covered() <= 0
        assert view.errors == []
        view.page.close()
    thrown, held = ([m.do for m in read_script(log)] for log in sorted(logs.glob("*.mcap")))
    assert thrown[0] == "wind"
    assert thrown[1:] == ["fault"]
    assert held[-2:] == ["hold", "abort"]

    with served("replay", str(log_file)) as address:
        view = View(browser, address, 1000, 500, "quick_replay")
        view.phase("self_test")
        view.slider("time").press("End")
        view.phase("done")
        view.slider("time").press("Home")
        view.key("Space")
        view.passed("guide")
        view.picture("played")
        assert view.errors == []
        view.page.close()


@pytest.mark.slow
def test_a_landing_is_started_steered_and_looked_at_again(browser, tmp_path) -> None:
    """Another arm is picked, a landing started, the wind moved, a fault thrown in; the table's action happens; held, aborted."""
    logs = tmp_path / "logs"
    with served("console", "--out", str(logs), "--set", "imperfections.camera=false") as address:
        view = View(browser, address, 1200, 800, "console")
        view.sees("press start")
        view.picture("opened")

        # Another arm; what cannot be flown is said in the page.
        view.tab("next flight")
        arm = view.field("arm (file, name)")
        arm.fill("no_such_arm.urdf")
        view.press("start")
        view.sees("there is no such file")
        arm.fill(str(ROOT / "examples" / "seven_axis.urdf"))
        # Time stands still, so that nothing passes while the browser, which draws in software, is busy.
        view.press("pause")
        view.press("start")
        view.press("10 ticks")
        view.phase("self_test")

        # The wind acts at once.
        view.tab("steer")
        view.slider("wind").press("ArrowRight")
        for _ in range(19):
            view.slider("wind").press("ArrowRight")
        view.picture("wind")

        # A fault is foreseen, thrown in, and the supervisor does what the table says.
        view.tab("faults")
        view.choose("phase", "approach")
        view.sees("in approach the supervisor goes to abort")
        view.press("throw it in")
        view.press("run")
        view.phase("abort")
        view.sees("went to abort, as the table says")
        view.picture("fault")
        view.sees("ended in abort after")
        assert view.errors == []

        # A second viewer watches and cannot steer.
        second = View(browser, address, 600, 400, "second")
        second.sees("ended in abort after")
        second.press("retry")
        second.sees("another page steers: this one is read-only")
        second.page.close()

        # Held by space, let go, aborted by escape, in the dark and in a narrow window.
        view.key("l")
        view.choose("times real time", "1/32")
        view.press("next seed")
        # In wind the mission begins with a UAV that is looked for.
        early = ("find", "self_test", "guide")
        view.phase(*early)
        view.key("Space")
        view.phase("held_by_operator")
        view.picture("held_dark")
        view.key("Space")
        view.phase(*early)
        view.key("Escape")
        view.phase("refused", "abort")
        view.sees("aborted by hand in")
        view.page.set_viewport_size({"width": 480, "height": 900})
        view.picture("narrow")
        assert view.width_overflow() <= 0
        assert view.covered() <= 0
        view.page.set_viewport_size({"width": 1200, "height": 800})
        view.choose("times real time", "as fast as it goes")
        view.sees("the operator aborted it")
        view.page.wait_for_function("document.querySelector('[data-command]').textContent.includes('--operator')")
        view.press("copy the command that does this again")
        view.page.wait_for_function("async () => (await navigator.clipboard.readText()).includes('--operator')")
        copied = view.page.evaluate("navigator.clipboard.readText()")
        assert copied == view.page.locator("[data-command]").inner_text()
        assert view.errors == []
        view.page.close()

    steered = sorted(logs.glob("*.mcap"))
    assert [[m.do for m in read_script(log) if m.do != "wind"] for log in steered] == [
        ["fault"],
        ["hold", "resume", "abort"],
    ]
    assert [m.value for m in read_script(steered[0]) if m.do == "wind"][-1] > 0.0
    assert "seven_axis" in read_log(steered[0]).metadata["arm"]


@pytest.mark.slow
def test_a_replay_is_scrubbed(browser, flown) -> None:
    """A recorded landing is played, scrubbed and jumped through, in light, dark and a narrow window."""
    log, other = (flown[name][0].log for name in ("landing", "takeoff"))
    with served("replay", str(log)) as address:
        view = View(browser, address, 1200, 800, "replay")
        view.phase("self_test")
        view.picture("opened")
        time = view.slider("time")
        time.press("End")
        view.phase("done")
        time.press("Home")
        view.phase("self_test")
        menu = view.page.get_by_label("jump to", exact=True)
        menu.click()
        view.page.get_by_role("option").filter(has_text="phase: carry").first.click()
        view.phase("carry")
        view.picture("carry")
        view.key("Space")
        view.passed("set down")
        view.key("l")
        view.key("Space")
        view.picture("dark")
        view.page.set_viewport_size({"width": 480, "height": 900})
        view.picture("narrow")
        assert view.width_overflow() <= 0
        assert view.covered() <= 0
        assert view.errors == []
        narrow = View(browser, address, 420, 860, "phone")
        narrow.page.locator("canvas").first.wait_for()
        narrow.picture("opened")
        assert narrow.width_overflow() <= 0
        assert narrow.covered() <= 0
        narrow.page.close()
        view.page.close()
    with served("replay", str(log), str(other)) as address:
        view = View(browser, address, 1200, 800, "two")
        view.sees("2: takeoff seed 1")
        view.press("next")
        view.picture("compared")
        assert view.errors == []
        view.page.close()


@pytest.mark.slow
def test_a_wrong_token_is_told_in_words(browser) -> None:
    with served("console", "--host", "0.0.0.0", "--token", "right") as address:
        page = browser.new_page()
        page.goto(address.replace("token=right", "token=wrong"))
        assert "wrong or missing token; open the address that" in page.content()
        page.goto(address)
        page.get_by_text("press start").first.wait_for(timeout=MS)
        page.close()
