"""XML of arm files as people write it: byte-order marks, prefixes that nobody declares, xacro that nobody expanded."""

import re
import xml.etree.ElementTree as ET
from pathlib import Path

from armland.errors import ModelError

LARGEST = 50_000_000
"""Bytes of a file; a larger one is no description of a robot."""

PREFIX = re.compile(r"</?([A-Za-z_][\w.-]*):[A-Za-z_]|\s([A-Za-z_][\w.-]*):[A-Za-z_][\w.-]*\s*=")
ROOT = re.compile(r"<[A-Za-z_][\w.:-]*")
ASIDE = re.compile(r"<!--.*?-->|<\?.*?\?>|<!DOCTYPE[^>]*>", re.DOTALL)


def read_root(path: Path, what: str) -> ET.Element:
    """The root element of an XML file.

    Args:
        path: of the file.
        what: its name in messages.

    Raises:
        ModelError: it is missing, too large, no text or not well-formed XML.
    """
    try:
        if path.stat().st_size > LARGEST:
            raise ModelError(f"{what} has {path.stat().st_size} bytes; a description of a robot has at most {LARGEST}")
        raw = path.read_bytes()
    except OSError as e:
        raise ModelError(f"{what} cannot be read: {e.strerror}") from e
    try:
        return ET.fromstring(declared(_decoded(raw)))
    except (ET.ParseError, ValueError) as e:
        raise ModelError(f"{what} is not well-formed XML: {e}") from e


def included(root: ET.Element, path: Path, what: str, depth: int = 0) -> ET.Element:
    """An MJCF's `root` with the files in place that it includes.

    Args:
        root: its `<mujoco>`, changed.
        path: of the file; what it includes stands beside it.
        what: its name in messages.
        depth: of files that include it.

    Raises:
        ModelError: an included file cannot be read, or they include each other.
    """
    if depth > 8:
        raise ModelError(f"{what}: its files include each other more than 8 deep")
    for parent in list(root.iter()):
        for place, child in reversed(list(enumerate(parent))):
            if child.tag == "include":
                name = child.get("file", "")
                inner = included(
                    read_root(path.parent / name, f"{what}: included file {name!r}"), path, what, depth + 1
                )
                parent[place : place + 1] = list(inner)
    return root


def _decoded(raw: bytes) -> str:
    # A byte-order mark decides; else what the first line declares; else UTF-8.
    for mark, name in ((b"\xef\xbb\xbf", "utf-8-sig"), (b"\xff\xfe", "utf-16"), (b"\xfe\xff", "utf-16")):
        if raw.startswith(mark):
            return raw.decode(name)
    found = re.match(rb"\s*<\?xml[^>]*encoding=[\"']([\w.-]+)[\"']", raw)
    try:
        return raw.decode(found.group(1).decode() if found else "utf-8")
    except LookupError as e:
        raise ValueError(str(e)) from e


def declared(text: str) -> str:
    """The text with every prefix declared on its root element, and without the XML declaration."""
    text = re.sub(r"^\s*<\?xml.*?\?>", "", text, count=1, flags=re.DOTALL).lstrip()
    bare = ASIDE.sub("", text)
    used = {a or b for a, b in PREFIX.findall(bare)} - {"xml", "xmlns"}
    missing = sorted(p for p in used if not re.search(rf"xmlns:{re.escape(p)}\s*=", bare))
    root = next((m for m in ROOT.finditer(text) if not _aside(text, m.start())), None)
    if root is None or not missing:
        return text
    names = "".join(f' xmlns:{p}="undeclared:{p}"' for p in missing)
    return text[: root.end()] + names + text[root.end() :]


def _aside(text: str, at: int) -> bool:
    return any(m.start() <= at < m.end() for m in ASIDE.finditer(text))


def refuse_xacro(root: ET.Element, what: str) -> None:
    """Refuse a file of xacro macros that have not been expanded.

    Raises:
        ModelError: says what was found and how it is expanded.
    """
    for element in root.iter():
        space, _, name = element.tag.rpartition("}")
        found = f"<xacro:{name}>" if "xacro" in space else _unexpanded(element) if name in ("link", "joint") else ""
        if found:
            raise ModelError(
                f"{what} is a xacro file that has not been expanded: it holds {found}; expand it with "
                "`xacro FILE.xacro -o arm.urdf` (ROS) or `pip install xacrodoc && xacrodoc FILE.xacro -o arm.urdf`"
            )


def _unexpanded(part: ET.Element) -> str:
    # Meshes are not needed, wherever they are said to be.
    values = (v for e in part.iter() if e.tag not in ("mesh", "texture") for v in e.attrib.values())
    return next((repr(v) for v in values if "${" in v or "$(" in v), "")


def numbers(text: str | None, count: int, default: tuple[float, ...], where: str) -> tuple[float, ...]:
    """`count` finite numbers of an attribute, `default` where it is absent.

    Raises:
        ModelError: something else stands there; `where` names the place.
    """
    if text is None or not text.strip():
        return default
    try:
        found = tuple(float(x) for x in text.replace(",", " ").split())
    except ValueError:
        found = ()
    if len(found) != count or any(x != x or abs(x) == float("inf") for x in found):
        raise ModelError(f"{where} = {text[:60]!r} should be {count} finite number{'s' * (count > 1)}")
    return found


def mesh_file(name: str, path: Path) -> str:
    """Where the file lies that a robot's file at `path` calls `name`; where it should lie if it is nowhere.

    `package://PACKAGE/...` is looked for upwards: beside the folder of the package, in it, and wherever the rest of the name leads to.
    """
    scheme, _, rest = name.rpartition("://")
    if scheme not in ("package", "model"):
        return str(path.parent / rest)
    inner = rest.partition("/")[2]
    for folder in path.resolve().parents:
        for found in (folder / rest, folder / inner):
            if found.is_file():
                return str(found)
    return str(path.parent / inner)
