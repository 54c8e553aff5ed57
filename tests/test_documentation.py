"""What the documents show is run, and what they name is there."""

import importlib.util
import pkgutil
import re
import shlex
import signal
import subprocess
import sys
from functools import reduce
from itertools import pairwise
from pathlib import Path

import pytest
import typer
from typer.exceptions import TyperException
from typer.main import get_command

from armland.cli.app import app
from armland.cli.options import load
from armland.errors import ArmlandError
from armland.experiments.campaign.description import read_description
from armland.experiments.judge import judgement
from armland.mission import registry
from armland.mission.supervisor.remedies import REMEDIES
from armland.records import MESSAGES
from armland.scenario import Scenario, load_scenario

ROOT = Path(__file__).parents[1]
PACKAGE = ROOT / "src" / "armland"
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]


BLOCK = re.compile(r"```(\w+)\n(.*?)```", re.DOTALL)
SHOWN = ("README.md", "examples", "tests")
"""What of the repository commands and snippets name."""


def blocks(page: Path) -> list[tuple[str, str]]:
    """Language and text of each block of a page, in their order."""
    return BLOCK.findall(page.read_text("utf-8"))


def of_pages(language: str) -> list:
    """Each page that has blocks of a language, as a test's parameter."""
    return [pytest.param(p, id=p.relative_to(ROOT).as_posix()) for p in PAGES if language in dict(blocks(p))]


@pytest.fixture
def workplace(tmp_path, monkeypatch) -> Path:
    """A folder in which a reader of the documents could be; what snippets add to armland is gone afterwards."""
    for name in SHOWN:
        (tmp_path / name).symlink_to(ROOT / name)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(registry, "MISSIONS", dict(registry.MISSIONS))
    monkeypatch.setattr(judgement, "KINDS", dict(judgement.KINDS))
    return tmp_path


def run_snippet(code: str) -> None:
    namespace: dict[str, object] = {}
    exec(code, namespace)
    assert len(namespace) > 1


@pytest.mark.parametrize("page", of_pages("python"))
def test_snippets_run(page: Path, workplace) -> None:
    for language, code in blocks(page):
        # What reads a command's results is run behind that command, by the slow test below.
        if language == "python" and "out/" not in code:
            run_snippet(code)


@pytest.mark.parametrize("page", ["README.md", "python.md", "own_law.md", "own_mission.md", "logs.md", "start.md"])
def test_page_has_a_snippet(page: str) -> None:
    assert page in {parameter.values[0].name for parameter in of_pages("python")}


def command_lines(shell: str) -> list[str]:
    """Commands of armland in a block for a shell; `make run` is one."""
    lines = [call.strip() for line in shell.splitlines() for call in line.partition("  #")[0].split(";")]
    return [line.replace("make run", "armland land") for line in lines if line.startswith(("armland ", "make run"))]


def briefly(call: str) -> list[str]:
    """Its arguments, with two flights where it asks for a campaign: that they are many is tested elsewhere."""
    return shlex.split(re.sub(r"(--seeds|--spread|--runs) \d+", r"\1 2", call))[1:]


def written(shell: str) -> list[tuple[str, str]]:
    """Name and text of each file that a block for a shell writes."""
    return re.findall(r"^cat > (\S+) <<'END'\n(.*?)^END$", shell, re.DOTALL | re.MULTILINE)


def serve(call: str) -> None:
    """Run a command that serves a page until somebody ends it; end it when it has said where the page is."""
    command = [sys.executable, "-m", "armland", *briefly(call), "--no-browser", "--port", "0"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True) as run:
        line = run.stdout.readline()
        run.send_signal(signal.SIGINT)
        assert "http://localhost:" in line, call
        assert run.wait(timeout=60) in (0, 130)


def says(text: str, output: str) -> bool:
    """Whether the output holds what the page shows of it, however it is wrapped; `...` stands for what is left out."""
    shown = r"\s+".join(map(re.escape, text.split())).replace(re.escape("..."), ".*?")
    return re.search(shown, output, re.DOTALL) is not None


