"""A page server on a free port, a recorded landing, and a page that speaks viser's own messages."""

import time
from pathlib import Path

import msgspec
import pytest
import viser
from websockets.sync.client import connect

ROOT = Path(__file__).parents[2]


class FakePage:
    """What a browser's page is to the server: it opens, sends its camera, and reads nothing unless asked."""

    def __init__(self, address: str, **headers: str) -> None:
        base = address.split("/?")[0]
        self.socket = connect(
            base.replace("http", "ws", 1),
            subprotocols=[f"viser-v{viser.__version__}"],
            additional_headers=headers,
            max_size=None,
            compression=None,
            # It reads nothing, need not say goodbye, and asks for no sign of life, which a busy machine gives late.
            close_timeout=0.1,
            ping_interval=None,
        )

    def send(self, kind: str, **fields: object) -> None:
        self.socket.send(msgspec.msgpack.encode({"type": kind, **fields}))

    def look(self, **changes: object) -> None:
        camera = {
            "wxyz": (1.0, 0.0, 0.0, 0.0),
            "position": (1.0, 1.0, 1.0),
            "fov": 1.0,
            "near": 0.01,
            "far": 100.0,
            "image_height": 600,
            "image_width": 800,
            "look_at": (0.0, 0.0, 0.0),
            "up_direction": (0.0, 0.0, 1.0),
        }
        self.send("ViewerCameraMessage", **(camera | changes))

    def set(self, handle: object, value: object) -> None:
        self.send("GuiUpdateMessage", uuid=handle._impl.uuid, updates={"value": value})

    def press(self, command: object) -> None:
        self.send("CommandTriggerMessage", uuid=command._impl.uuid)

    def close(self) -> None:
        self.socket.close()


def until(there, seconds: float = 15.0) -> bool:
    """Wait until something is so; whether it came to be."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if there():
            return True
        time.sleep(0.01)
    return bool(there())


@pytest.fixture(scope="session")
def wait_until():
    return until


@pytest.fixture
def fake_page():
    """Opens pages, and closes what is left of them."""
    opened = []

    def open_one(server, look: bool = True, **headers: str) -> FakePage:
        before = server.pages
        page = FakePage(server.address, **headers)
        opened.append(page)
        assert until(lambda: server.pages > before)
        if look:
            page.look()
        return page

    yield open_one
    for page in opened:
        page.close()


@pytest.fixture
def server():
    """A page server without token; what it refused is in `server.said`."""
    from armland.console.page.server import PageServer

    said = []
    made = PageServer("127.0.0.1", 0, None, "test", said.append)
    made.said = said
    yield made
    made.stop()


@pytest.fixture(scope="session")
def log_file(flown) -> Path:
    """The log of a landing."""
    return flown["landing"][0].log


@pytest.fixture(scope="session")
def recording(log_file):
    """The same as a page shows it."""
    from armland.console.recording import Recording
    from armland.runtime.log import read_log

    return Recording(read_log(log_file), log_file)
