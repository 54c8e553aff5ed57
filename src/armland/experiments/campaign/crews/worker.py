"""A process that flies: `python -m armland.experiments.campaign.crews.worker NUMBER`, the number of an open pipe to who started it.

It takes what to do, then one task at a time, and gives back the row of each. When the other end of the pipe is closed, by whatever, the
process ends at once, in the middle of a flight, too.
"""

import os
import sys
import threading
from multiprocessing.connection import Connection
from queue import SimpleQueue
from typing import Any

READY = "ready"


def serve(pipe: Connection) -> None:
    """Fly what comes through the `pipe` until it is closed; the process ends then."""
    asked: SimpleQueue[Any] = SimpleQueue()
    threading.Thread(target=_listen, args=(pipe, asked), daemon=True).start()
    work, job = asked.get()
    pipe.send(READY)
    while True:
        pipe.send(work(job, asked.get()))


def _listen(pipe: Connection, asked: "SimpleQueue[Any]") -> None:
    # The loop runs without Python's lock, so this thread hears of the end while a flight is under way.
    try:
        while True:
            asked.put(pipe.recv())
    except (EOFError, OSError):
        os._exit(0)
    except BaseException:
        # What was sent cannot be read here, as a function of a module that is not found.
        sys.excepthook(*sys.exc_info())
        os._exit(1)


def main(number: int) -> None:
    """Serve the pipe `number`."""
    # Nothing but tables goes to standard output, and those are not printed here.
    os.dup2(2, 1)
    serve(Connection(number))


if __name__ == "__main__":
    main(int(sys.argv[1]))
