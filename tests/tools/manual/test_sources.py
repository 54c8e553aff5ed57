from pathlib import Path

from manual.sources import linked, place, redirected, text_of, titled

TEXT = "see [act.py](../../src/armland/mission/act.py#L3), [faults](../faults.md), [Home](../../README.md), [x](../../../y.py)"


def test_links_out_of_the_documents_are_found() -> None:
    assert linked(TEXT, "laws/exact.md") == {
        "../../src/armland/mission/act.py": "src/armland/mission/act.py",
        "../../README.md": "README.md",
    }


def test_they_lead_to_pages_of_the_site_and_the_others_stay() -> None:
    assert redirected(TEXT, "laws/exact.md") == (
        "see [act.py](../source/src/armland/mission/act.py.md#L3), [faults](../faults.md), [Home](../index.md), [x](../../../y.py)"
    )
    assert redirected("[a](../examples/a.py)", "own_law.md") == "[a](source/examples/a.py.md)"


def test_page_of_a_source_has_all_of_it() -> None:
    page = text_of("src/a.py", 'x = """\n```python\n```\n"""\n')
    assert "# a.py\n\n`src/a.py`\n" in page
    assert '````python linenums="1"\nx = """\n```python\n```\n"""\n````\n' in page
    assert place("src/a.py") == "source/src/a.py.md"


def test_titles_stand_for_names_of_files(tmp_path: Path) -> None:
    (tmp_path / "faults.md").write_text("# Faults, one by one\n\ntext\n")
    text = "[faults.md](faults.md#ends), [the faults](faults.md), [gone.md](gone.md)"
    shown = "[Faults, one by one](faults.md#ends), [the faults](faults.md), [gone.md](gone.md)"
    assert titled(text, tmp_path / "air.md") == shown
