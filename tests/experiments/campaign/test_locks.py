"""The lock: held by one, given back by whatever ends its holder."""

import os
import signal
import subprocess
import sys

import pytest

from armland.errors import ConfigurationError
from armland.experiments.campaign.locks import Lock

HOLDER = (
    "import sys, pathlib, time; from armland.experiments.campaign.locks import Lock; "
    "lock = Lock(pathlib.Path(sys.argv[1])); print('held', flush=True); time.sleep(100)"
)


def test_lock_is_held_by_one_and_released(tmp_path):
    lock = Lock(tmp_path / "store")
    with pytest.raises(ConfigurationError, match=f"process {os.getpid()} on "):
        Lock(tmp_path / "store")
    lock.release()
    Lock(tmp_path / "store").release()
    assert list(tmp_path.iterdir()) == []


def test_killed_holder_gives_the_lock_back(tmp_path):
    with subprocess.Popen(
        [sys.executable, "-c", HOLDER, tmp_path / "store"], stdout=subprocess.PIPE, text=True
    ) as holder:
        assert holder.stdout.readline() == "held\n"
        with pytest.raises(ConfigurationError, match=f"process {holder.pid} on "):
            Lock(tmp_path / "store")
        holder.send_signal(signal.SIGKILL)
    Lock(tmp_path / "store").release()


def test_folder_that_is_a_file_is_refused(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(ConfigurationError, match="cannot be written to"):
        Lock(tmp_path / "file" / "store")
