"""Pictures into a film: H.264 (.mp4), VP9 (.webm), or an animated .gif or .webp that pages show inline."""

from collections.abc import Callable, Iterable
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from armland.errors import ConfigurationError

CODECS = {
    ".mp4": ("libx264", {"crf": "21", "preset": "medium"}, {"movflags": "+faststart"}),
    ".webm": ("libvpx-vp9", {"crf": "34", "b": "0", "cpu-used": "5", "row-mt": "1"}, {}),
}
"""Codec, its options and those of the file, by suffix."""

ANIMATED = (".gif", ".webp")

SUFFIXES = (*CODECS, *ANIMATED)

Pictures = Iterable[NDArray[np.uint8]]
"""(height, width, 3) each, all of one even size"""


def check_name(path: Path) -> None:
    """Refuse a file that no film can be written into.

    Raises:
        ConfigurationError: a suffix that is unknown, or a folder that is not there.
    """
    if path.suffix.lower() not in SUFFIXES:
        raise ConfigurationError(f"--video {str(path)!r}: a film is a file *{', *'.join(SUFFIXES)}")
    if path.is_dir() or path.is_symlink():
        raise ConfigurationError(f"--video {str(path)!r} is a {'link' if path.is_symlink() else 'folder'}; name a file")
    if not path.parent.is_dir():
        raise ConfigurationError(f"--video {str(path)!r}: create the folder {str(path.parent)!r} first")
    try:
        part = part_of(path)
        part.touch()
        part.unlink()
    except OSError as e:
        raise ConfigurationError(f"--video {str(path)!r} cannot be written: {e.strerror}") from e


def part_of(path: Path) -> Path:
    """Where a film is written until it is whole."""
    return path.with_name(f".{path.stem[:100]}.part{path.suffix}")


def encode(path: Path, pictures: Pictures, fps: int) -> Path:
    """Write the pictures as a film of `fps` pictures a second; it has its name when it is whole, and returns it."""
    part = part_of(path)
    write: Callable[[Path, Pictures, int], None] = _animated if path.suffix.lower() in ANIMATED else _encoded
    try:
        write(part, pictures, fps)
        part.replace(path)
    finally:
        part.unlink(missing_ok=True)
    return path


def _encoded(part: Path, pictures: Pictures, fps: int) -> None:
    import av

    codec, options, of_file = CODECS[part.suffix.lower()]
    with av.open(str(part), "w", options=of_file) as file:
        stream: Any = None
        for number, picture in enumerate(pictures):
            if stream is None:
                stream = file.add_stream(codec, rate=fps, options=options)
                stream.height, stream.width, stream.pix_fmt = *picture.shape[:2], "yuv420p"
                stream.time_base = Fraction(1, fps)
            frame = av.VideoFrame.from_ndarray(np.ascontiguousarray(picture), format="rgb24")
            frame.pts, frame.time_base = number, Fraction(1, fps)
            file.mux(stream.encode(frame))
        if stream is not None:
            file.mux(stream.encode(None))


def _animated(part: Path, pictures: Pictures, fps: int) -> None:
    images = (Image.fromarray(p) for p in pictures)
    how: dict[str, Any] = {"quality": 60, "method": 4} if part.suffix.lower() == ".webp" else {"optimize": True}
    if part.suffix.lower() == ".gif":
        # One palette for all pictures: each with its own would flicker.
        kept = list(images)
        palette = kept[len(kept) // 2].quantize(128)
        images = (i.quantize(palette=palette, dither=Image.Dither.NONE) for i in kept)
    next(images := iter(images)).save(
        part, save_all=True, append_images=images, duration=round(1000 / fps), loop=0, **how
    )
