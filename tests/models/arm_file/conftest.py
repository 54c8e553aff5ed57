from pathlib import Path

import pytest

from armland.models.arm_file.reading import read_arm
from armland.models.arm_file.table import Asked

ARMS = Path(__file__).parents[2] / "data" / "arms"


@pytest.fixture
def arms():
    """Folder of arms that each have one oddity of real files."""
    return ARMS


@pytest.fixture
def arm(arms):
    """Read an arm of that folder; keywords as of `Asked`."""
    return lambda name, **asked: read_arm(arms / name, Asked(**asked))


@pytest.fixture
def changed(arms, tmp_path):
    """Path of an arm of that folder with texts replaced."""

    def write(name, *pairs):
        text = (arms / name).read_text("utf-8")
        for old, new in pairs:
            assert old in text, old
            text = text.replace(old, new)
        path = tmp_path / name
        path.write_text(text, encoding="utf-8")
        return path

    return write