@pytest.mark.slow
@pytest.mark.parametrize("page", of_pages("sh"))
def test_page_does_what_it_says(page: Path, workplace, armland) -> None:
    output = ""
    for (language, text), (following, _) in pairwise([*blocks(page), ("", "")]):
        if language == "python":
            run_snippet(text)
        if language == "sh":
            output = ""
            for name, content in written(text):
                (workplace / name).write_text(content, encoding="utf-8")
            for call in command_lines(text):
                if call.startswith(("armland console", "armland replay")):
                    serve(call)
                    continue
                if "--ray" in call and importlib.util.find_spec("ray") is None:
                    continue
                done = armland(*briefly(call))
                assert done.code in (0, 1) or (following == "text" and done.code == 2), f"{call}\n{done.err}"
                # Progress and notes come before the verdict.
                output += done.err + done.out
        if language == "text" and output:
            assert says(text, output), output


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("ended in abort after miss", True),
        ("ended in ... after miss: camera_stale", True),
        ("it is [3, 4] m", True),
        ("ended in refused", False),
        ("camera_stale ... ended", False),
    ],
)
def test_what_a_page_shows_of_an_output_is_looked_for(text: str, found: bool) -> None:
    assert says(text, "failure: ended in abort\n   after miss: camera_stale, it is [3, 4] m") == found


def test_campaigns_of_pages_are_flown_briefly() -> None:
    assert command_lines("make run  # so\narmland land --seeds 200; armland log x\nsource y") == [
        "armland land",
        "armland land --seeds 200",
        "armland log x",
    ]
    assert briefly("armland land --seed 90001 --seeds 1000 --set 'a=[1, 2]'") == [
        *("land", "--seed", "90001", "--seeds", "2", "--set", "a=[1, 2]"),
    ]
    assert briefly("armland campaign a.toml --runs 50 --resume") == ["campaign", "a.toml", "--runs", "2", "--resume"]


def test_files_that_a_block_writes_are_found() -> None:
    block = "cat > a.jsonl <<'END'\n{1}\n{2}\nEND\narmland run landing --operator a.jsonl\n"
    assert written(block) == [("a.jsonl", "{1}\n{2}\n")]
    assert command_lines(block) == ["armland run landing --operator a.jsonl"]


def test_every_end_of_a_mission_has_its_cause_and_remedy() -> None:
    text = (ROOT / "docs" / "troubleshooting.md").read_text("utf-8")
    heads = "".join(re.findall(r"^### .*$", text, re.MULTILINE))
    assert [fault for fault in REMEDIES if f"`{fault}`" not in heads] == []
    told = re.findall(r"^\| `([^`]+)` \|.*\|.*\|.*\|$", text, re.MULTILINE)
    missions = [*registry.MISSIONS.values(), *registry.UNAIDED.values()]
    said = {why for mission in missions for why in mission.timeouts.values()}
    assert len(said) > 20
    assert [why for why in sorted(said) if not why.startswith(tuple(told))] == []


TARGETS = re.findall(r"^(\w+):.*## ", (ROOT / "Makefile").read_text("utf-8"), re.MULTILINE)


@pytest.mark.parametrize("page", PAGES, ids=lambda p: p.relative_to(ROOT).as_posix())
def test_targets_of_make_are_there(page: Path) -> None:
    shells = "\n".join(text for language, text in blocks(page) if language == "sh")
    lines = [*spans(page.read_text("utf-8")), *shells.splitlines()]
    assert {line.split()[1] for line in lines if line.startswith("make ")} <= {*TARGETS, "TARGET"}


@pytest.mark.parametrize("page", of_pages("toml"))
def test_files_of_pages_are_read(page: Path, workplace, armland) -> None:
    # A stand-in for the file of another package that the UAV's page completes; it, too, is driven as a whole.
    (workplace / "cf2.xml").symlink_to(ROOT / "tests" / "data" / "uavs" / "whole.xml")
    for language, text in blocks(page):
        if language == "toml":
            (workplace / "own.toml").write_text(text, encoding="utf-8")
            if "base =" in text:
                assert load_scenario(workplace / "own.toml").title
            elif "[parameters]" in text:
                assert read_description(workplace / "own.toml").parameters
            else:
                assert armland("uav", "own.toml").code == 0


