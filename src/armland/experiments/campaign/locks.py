"""A lock file: who may write a store. The system gives the lock back when its process ends, however it ends."""

import fcntl
import os
from contextlib import suppress
from pathlib import Path

from armland.errors import ConfigurationError, StoreError


class Lock:
    """Held from its making to its `release`.

    Args:
        file: that is guarded; the lock is a file beside it.

    Raises:
        ConfigurationError: another process holds it, or the folder is none.
        StoreError: the disk does not take it.
    """

    def __init__(self, file: Path) -> None:
        self._path = file.with_name(file.name + ".lock")
        while True:
            self._number = self._made(file)
            try:
                fcntl.flock(self._number, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except OSError as e:
                holder = os.pread(self._number, 100, 0).decode(errors="replace").strip()
                os.close(self._number)
                raise ConfigurationError(
                    f"{file} is being written by another process ({holder or 'unknown'}); wait for it, stop it, or name another --out"
                ) from e
            # Who held it before may have deleted the file in the meantime: then this lock guards nothing.
            with suppress(FileNotFoundError):
                if os.stat(self._path).st_ino == os.fstat(self._number).st_ino:
                    break
            os.close(self._number)
        with suppress(OSError):
            os.truncate(self._number, 0)
            os.pwrite(self._number, f"process {os.getpid()} on {os.uname().nodename}\n".encode(), 0)

    def _made(self, file: Path) -> int:
        try:
            file.parent.mkdir(parents=True, exist_ok=True)
            return os.open(self._path, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o644)
        except OSError as e:
            if isinstance(e, FileExistsError | NotADirectoryError | IsADirectoryError | PermissionError):
                raise ConfigurationError(f"--out {str(file)!r} cannot be written to: {e.strerror}") from e
            raise StoreError(f"{self._path} cannot be made: {e.strerror}") from e

    def release(self) -> None:
        """Let others write."""
        with suppress(OSError):
            os.unlink(self._path)
        os.close(self._number)
