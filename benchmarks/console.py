"""What a console costs the loop, and whether pages that come, hang and go at random disturb it.

Run: .venv/bin/python benchmarks/console.py [SECONDS [SECONDS]]

Cost: landings as fast as they go, in one process, for half a second each without a console and with one that shows them to a page
at 30 Hz. On a machine that does other things as well its best quarter of blocks says more than their middle, and the processor's
time says more than the clock: that of the thread that flies, for each tick, and that which the console's thread takes beside it.
Pages: for SECONDS at real time five pages, in a process of their own, open, read or hang, send nonsense, and close.
"""

import random
import resource
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

import msgspec
import numpy as np
import viser
from websockets.exceptions import WebSocketException
from websockets.sync.client import connect

from armland.console.live.choices import Choices
from armland.console.live.console import Console
from armland.console.live.pilot import Pilot, Steered
from armland.console.page.server import PageServer
from armland.experiments.episode import prepare
from armland.runtime.log import read_log
from armland.scenario import load_scenario

SLICE_S = 0.5

CAMERA = {
    "type": "ViewerCameraMessage",
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


def page(address: str, until: float, rng: random.Random, restless: bool) -> None:
    """A page that reads; a `restless` one hangs, sends nonsense, closes, and opens anew."""
    while time.time() < until:
        try:
            with connect(
                address.replace("http", "ws", 1),
                subprotocols=[f"viser-v{viser.__version__}"],
                max_size=None,
                compression=None,
                close_timeout=0.1,
            ) as socket:
                socket.send(msgspec.msgpack.encode(CAMERA))
                end = min(until, time.time() + rng.uniform(0.5, 6.0)) if restless else until
                hangs = restless and rng.random() < 0.5
                while time.time() < end:
                    if hangs:
                        time.sleep(0.1)
                    else:
                        socket.recv(timeout=1.0)
                    if restless and rng.random() < 0.05:
                        socket.send(rng.randbytes(50))
        except (OSError, TimeoutError, WebSocketException):
            time.sleep(0.05)


def open_pages(address: str, seconds: float, count: int, restless: bool) -> None:
    threads = [
        threading.Thread(target=page, args=(address, time.time() + seconds, random.Random(i), restless))
        for i in range(count)
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()


def memory_mb() -> float:
    """Of this process, now."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * resource.getpagesize() / 2**20


def child(address: str, seconds: float, count: int, restless: bool) -> subprocess.Popen:
    return subprocess.Popen(
        [sys.executable, __file__, "--pages", address, str(seconds), str(count), str(int(restless))]
    )


def clocks() -> tuple[float, float]:
    """Now, s, and the processor's time that this thread has had, s."""
    return time.perf_counter(), time.thread_time()


def report(blocks: dict[bool, list[list[float]]], worked: list[float]) -> None:
    """Print what blocks cost without and with a console, s a tick by both clocks, and what share of its time the console worked."""
    for i, clock in enumerate(("clock", "processor")):
        without, shown = (np.quantile([b[i] for b in blocks[on]], (0.25, 0.5)) for on in (False, True))
        for name, (low, middle) in (("without", without), ("with", shown)):
            print(
                f"{clock:9s} {name:7s} a console: {1e6 * low:.1f} µs a tick in the best quarter, {1e6 * middle:.1f} µs in the middle"
            )
        low, middle = 100.0 * (shown / without - 1.0)
        print(f"{clock:9s} cost: {low:+.1f} % in the best quarter, {middle:+.1f} % in the middle")
    print(f"blocks: {len(blocks[False])} without, {len(blocks[True])} with a console")
    print(f"the console works {100 * worked[1] / worked[0]:.1f} % of its time")


class Bench:
    def __init__(self, folder: Path) -> None:
        scenario = load_scenario("landing")
        known = prepare(scenario, "landing").plan
        self.folder = folder
        self.pilot = Pilot(lambda c: prepare(scenario, c.mission, c.seed, known=known), folder, print)

    def fly(self) -> None:
        """One landing."""
        self.pilot.start(Choices(), [])
        while self.pilot.flight is None or self.pilot.preparing or not self.pilot.flying:
            time.sleep(0.001)
        while self.pilot.ended is None:
            time.sleep(0.01)

    def cost(self, seconds: float) -> None:
        """The console is there and gone in turn, for half a second each, while landings are flown as fast as they go."""
        self.pilot.pace.set(None)
        server = PageServer("127.0.0.1", 0, None, "bench")
        console, over = Console(server, self.pilot, Choices()), threading.Event()
        blocks, last, worked = {False: [], True: []}, [(0.0, 0.0)], [0.0, 0.0]
        there, leave = [False], Steered._leave

        def timed(flight: Steered, controller, rows) -> None:
            now = clocks()
            if flight.tick > 1000 and len(rows) == 250:
                blocks[there[0]].append([(b - a) / len(rows) for a, b in zip(last[0], now, strict=True)])
            leave(flight, controller, rows)
            last[0] = clocks()

        def show() -> None:
            before = clocks()
            console.run()
            worked[:] = (a + b - c for a, b, c in zip(worked, clocks(), before, strict=True))

        def turns() -> None:
            while not over.is_set():
                there[0] = not there[0]
                if not there[0]:
                    over.wait(SLICE_S)
                    continue
                console._closed.clear()
                thread = threading.Thread(target=show)
                thread.start()
                over.wait(SLICE_S)
                console.close()
                thread.join()

        reader = child(server.address, 3.0 * seconds + 60.0, 1, restless=False)
        while not server.pages:
            time.sleep(0.01)
        self.fly()
        Steered._leave = timed
        turner, begin = threading.Thread(target=turns), time.monotonic()
        turner.start()
        while time.monotonic() - begin < seconds:
            self.fly()
        over.set()
        turner.join()
        Steered._leave = leave
        reader.kill()
        reader.wait()
        server.stop()
        report(blocks, worked)

    def disturb(self, seconds: float) -> None:
        gaps: list[float] = []
        leave, last = Steered._leave, [0.0]

        def timed(flight: Steered, controller, rows) -> None:
            now = time.perf_counter()
            if flight.tick > 100:
                gaps.append(now - last[0])
            last[0] = now
            leave(flight, controller, rows)

        Steered._leave = timed
        self.pilot.pace.set(1.0)
        server = PageServer("127.0.0.1", 0, None, "bench")
        console = Console(server, self.pilot, Choices())
        thread = threading.Thread(target=console.run)
        thread.start()
        self.fly()
        calm, gaps[:] = sorted(gaps), []
        begin, used = time.time(), [memory_mb()]
        pages = child(server.address, seconds, 5, restless=True)
        while time.time() - begin < seconds:
            self.fly()
            used.append(memory_mb())
        pages.wait()
        console.close()
        thread.join()
        lost = 0
        for log in self.folder.glob("*.mcap"):
            ticks = read_log(log).ticks["measurement"]["tick"]
            lost += int(ticks[-1]) + 1 - len(ticks)
        for name, found in (("calm", calm), ("disturbed", sorted(gaps))):
            middle, most, longest = (1e3 * found[int(share * (len(found) - 1))] for share in (0.5, 0.99, 1.0))
            print(f"{name:9s}: a block every {middle:.1f} ms, 99 % within {most:.1f} ms, the longest {longest:.1f} ms")
        print(
            f"ticks lost: {lost}; messages ignored: {server.ignored}; memory after each flight, MB: {[round(m) for m in used]}"
        )
        server.stop()


if __name__ == "__main__":
    if sys.argv[1:2] == ["--pages"]:
        open_pages(sys.argv[2], float(sys.argv[3]), int(sys.argv[4]), sys.argv[5] == "1")
    else:
        first, seconds = [*map(float, sys.argv[1:]), *(30.0, 60.0)[len(sys.argv) - 1 :]]
        with tempfile.TemporaryDirectory() as folder:
            bench = Bench(Path(folder))
            bench.cost(first)
            bench.disturb(seconds)
            bench.pilot.close()