def spans(text: str) -> list[str]:
    """What stands between backticks, blocks left out."""
    return re.findall(r"`([^`\n]+)`", re.sub(r"```.*?```", "", text, flags=re.DOTALL))


def calls(text: str) -> list[str]:
    """Every command line of `armland` in a page: in blocks, indented, between backticks."""
    # What a page lets be refused, it shows with the refusal behind it.
    plain = re.sub(r"```sh\n[^`]*```\n+```text", "", text)
    shown = [
        *re.findall(r"```sh\n(.*?)```", plain, re.DOTALL),
        *re.findall(r"^    .*$", text, re.MULTILINE),
        *spans(text),
    ]
    lines = [
        call.strip() for part in shown for line in part.splitlines() for call in line.partition("  #")[0].split(";")
    ]
    return [line for line in lines if line.startswith("armland ")]


def refusal(call: str) -> str | None:
    """Why the command line is none that `armland` takes; None if it is."""
    words = shlex.split(re.sub(r"\[(-[^]]*|[A-Z]+)]", r"\1", call))[1:]
    if words[0] in {name for p in get_command(app).params for name in p.opts} | {"--help"}:
        return None
    command = get_command(app).commands.get(words[0])  # type: ignore[attr-defined]
    if command is None:
        return f"no command {words[0]}"
    if parts := getattr(command, "commands", None):
        # `armland campaign FILE` is `armland campaign fly FILE`.
        words = words[1:] if words[1:2] and words[1] in parts else ["fly", *words[1:]]
        command = parts[words[0]]
    try:
        given = command.make_parser(typer.Context(command)).parse_args(words[1:])[0]
        if (mission := given.get("mission") or "NAME") not in ("NAME", "MISSION"):
            registry.mission_named(mission)
        load("landing", {"settings": given.get("settings")})
    except (TyperException, ArmlandError) as e:
        return str(e)
    files = [w.partition(":")[0] for w in words if w.startswith("examples/")]
    return next((f"no file {f}" for f in files if not (ROOT / f).is_file()), None)


@pytest.mark.parametrize("page", PAGES, ids=lambda p: p.relative_to(ROOT).as_posix())
def test_commands_exist_with_their_options(page: Path) -> None:
    assert {c: why for c in calls(page.read_text("utf-8")) if (why := refusal(c))} == {}


def test_examples_in_the_help_exist_with_their_options() -> None:
    groups = [group.typer_instance.registered_commands for group in app.registered_groups]
    commands = [*app.registered_commands, *(command for group in groups for command in group)]
    shown = [c for command in commands for c in calls(command.epilog or "")]
    assert len(shown) > 10
    assert {c: why for c in shown if (why := refusal(c.partition(" | ")[0]))} == {}


@pytest.mark.parametrize(
    "call",
    [
        "armland lands",
        "armland land --sed 7",
        "armland land --seed",
        "armland run hovering",
        "armland campaign examples/wind_study.toml --flights 5",
        "armland campaign examples/no_study.toml",
        "armland campaign replay out/campaign/study.sqlite 3 --resume",
        "armland land --set place.catched_m='[0.6, 0.0, 0.86]'",
        "armland land --law examples/no_law.py:my_law",
    ],
)
def test_command_that_is_none_is_found(call: str) -> None:
    assert calls(f"Try `{call}`, or\n\n    {call}  # so\n") == [call, call]
    assert refusal(call)


