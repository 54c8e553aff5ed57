"""Builds the documentation site; `make site` runs it. A warning is an error."""

import os
import sys
import webbrowser
from pathlib import Path

ROOT = Path(__file__).parents[2]


def build(place: Path) -> None:
    """Build the site into a folder.

    Raises:
        mkdocs.exceptions.Abort: a page or a link that is wrong.
    """
    # What the theme's makers say of their plans is no warning about these pages.
    os.environ["NO_MKDOCS_2_WARNING"] = "1"
    from mkdocs.commands.build import build as built
    from mkdocs.config import load_config

    built(load_config(str(ROOT / "mkdocs.yml"), strict=True, site_dir=str(place)))


if __name__ == "__main__":
    site = ROOT / "build" / "site"
    build(site)
    print(f"The site is in {site.relative_to(ROOT)}/; open {site.relative_to(ROOT)}/index.html")
    if "--open" in sys.argv:
        webbrowser.open((site / "index.html").as_uri())
