"""Formulas as MathML and symbols in running text, which browsers set by themselves: no script, no font from elsewhere."""

import re
from html import escape
from typing import Any

from latex2mathml.converter import convert

NUMBER = re.compile(r"\\tag\{([^}]*)\}")
SYMBOL = re.compile(r"(?<![A-Za-z0-9_])(Δ?[^\W\d_][\u0300-\u036f]*)_([A-Za-z]{1,5}|[Α-Ωα-ω]|[0-9])(?![A-Za-z0-9_])")
"""A letter and its index, as in F_EE, as the pages write it where they are read as text."""
SPELT = {"{aligned}": "{split}", r"\mathcal J": "𝒥", r"\mathcal{J}": "𝒥"}
"""The converter knows this alignment by another name; browsers set no script letters but those that are characters."""
TAG = re.compile(r"(<[^>]*>)")
LITERAL = ("code", "pre", "math", "svg", "script", "style")
"""Elements whose text stays as it is."""


def block(source: str, *_: Any, **__: Any) -> str:
    r"""HTML of a block of LaTeX, as `pymdownx.superfences` calls for it; a `\tag{29}` becomes the number at the right margin."""
    numbers = "".join(f'<span class="number">({escape(number)})</span>' for number in NUMBER.findall(source))
    bare = NUMBER.sub("", source).strip()
    for said, known in SPELT.items():
        bare = bare.replace(said, known)
    formula = convert(bare, display="block")
    return f'<div class="formula">{formula}{numbers}</div>'


def indexed(html: str) -> str:
    """HTML in whose running text a symbol's index stands below the line."""
    shown, depth = [], 0
    for part in TAG.split(html):
        if name := re.match(r"</?(\w+)", part):
            depth += (name[1] in LITERAL) * (-1 if part.startswith("</") else not part.endswith("/>"))
        elif not depth:
            part = SYMBOL.sub(r"\1<sub>\2</sub>", part)
        shown.append(part)
    return "".join(shown)
