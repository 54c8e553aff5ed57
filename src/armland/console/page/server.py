"""The server of a page: viser's, behind a door and a gate, on the one port that was asked for.

The first page that opens steers; when it goes, the one that has been open longest does. A page that hangs holds up nobody: what
waits for it is kept once, the newest value of each thing.
"""

import asyncio
import contextlib
import errno
import io
import logging
import socket
from collections.abc import Awaitable, Callable, Iterator
from typing import Any

import rich
import viser
import websockets.asyncio.server as socket_server
from viser import _messages as messages
from websockets import Headers
from websockets.asyncio.server import ServerConnection
from websockets.http11 import Request, Response

from armland.console.page.door import Door
from armland.console.page.gate import LARGEST, READ_ONLY, decoded, objection
from armland.errors import ConfigurationError

MOST_PAGES = 16

Refused = Callable[[str], None]


class PageServer:
    """A page that is served.

    Args:
        host: address to bind to.
        port: 0 for any that is free.
        token: that pages have to know; None where none is asked for.
        title: of the panel.
        refused: called with what was wrong, where a page sent something that is ignored.

    Raises:
        ConfigurationError: the port is in use, or the address is none of this machine.
    """

    def __init__(self, host: str, port: int, token: str | None, title: str, refused: Refused | None = None) -> None:
        self._pages: list[ServerConnection] = []
        self._door, self._refused = Door(host, token), refused or (lambda _: None)
        self.ignored = 0
        """Messages of pages that were ignored."""
        check_port(host, port)
        logging.getLogger("websockets.server").setLevel(logging.CRITICAL)
        with self._serving(), _silent():
            self.viser = viser.ViserServer(host, port, label=title, verbose=False)
        if port and self.viser.get_port() != port:
            self.stop()
            raise in_use(host, port)
        self.viser.on_client_connect(self._greet)
        shown = "localhost" if host in ("127.0.0.1", "0.0.0.0", "::") else f"[{host}]" if ":" in host else host
        query = "" if token is None else f"/?token={token}"
        self.address = f"http://{shown}:{self.viser.get_port()}{query}"
        """Where the page is."""

    @property
    def pages(self) -> int:
        """How many pages are open."""
        return len(self._pages)

    def stop(self) -> None:
        """Close all pages."""
        with _silent():
            self.viser.stop()

    @contextlib.contextmanager
    def _serving(self) -> Iterator[None]:
        # viser offers no hook before a request or a message: it gets its server from here while it starts.
        original = socket_server.serve

        def serve(handler: Callable[[ServerConnection], Awaitable[None]], *args: Any, **more: Any) -> Any:
            inner = more["process_request"]

            def let_in(connection: ServerConnection, request: Request) -> Response | None:
                if (no := self._door.refusal(request)) is not None:
                    return no
                if request.headers.get("Upgrade") == "websocket":
                    return None if len(self._pages) < MOST_PAGES else _full()
                return self._door.admit(request, inner(connection, request))

            async def watched(connection: ServerConnection) -> None:
                await self._watch(connection, handler)

            return original(watched, *args, **{**more, "process_request": let_in, "max_size": LARGEST})

        socket_server.serve = serve  # type: ignore[assignment,misc]
        try:
            yield
        finally:
            socket_server.serve = original  # type: ignore[misc]

    def _greet(self, client: viser.ClientHandle) -> None:
        if len(self._pages) > 1:
            client.add_notification("Read-only", "Another page steers; this one watches.", auto_close_seconds=10.0)

    async def _watch(
        self, connection: ServerConnection, handler: Callable[[ServerConnection], Awaitable[None]]
    ) -> None:
        self._pages.append(connection)
        original = connection.recv

        async def checked(*args: Any, **more: Any) -> Any:
            while True:
                raw = await original(*args, **more)
                if self._let_in(raw, connection):
                    return raw
                # A flood of nonsense must leave the loop its turn.
                await asyncio.sleep(0)

        connection.recv = checked  # type: ignore[method-assign]
        try:
            await handler(connection)
        finally:
            self._pages.remove(connection)

    def _let_in(self, raw: Any, connection: ServerConnection) -> bool:
        message = decoded(raw)
        no = (
            message
            if isinstance(message, str)
            else objection(message, self.viser.gui, bool(self._pages) and connection is self._pages[0])
        )
        if no is None:
            return True
        self.ignored += 1
        self._put_back(message)
        self._refused(no if no == READ_ONLY else f"a page sent {no}; it was ignored")
        return False

    def _put_back(self, message: Any) -> None:
        # The page shows what it asked for: it is told what is.
        if isinstance(message, messages.GuiUpdateMessage) and isinstance(message.uuid, str):
            handle = self.viser.gui._gui_input_handle_from_uuid.get(message.uuid)
            if handle is not None and hasattr(handle, "value"):
                now = messages.GuiUpdateMessage(message.uuid, {"value": handle.value})
                self.viser._websock_server.queue_message(now)


def check_port(host: str, port: int) -> None:
    """Refuse a port on which somebody listens, or an address that is none of this machine.

    Raises:
        ConfigurationError: the port, and what would have worked.
    """
    try:
        family = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0][0]
        with socket.socket(family, socket.SOCK_STREAM) as probe:
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            probe.bind((host, port))
    except (OSError, OverflowError) as e:
        if isinstance(e, OSError) and e.errno == errno.EADDRINUSE:
            raise in_use(host, port) from e
        why = e.strerror if isinstance(e, OSError) and e.strerror else str(e)
        raise ConfigurationError(
            f"--host {host!r} --port {port}: {why}; --host 127.0.0.1 --port 8080 stays on this machine"
        ) from e


def in_use(host: str, port: int) -> ConfigurationError:
    """What to say of a port that somebody else listens on."""
    return ConfigurationError(
        f"port {port} of {host} is in use; --port {port + 1 if port < 65535 else 8080} may be free, --port 0 takes any that is"
    )


def _full() -> Response:
    body = f"armland: {MOST_PAGES} pages are open; close one of them\n".encode()
    return Response(503, "Service Unavailable", Headers({"Content-Length": str(len(body))}), body)


@contextlib.contextmanager
def _silent() -> Iterator[None]:
    # viser prints a banner by rich's own console.
    console = rich.get_console()
    before, console.file = console._file, io.StringIO()
    try:
        yield
    finally:
        console._file = before