CODE = {f: re.sub(r'"""(.|\n)*?"""|#.*', "", f.read_text("utf-8")) for f in PACKAGE.rglob("*.py") if f.stem != "former"}
SETTINGS = {f: f.read_text("utf-8") for f in PACKAGE.rglob("*.toml")}
SHARED = ("records.py", "scenario/", "scenarios/", "mission/missions/")
"""What every page may speak of; a law's page otherwise of what stands in the files that it links to."""
PATH = re.compile(r"[\w.-]+(/[\w.-]+)*(/|\.(py|toml|md|xml|urdf|cff|lock|yml))")
NAME = re.compile(r"\.?([A-Za-z_]\w*(?:\.[A-Za-z_]\w*)*)(?:\(.*\)| = .*)?")
FOREIGN = {"pandas", "episode", "comparison", "venv", "Makefile", "PIP_INDEX_URL", "MUJOCO_GL"}
"""Of another package or tool, a variable of a snippet, a file that a command writes."""


def code_of(page: Path, text: str) -> str:
    """The code that a page is about, comments and docstrings left out."""
    linked = {(page.parent / link).resolve() for link in re.findall(r"\]\(([^)\s]+\.py)\)", text)}
    about = {f: code for f, code in CODE.items() if f in linked}
    about |= {f: c for f, c in (CODE | SETTINGS).items() if f.relative_to(PACKAGE).as_posix().startswith(SHARED)}
    narrow = page.parent.name == "laws" and linked & CODE.keys()
    tests = " ".join(f.read_text("utf-8") for f in linked if "tests" in f.parts and f.is_file())
    snippets = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    return " ".join([*(about if narrow else CODE | SETTINGS).values(), *snippets, tests])


def is_there(name: str, scenario: Scenario) -> bool:
    """Whether a dotted name is a field of a message, a key of the scenario, or a name of the package."""
    first, _, rest = name.partition(".")
    if rest in {field.name for field in MESSAGES.get(first, ())}:
        return True
    try:
        reduce(getattr, name.split("."), scenario)
    except AttributeError:
        try:
            pkgutil.resolve_name(name if first == "armland" else f"armland.{name}")
        except (ImportError, AttributeError):
            return False
    return True


def stale(page: Path, text: str) -> list[str]:
    """Files and names of the package in a page that are not there, and links that say another file than they lead to."""
    code, scenario, found = code_of(page, text), load_scenario("compare"), []
    for span in dict.fromkeys(spans(text)):
        path, name = PATH.fullmatch(span), NAME.fullmatch(re.sub(r"^python -m (\S+).*", r"\1", span))
        if path and "NAME" not in span:
            known = any(
                (place / span).exists() for place in (ROOT, *(PACKAGE / f for f in ("", "scenarios", "assets")))
            )
        elif name and not path and name[1].split(".")[0] not in FOREIGN:
            # A unit, such as `_nm`, ends a name.
            start = "" if span.startswith("_") else r"\b"
            written = re.search(rf"{start}{re.escape(name[1])}\b", code)
            known = written is not None or ("." in name[1] and is_there(name[1], scenario))
        else:
            known = True
        found += [] if known else [span]
    links = re.findall(r"\[`?([^]`]+)`?]\(([^)#]+)\)", text)
    return found + [f"{said} -> {to}" for said, to in links if PATH.fullmatch(said) and f"/{said}" not in f"/{to}"]


@pytest.mark.parametrize("page", PAGES, ids=lambda p: p.relative_to(ROOT).as_posix())
def test_page_names_what_is_there(page: Path) -> None:
    assert stale(page, page.read_text("utf-8")) == []


@pytest.mark.parametrize(
    "text",
    [
        "see `mission/acts.py`",
        "see `plant/device/`",
        "see `armland.mission.act.acts`",
        "see `mission.table.mission.Missions`",
        "told by `armland.flies(scenario)`",
        "made by `python -m armland.view.pages.mission docs`",
        "bounded by `place.catched_m`",
        "as `truth.hinge_forces` says",
        "what `observe_disturbances` keeps",
        "pages in [missions/](landing.md)",
    ],
)
def test_name_that_is_not_there_is_found(text: str) -> None:
    assert len(stale(ROOT / "docs" / "made_up.md", text)) == 1
