"""Pages of the site for files outside of docs/ that its pages link to, so that the site has all that it speaks of."""

import re
from pathlib import Path
from posixpath import dirname, join, normpath, relpath

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files

LINK = re.compile(r"(?<=\]\()((?:\.\./)+[^)#\s]+)(?=[)#])")
LANGUAGES = {".py": "python", ".toml": "toml", ".urdf": "xml", ".xml": "xml", ".md": "markdown"}
NAMED = re.compile(r"\[[\w/.]+\.md\]\(([^)#\s]+\.md)((?:#[^)]*)?)\)")
HOMES = {"README.md": "index.md"}
"""Pages of the repository that have a page of their own on the site."""


def linked(markdown: str, page: str) -> dict[str, str]:
    """Links of a page that lead out of docs/ -> file, from the repository's root."""
    ways = {link: normpath(join("docs", dirname(page), link)) for link in LINK.findall(markdown)}
    return {link: file for link, file in ways.items() if not file.startswith(("docs/", ".."))}


def place(file: str) -> str:
    """Page of the site for a file of the repository."""
    return HOMES.get(file) or f"source/{file}.md"


def redirected(markdown: str, page: str) -> str:
    """The text of a page whose links out of docs/ lead to pages of the site."""
    ways = linked(markdown, page)
    return LINK.sub(lambda m: relpath(place(ways[m[1]]), dirname(page) or ".") if m[1] in ways else m[1], markdown)


def titled(markdown: str, page: Path) -> str:
    """The text of a page in whose links titles stand for names of files, which only readers of the repository look for."""

    def link(match: re.Match[str]) -> str:
        file = page.parent / match[1]
        title = re.match(r"# (.+)", file.read_text("utf-8")) if file.is_file() else None
        return f"[{title[1]}]({match[1]}{match[2]})" if title else match[0]

    return NAMED.sub(link, markdown)


def text_of(name: str, code: str) -> str:
    """A page that shows a file."""
    fence = "`" * (max((len(run) for run in re.findall(r"`{3,}", code)), default=2) + 1)
    language = LANGUAGES.get(Path(name).suffix, "text")
    return f'---\nsearch:\n  exclude: true\n---\n\n# {Path(name).name}\n\n`{name}`\n\n{fence}{language} linenums="1"\n{code}{fence}\n'


def add(files: Files, config: MkDocsConfig) -> None:
    """Add these pages to the site's files; a link to a file that is not there is left to MkDocs, which complains of it."""
    root = Path(config.config_file_path or ".").parent
    pages = [f for f in files.documentation_pages() if not f.src_uri.startswith("source/")]
    wanted = {file for f in pages for file in linked(f.content_string, f.src_uri).values()} - HOMES.keys()
    for name in sorted(wanted):
        if (root / name).is_file():
            files.append(File.generated(config, place(name), content=text_of(name, (root / name).read_text("utf-8"))))
