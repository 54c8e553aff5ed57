"""The picture of `docs/report.md`: `PYTHONPATH=tools python -m pages.reports` flies a landing and photographs its report.

Needs Chromium (Debian: `apt-get install chromium`) and Playwright's Python package.
"""

import io
import shutil
from pathlib import Path
from tempfile import TemporaryDirectory

from PIL import Image
from playwright.sync_api import sync_playwright

from armland.view.report import result_of, write_report
from pages.films import IMAGES, taken

HEIGHT_PX = 1560
"""Of the page that is shown: verdict, figures, command, film strip, phases."""


def main() -> None:
    """Photograph the upper part of the page, in light and dark side by side."""
    with TemporaryDirectory() as folder, sync_playwright() as playwright:
        log = taken("film_landing", Path(folder)).log
        page = write_report(Path(folder), [log], result_of([log]))
        browser = playwright.chromium.launch(
            executable_path=shutil.which("chromium"), args=["--no-sandbox", "--disable-gpu"]
        )
        halves = []
        for scheme in ("light", "dark"):
            window = browser.new_page(color_scheme=scheme, viewport={"width": 1100, "height": HEIGHT_PX})  # type: ignore[arg-type]
            window.goto(page.as_uri())
            halves.append(Image.open(io.BytesIO(window.screenshot())).convert("RGB").resize((660, 936)))
        browser.close()
    both = Image.new("RGB", (1320, 936))
    for i, half in enumerate(halves):
        both.paste(half, (660 * i, 0))
    both.save(IMAGES / "report.jpg", quality=85, optimize=True)


if __name__ == "__main__":
    main()
