"""What MkDocs is told beyond `mkdocs.yml`: formulas, pages of sources that are linked to, drawings in the theme's colours."""

from pathlib import Path
from posixpath import dirname, relpath
from typing import Any

import drawings
import formulas
import package
import sources
from mkdocs.config.defaults import MkDocsConfig
from mkdocs.plugins import event_priority
from mkdocs.structure.files import Files
from mkdocs.structure.pages import Page


# Before the plugin of the API reference reads where it finds the sources.
@event_priority(100)
def on_config(config: MkDocsConfig) -> None:
    """Set the blocks of LaTeX as formulas, and lead the API reference to sources that its reader takes."""
    root = Path(config.config_file_path).parent
    place = package.regular(root / "src" / "armland", root / "build" / "package")
    config.plugins["mkdocstrings"].config.handlers["python"]["paths"] = [str(place)]
    fences = config.mdx_configs.setdefault("pymdownx.superfences", {}).setdefault("custom_fences", [])
    fences.append({"name": "math", "class": "formula", "format": formulas.block})


def on_files(files: Files, config: MkDocsConfig) -> None:
    """Add a page for each file outside of docs/ to which a page links."""
    sources.add(files, config)


def on_page_markdown(markdown: str, page: Page, config: MkDocsConfig, **_: Any) -> str:
    """Let links out of docs/ lead to those pages, and links that say a file's name say its title."""
    return sources.titled(sources.redirected(markdown, page.file.src_uri), Path(config.docs_dir) / page.file.src_uri)


def on_page_content(html: str, config: MkDocsConfig, page: Page, **_: Any) -> str:
    """Take drawings into the page, and set the indices of symbols below the line."""
    return formulas.indexed(drawings.inlined(html, page.file, config))


def on_post_page(output: str, page: Page, **_: Any) -> str:
    """Finish a page."""
    return finished(output, relpath("page.js", dirname(page.url) or "."))


def on_post_template(output_content: str, **_: Any) -> str:
    """Finish what is no page, as the one that says that there is none."""
    return finished(output_content, "page.js")


def finished(html: str, script: str) -> str:
    """The script of the search comes from the site itself; the search has a name for those who hear the page."""
    here = html.replace("https://unpkg.com/iframe-worker/shim", script)
    return here.replace(
        'data-md-component="search" role="dialog"', 'data-md-component="search" role="dialog" aria-label="Search"'
    )
