"""Who may open a page: the token, the names by which the machine is called, and no pages of strangers.

| bound to | asks for |
|---|---|
| loopback | that the page was asked for by a name of this machine: a site of a stranger that points its own name here is turned away |
| anything else | the token, in the address (`?token=...`) once, in a cookie from then on |

In both cases a web socket is opened only to pages that came from here: browsers say from where they come.
"""

import hmac
import ipaddress
import secrets
from http import HTTPStatus
from http.cookies import CookieError, SimpleCookie
from urllib.parse import parse_qs, urlsplit

from websockets import Headers
from websockets.http11 import Request, Response

COOKIE = "armland_token"

LOOPBACK_NAMES = ("localhost", "127.0.0.1", "[::1]")


class Door:
    """What lets requests in, or says why not.

    Args:
        host: address that the server is bound to.
        token: that pages have to know; None where none is asked for.
    """

    def __init__(self, host: str, token: str | None) -> None:
        self.host, self.token = host, token

    def refusal(self, request: Request) -> Response | None:
        """The answer to a request that is turned away; None for one that may come in."""
        named = request.headers.get("Host", "")
        if self.token is None and _name(named) not in (*LOOPBACK_NAMES, self.host):
            return _answer(
                HTTPStatus.FORBIDDEN, f"this console is not called {named[:80]!r}; open it as http://localhost"
            )
        origin = request.headers.get("Origin")
        if origin is not None and urlsplit(origin).netloc != named:
            return _answer(HTTPStatus.FORBIDDEN, f"a page of {origin[:80]!r} may not open this console")
        if self.token is not None and not self._knows(request):
            return _answer(
                HTTPStatus.FORBIDDEN,
                "wrong or missing token; open the address that `armland` printed, which ends in ?token=...",
            )
        return None

    def admit(self, request: Request, answer: Response) -> Response:
        """The answer to a request that came in, with the cookie by which the page knows the token from now on."""
        if self.token is not None and parse_qs(urlsplit(request.path).query).get("token"):
            answer.headers["Set-Cookie"] = f"{COOKIE}={self.token}; HttpOnly; SameSite=Strict; Path=/"
        return answer

    def _knows(self, request: Request) -> bool:
        told = parse_qs(urlsplit(request.path).query).get("token", [])
        try:
            cookie = SimpleCookie(request.headers.get("Cookie", ""))
            told += [cookie[COOKIE].value] if COOKIE in cookie else []
        except CookieError:
            pass
        assert self.token is not None
        return any(hmac.compare_digest(t.encode(), self.token.encode()) for t in told)


def token_for(host: str, asked: str | None) -> str | None:
    """The token of a server bound to `host`: what was `asked` for, a new one beyond loopback, none on it."""
    if asked is not None:
        return asked
    return None if is_loopback(host) else secrets.token_urlsafe(16)


def is_loopback(host: str) -> bool:
    """Whether only this machine reaches `host`."""
    if host == "localhost":
        return True
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


def _name(named: str) -> str:
    # Of a host with its port the host.
    return named if named.endswith("]") else named.rpartition(":")[0] or named


def _answer(status: HTTPStatus, text: str) -> Response:
    body = f"armland: {text}\n".encode()
    headers = Headers({"Content-Type": "text/plain; charset=utf-8", "Content-Length": str(len(body))})
    return Response(status.value, status.phrase, headers, body)
