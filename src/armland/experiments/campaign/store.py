"""The store of a campaign: one SQLite file, to which rows are added as flights finish, and which others may read meanwhile.

A row is written in one transaction of a write-ahead log: whatever kills the process, the row is there whole or not at all. One process
writes at a time; a lock file beside the store says which.
"""

import json
import os
import sqlite3
from collections.abc import Iterator, Mapping
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from armland.errors import ConfigurationError, StoreError
from armland.experiments.campaign.locks import Lock
from armland.experiments.campaign.rows import Row

FORMAT = 1
_TABLES = """
CREATE TABLE about (name TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE texts (hash TEXT PRIMARY KEY, text TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE runs (
    run INTEGER PRIMARY KEY, point INTEGER NOT NULL, seed INTEGER NOT NULL, vals TEXT NOT NULL, success INTEGER NOT NULL,
    outcome TEXT NOT NULL, result TEXT, scenario TEXT NOT NULL, digest TEXT NOT NULL, error TEXT NOT NULL,
    wall_s REAL NOT NULL, cpu_s REAL NOT NULL, versions TEXT NOT NULL REFERENCES texts (hash)
);
"""
_COLUMNS = ", ".join(name if name != "values" else "vals" for name in Row._fields)


class Store:
    """An open store.

    Args:
        file: of the store.
        write: whether rows are added; the file is made where there is none.

    Raises:
        ConfigurationError: there is none, it is no store, or another process writes it.
        StoreError: the disk does not take it.
    """

    def __init__(self, file: Path, write: bool = False) -> None:
        self.file, self._lock = file, None
        if not write and not file.is_file():
            raise ConfigurationError(f"{file} does not exist; `armland campaign FILE --out {file}` makes it")
        if write:
            self._lock = Lock(file)
        try:
            self._open(write)
        except BaseException:
            self.close()
            raise

    def _open(self, write: bool) -> None:
        # Who may write tidies the log away when he has read; who may not leaves it.
        mode = "rwc" if write else "rw" if os.access(self.file, os.W_OK) else "ro"
        path = f"file:{_quoted(self.file)}?mode={mode}"
        try:
            self._base = sqlite3.connect(path, uri=True, timeout=30.0, isolation_level=None)
            kind = self._base.execute("PRAGMA application_id").fetchone()[0]
            empty = not self._base.execute("SELECT 1 FROM sqlite_master LIMIT 1").fetchall()
            if kind != _ID and not (write and empty):
                raise ConfigurationError(f"{self.file} is no store of a campaign; name another file by --out")
            if write:
                self._base.execute("PRAGMA journal_mode=WAL")
                # A killed process loses nothing so; a machine without power loses its last rows, and the rest stays whole.
                self._base.execute("PRAGMA synchronous=NORMAL")
            if write and empty:
                self._base.executescript(
                    f"BEGIN; PRAGMA application_id={_ID}; PRAGMA user_version={FORMAT}; {_TABLES} COMMIT;"
                )
            made = self._base.execute("PRAGMA user_version").fetchone()[0]
            if made != FORMAT:
                raise ConfigurationError(f"{self.file} has format {made} of stores, and this armland reads {FORMAT}")
        except sqlite3.DatabaseError as e:
            raise self._refusal(e) from e

    def _refusal(self, error: sqlite3.DatabaseError) -> Exception:
        words = str(error)
        if isinstance(error, sqlite3.OperationalError):
            rows = (
                "; rows that were written stay: free some space, and --resume goes on"
                if "full" in words or "I/O" in words
                else ""
            )
            return StoreError(f"{self.file} cannot be used: {words}{rows}")
        return ConfigurationError(f"{self.file} is no store of a campaign ({words}); name another file by --out")

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: type[BaseException] | BaseException | TracebackType | None) -> None:
        self.close()

    def close(self) -> None:
        """Give the file back; a second call does nothing."""
        base, lock = getattr(self, "_base", None), self._lock
        self._lock = None
        with suppress(sqlite3.Error):
            if base is not None:
                base.close()
        if lock is not None:
            lock.release()

    @property
    def about(self) -> dict[str, Any]:
        """What the store says about its campaign; empty where nothing was said yet."""
        return {name: json.loads(value) for name, value in self._ask("SELECT name, value FROM about")}

    def describe(self, about: Mapping[str, Any]) -> None:
        """Say about the campaign what `about` says, in one transaction.

        Raises:
            StoreError: the disk does not take it.
        """
        rows = [(name, json.dumps(value, sort_keys=True)) for name, value in about.items()]
        self._write(("INSERT OR REPLACE INTO about VALUES (?, ?)", rows))

    def add(self, row: Row, versions: str) -> None:
        """Write a row that a flight with these `versions` gave.

        Raises:
            StoreError: the disk does not take it, or the row is there already; nothing of it is written then.
        """
        key = f"{hash_of(versions)}"
        values = row._replace(
            values=json.dumps(row.values),  # type: ignore[arg-type]
            result=None if row.result is None else json.dumps(row.result),  # type: ignore[arg-type]
        )
        marks = ", ".join("?" * (len(Row._fields) + 1))
        self._write(
            ("INSERT OR IGNORE INTO texts VALUES (?, ?)", [(key, versions)]),
            (f"INSERT INTO runs ({_COLUMNS}, versions) VALUES ({marks})", [(*values, key)]),
        )

    def _write(self, *statements: tuple[str, list[tuple[Any, ...]]]) -> None:
        try:
            self._base.execute("BEGIN IMMEDIATE")
            for statement, rows in statements:
                self._base.executemany(statement, rows)
            self._base.execute("COMMIT")
        except sqlite3.Error as e:
            with suppress(sqlite3.Error):
                self._base.execute("ROLLBACK")
            raise (
                self._refusal(e) if isinstance(e, sqlite3.OperationalError) else StoreError(f"{self.file}: {e}")
            ) from e

    def outcomes(self) -> Iterator[tuple[int, bool]]:
        """Number and success of each row, in the order of the numbers."""
        return ((run, bool(success)) for run, success in self._ask("SELECT run, success FROM runs ORDER BY run"))

    def rows(self, runs: list[int] | None = None) -> Iterator[Row]:
        """The rows, or those numbered `runs`, in the order of their numbers; read as they are asked for."""
        wanted = "" if runs is None else f" WHERE run IN ({', '.join(str(int(run)) for run in runs)})"
        for found in self._ask(f"SELECT {_COLUMNS} FROM runs{wanted} ORDER BY run"):
            row = Row(*found)
            result = None if row.result is None else json.loads(str(row.result))
            yield row._replace(values=json.loads(str(row.values)), success=bool(row.success), result=result)

    def row(self, run: int) -> Row:
        """The row numbered `run`.

        Raises:
            ConfigurationError: it is not there.
        """
        for row in self.rows([run]):
            return row
        count, last = next(iter(self._ask("SELECT count(*), max(run) FROM runs")))
        there = f"it has {count}, the last of them {last}" if count else "it has none yet"
        raise ConfigurationError(f"{self.file} has no row {run}; {there}")

    def versions_of(self, run: int) -> str:
        """With which versions the row numbered `run` was flown; empty where there is none."""
        query = f"SELECT text FROM runs JOIN texts ON hash = versions WHERE run = {int(run)}"
        return next((text for (text,) in self._ask(query)), "")

    def _ask(self, query: str) -> Iterator[tuple[Any, ...]]:
        try:
            yield from self._base.execute(query)
        except sqlite3.DatabaseError as e:
            raise self._refusal(e) from e


def hash_of(text: str) -> str:
    """32 hexadecimal digits of a text."""
    import hashlib

    return hashlib.sha256(text.encode()).hexdigest()[:32]


def _quoted(file: Path) -> str:
    from urllib.parse import quote

    return quote(os.fspath(file))


_ID = 0x41524D4C  # "ARML"
