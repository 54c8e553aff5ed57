"""The command with its button: what is shown is what is copied, and nothing of it is taken for HTML."""

from html.parser import HTMLParser

from armland.console.page.copying import LABEL, command_html


class Read(HTMLParser):
    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags, self.words = [], {}
        self.feed(text)

    def handle_starttag(self, tag, attributes) -> None:
        self.tags.append((tag, dict(attributes)))

    def handle_data(self, data) -> None:
        self.words[self.tags[-1][0]] = self.words.get(self.tags[-1][0], "") + data


def test_a_button_stands_before_the_command_that_it_copies() -> None:
    page = Read(command_html("armland run landing --set 'x=\"<b>\"'"))
    assert [tag for tag, _ in page.tags] == ["div", "div", "button", "code"]
    button, code = page.tags[2][1], page.tags[3][1]
    assert page.words["button"] == button["data-label"] == LABEL
    assert page.words["code"] == code["title"] == "armland run landing --set 'x=\"<b>\"'"
    assert "nextElementSibling.textContent" in button["onclick"]
    assert "stopPropagation" in button["onkeydown"]


def test_a_note_is_not_copied() -> None:
    page = Read(command_html("armland land", "when the log is whole <soon>"))
    assert page.words["code"] == "armland land"
    assert page.words["div"] == "when the log is whole <soon>"
