"""The command `export`: a run log for other tools."""

import shutil
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from armland.cli import options
from armland.errors import ConfigurationError

EXPORT_EPILOG = """**Examples**

`armland export out/land/landing.mcap --csv out/csv` writes a CSV file for each message, and columns.csv with the unit of each column.

`armland export out/land/landing.mcap --parquet landing.parquet` writes one file that pandas, Polars and DuckDB read.

`armland export out/land/landing.mcap --rerun landing.rrd` writes a recording with the scene in 3D; `rerun landing.rrd` shows it.

The last two need `pip install 'armland[export]'`. Foxglove, PlotJuggler and Rerun open the log itself as well.

Exit code: 0 when it is done, 2 for bad input or a package that is not there, 3 if something broke, 130 if it was stopped.
"""


@options.taken(
    EXPORT_EPILOG,
    file=options.argument(Path, "Run log (MCAP).", ..., metavar="LOG"),
    csv=options.option(Path | None, "Folder for a CSV file of each message.", "--csv", metavar="DIR"),
    parquet=options.option(Path | None, "Parquet file, or a folder for one.", "--parquet", metavar="FILE|DIR"),
    rerun=options.option(Path | None, "Rerun recording, *.rrd.", "--rerun", metavar="FILE"),
)
def export(**given: Any) -> None:
    """Write a run for other tools: CSV, Parquet, or a Rerun recording with the scene in 3D."""
    from armland.runtime.log import read_log
    from armland.view.export.columns import write_csv, write_parquet
    from armland.view.export.recording import write_recording

    folder, table, recording = (given[name] for name in ("csv", "parquet", "rerun"))
    if folder is table is recording is None:
        raise ConfigurationError("nothing to write: --csv DIR, --parquet FILE or --rerun FILE.rrd says what")
    if recording is not None and recording.suffix != ".rrd":
        raise ConfigurationError(f"--rerun {str(recording)!r}: a Rerun recording is a file *.rrd")
    log = read_log(given["file"])
    if table is not None and (table.is_dir() or not table.suffix):
        _made(table, "--parquet")
        table = table / f"{log.metadata.get('experiment') or log.metadata.get('mission', 'run')}.parquet"
    # The small first: what is refused is refused before the long work.
    if table is not None:
        _whole(table, "--parquet", lambda part: write_parquet(log, part))
        print(f"The Parquet file is {table}")
    if recording is not None:
        _whole(recording, "--rerun", lambda part: write_recording(log, part))
        print(f"The Rerun recording is {recording}")
    if folder is not None:
        _made(folder, "--csv")
        with TemporaryDirectory(prefix=".part-", dir=folder) as part:
            made = [shutil.move(path, folder / path.name) for path in write_csv(log, Path(part))]
        print(f"{len(made)} files are in {folder}/")


def _made(folder: Path, option: str) -> None:
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with TemporaryDirectory(prefix=".part-", dir=folder):
            pass
    except (OSError, ValueError) as e:
        why = (e.strerror if isinstance(e, OSError) else None) or str(e)
        raise ConfigurationError(f"{option} {str(folder)!r} cannot be made a folder to write to: {why}") from e


def _whole(path: Path, option: str, write: Callable[[Path], object]) -> None:
    # The file takes its name when all of it is there.
    if path.is_dir() or path.is_symlink():
        raise ConfigurationError(
            f"{option} {str(path)!r} is a {'link' if path.is_symlink() else 'folder'}; name a file"
        )
    if not path.parent.is_dir():
        raise ConfigurationError(f"{option} {str(path)!r}: create the folder {str(path.parent)!r} first")
    part = path.with_name(f".{path.stem[:100]}.part{path.suffix}")
    try:
        part.touch()
    except OSError as e:
        raise ConfigurationError(f"{option} {str(path)!r} cannot be written: {e.strerror}") from e
    try:
        write(part)
        part.replace(path)
    finally:
        with suppress(OSError):
            part.unlink(missing_ok=True)
