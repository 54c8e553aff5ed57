"""The server of pages: its port, its token, who steers, and pages that hang or send too much."""

import socket
import time
import urllib.error
import urllib.request

import msgspec
import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus

from armland.console.page import server as module
from armland.console.page.gate import LARGEST, READ_ONLY
from armland.console.page.server import PageServer, check_port
from armland.errors import ConfigurationError


def get(address: str, **headers: str) -> tuple[int, str, dict]:
    request = urllib.request.Request(address, headers={k.replace("_", "-"): v for k, v in headers.items()})
    try:
        with urllib.request.urlopen(request, timeout=5) as answer:
            return answer.status, answer.read(400).decode("utf-8", "replace"), dict(answer.headers)
    except urllib.error.HTTPError as e:
        return e.code, e.read().decode(), dict(e.headers)


def test_a_port_in_use_is_refused_with_one_that_may_be_free(server) -> None:
    port = server.viser.get_port()
    with pytest.raises(ConfigurationError, match=f"port {port} of 127.0.0.1 is in use; --port {port + 1} may be free"):
        PageServer("127.0.0.1", port, None, "again")


@pytest.mark.parametrize("host", ["203.0.113.9", "no.such.host.invalid"])
def test_an_address_that_is_not_here_is_refused(host: str) -> None:
    with pytest.raises(ConfigurationError, match=r"--host 127.0.0.1 --port 8080 stays on this machine"):
        check_port(host, 8123)


def test_the_last_port_of_all_names_one_that_there_is() -> None:
    assert "--port 8080" in str(module.in_use("127.0.0.1", 65535))


def test_the_page_is_served_by_the_names_of_this_machine(server) -> None:
    status, text, _ = get(server.address)
    assert status == 200
    assert "<html" in text.lower() or "<!doctype" in text.lower()
    assert get(server.address, Host="evil.example")[0] == 403


def test_beyond_loopback_the_token_is_asked_for(fake_page) -> None:
    made = PageServer("0.0.0.0", 0, "secret", "test")
    try:
        base = made.address.split("/?")[0]
        assert made.address.endswith("/?token=secret")
        assert get(base)[0] == 403
        assert "wrong or missing token" in get(f"{base}/?token=guess")[1]
        status, _, headers = get(made.address)
        assert status == 200
        cookie = headers["Set-Cookie"].split(";")[0]
        assert get(base, Cookie=cookie)[0] == 200
        with pytest.raises(InvalidStatus):
            fake_page(made)
        page = fake_page(made, Cookie=cookie)
        assert made.pages == 1
        page.close()
    finally:
        made.stop()


def test_a_stranger_s_page_gets_no_socket(server, fake_page) -> None:
    with pytest.raises(InvalidStatus):
        fake_page(server, Origin="http://evil.example")
    assert server.pages == 0


def test_the_first_page_steers_and_the_next_when_it_goes(server, fake_page, wait_until) -> None:
    slider = server.viser.gui.add_slider("s", min=0, max=9, step=1, initial_value=0)
    first, second = fake_page(server), fake_page(server)
    second.set(slider, 5)
    assert wait_until(lambda: server.said == [READ_ONLY])
    assert slider.value == 0
    first.set(slider, 3)
    assert wait_until(lambda: slider.value == 3)
    first.close()
    assert wait_until(lambda: server.pages == 1)
    second.set(slider, 7)
    assert wait_until(lambda: slider.value == 7)


def test_a_page_that_was_refused_is_told_what_is(server, fake_page, wait_until) -> None:
    slider = server.viser.gui.add_slider("s", min=0, max=9, step=1, initial_value=4)
    page = fake_page(server)
    page.set(slider, 99)
    assert wait_until(lambda: server.ignored == 1)
    needle, end, seen = slider._impl.uuid.encode(), time.monotonic() + 5.0, b""
    import zstandard

    while time.monotonic() < end and b"GuiUpdateMessage" not in seen:
        frame = page.socket.recv(timeout=5)
        packed = int.from_bytes(frame[8:16], "little")
        seen = zstandard.ZstdDecompressor().decompress(frame[16 : 16 + packed])
    assert needle in seen
    sent = msgspec.msgpack.decode(seen)["messages"]
    assert [m["updates"] for m in sent if m["type"] == "GuiUpdateMessage"] == [{"value": 4}]


def test_a_message_that_is_too_large_closes_its_own_page_alone(server, fake_page, wait_until) -> None:
    good, bad = fake_page(server), fake_page(server)
    bad.socket.send(b"x" * (LARGEST + 1))
    assert wait_until(lambda: server.pages == 1)
    with pytest.raises(ConnectionClosed):
        list(bad.socket)
    good.look()
    assert server.pages == 1


def test_no_more_pages_than_there_is_room_for(server, fake_page, monkeypatch) -> None:
    monkeypatch.setattr(module, "MOST_PAGES", 2)
    fake_page(server)
    fake_page(server)
    with pytest.raises(InvalidStatus, match="503"):
        fake_page(server)


def test_a_page_that_reads_nothing_holds_up_nobody(server, fake_page, wait_until) -> None:
    html = server.viser.gui.add_html("")
    hangs = socket.create_connection(("127.0.0.1", server.viser.get_port()))
    hangs.sendall(b"GET / HTTP/1.1\r\nHost: localhost\r\n")
    fake_page(server)
    begin = time.monotonic()
    for number in range(300):
        html.content = f"{number}" + "x" * 20_000
    # A tenth of a second where nothing else goes on; held up it would be for good.
    assert time.monotonic() - begin < 20.0
    buffered = server.viser._websock_server._broadcast_buffer.message_from_id
    # Of each thing the newest value alone is kept for it.
    assert len(buffered) < 40
    hangs.close()
    assert server.pages == 1


def test_it_is_silent(capfd) -> None:
    made = PageServer("127.0.0.1", 0, None, "quiet")
    made.stop()
    out, err = capfd.readouterr()
    assert (out, err) == ("", "")
