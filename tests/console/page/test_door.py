"""Who is let in: names of this machine, the token, and no pages of strangers."""

import pytest
from websockets import Headers
from websockets.http11 import Request, Response

from armland.console.page.door import COOKIE, Door, is_loopback, token_for


def asked_for(path: str = "/", **headers: str) -> Request:
    return Request(path, Headers({"Host": "localhost:8080", **{k.replace("_", "-"): v for k, v in headers.items()}}))


@pytest.mark.parametrize(
    ("host", "inside"),
    [
        ("127.0.0.1", True),
        ("127.9.9.9", True),
        ("localhost", True),
        ("::1", True),
        ("0.0.0.0", False),
        ("192.168.1.7", False),
        ("::", False),
        ("robot.lab", False),
    ],
)
def test_what_only_this_machine_reaches(host: str, inside: bool) -> None:
    assert is_loopback(host) is inside
    assert (token_for(host, None) is None) is inside
    assert token_for(host, "mine") == "mine"


def test_tokens_are_long_and_never_the_same() -> None:
    one, other = token_for("0.0.0.0", None), token_for("0.0.0.0", None)
    assert one is not None
    assert len(one) >= 20
    assert one != other


@pytest.mark.parametrize("named", ["localhost:8080", "127.0.0.1:8080", "[::1]:8080", "localhost"])
def test_on_loopback_it_is_open_by_its_own_names(named: str) -> None:
    assert Door("127.0.0.1", None).refusal(asked_for(Host=named)) is None


def test_a_stranger_s_name_for_this_machine_is_turned_away() -> None:
    no = Door("127.0.0.1", None).refusal(asked_for(Host="evil.example:8080"))
    assert no is not None
    assert no.status_code == 403
    assert b"not called 'evil.example:8080'; open it as http://localhost" in no.body
    assert Door("127.0.0.1", None).refusal(Request("/", Headers())) is not None


def test_a_page_of_a_stranger_opens_no_socket() -> None:
    door = Door("127.0.0.1", None)
    assert door.refusal(asked_for(Origin="http://localhost:8080", Upgrade="websocket")) is None
    for origin in ("http://evil.example", "http://localhost:9999", "null"):
        no = door.refusal(asked_for(Origin=origin, Upgrade="websocket"))
        assert no is not None
        assert b"may not open this console" in no.body


@pytest.mark.parametrize(
    ("path", "cookie", "inside"),
    [
        ("/?token=secret", "", True),
        ("/x.js", f"{COOKIE}=secret", True),
        ("/x.js", f"other=1; {COOKIE}=secret", True),
        ("/", "", False),
        ("/?token=", "", False),
        ("/?token=wrong", "", False),
        ("/?token=wrong", f"{COOKIE}=wrong", False),
        ("/?token=sécret", "", False),
        ("/", f"{COOKIE}=", False),
        ("/", 'broken="; =;;', False),
    ],
)
def test_elsewhere_the_token_opens(path: str, cookie: str, inside: bool) -> None:
    no = Door("0.0.0.0", "secret").refusal(asked_for(path, Cookie=cookie, Host="robot.lab:8080"))
    assert (no is None) is inside
    if no is not None:
        assert b"wrong or missing token; open the address that" in no.body


def test_the_cookie_is_given_to_who_brought_the_token_alone() -> None:
    door = Door("0.0.0.0", "secret")
    given = door.admit(asked_for("/?token=secret"), Response(200, "OK", Headers(), b""))
    assert given.headers["Set-Cookie"] == f"{COOKIE}=secret; HttpOnly; SameSite=Strict; Path=/"
    assert "Set-Cookie" not in door.admit(asked_for("/"), Response(200, "OK", Headers(), b"")).headers
    assert (
        "Set-Cookie" not in Door("::1", None).admit(asked_for("/?token=x"), Response(200, "OK", Headers(), b"")).headers
    )
