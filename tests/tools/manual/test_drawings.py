from types import SimpleNamespace

from manual.drawings import inlined

SVG = '<svg viewBox="0 0 9 9"><title>flow</title><style>svg{color:#000}</style><text>a</text></svg>'


def test_drawing_becomes_part_of_the_page_without_its_own_colours(tmp_path) -> None:
    (tmp_path / "images").mkdir()
    (tmp_path / "images" / "flow.svg").write_text(SVG)
    html = '<p><img alt="x" src="../images/flow.svg" /></p><img alt="y" src="../images/a.png" />'
    page, config = SimpleNamespace(url="laws/exact.html"), SimpleNamespace(docs_dir=str(tmp_path))
    assert inlined(html, page, config) == (
        '<p><div class="drawing"><svg viewBox="0 0 9 9"><title>flow</title><text>a</text></svg></div></p>'
        '<img alt="y" src="../images/a.png" />'
    )
