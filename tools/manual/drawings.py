"""Drawings as part of the page, so that they take the colours of its theme and their words can be searched and read aloud."""

import re
from pathlib import Path
from posixpath import dirname, join, normpath

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File

IMAGE = re.compile(r'<img alt="([^"]*)" src="([^"]+\.svg)"[^>]*/?>')
STYLE = re.compile(r"<style>.*?</style>", re.DOTALL)


def inlined(html: str, page: File, config: MkDocsConfig) -> str:
    """The HTML of a page with its drawings in place of links to them."""

    def drawing(match: re.Match[str]) -> str:
        file = Path(config.docs_dir) / normpath(join(dirname(page.url), match[2]))
        svg = STYLE.sub("", file.read_text("utf-8"))
        return f'<div class="drawing">{svg}</div>'

    return IMAGE.sub(drawing, html)
