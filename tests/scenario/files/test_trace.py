"""A recorded wind is read as it stands, and what no anemometer records is refused with the row and the bound."""

import numpy as np
import pytest

from armland.errors import ConfigurationError
from armland.scenario.files.trace import read_trace

HEAD = "time_s,x,y,z"


def written(tmp_path, *rows, head=HEAD):
    file = tmp_path / "wind.csv"
    file.write_text("\n".join([head, *rows]) + "\n")
    return file


def test_times_begin_at_zero_and_columns_are_found_by_name(tmp_path):
    times, wind = read_trace(written(tmp_path, "1,7,10.0,3,2", "4,7,10.5,6,5", head="x,note,time_s,z,y"), 0.5)
    np.testing.assert_array_equal(times, [0.0, 0.5])
    np.testing.assert_array_equal(wind, [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]])


@pytest.mark.parametrize(
    ("rows", "message"),
    [
        (["0,1,1,1", "1,1,1,1", "0.5,1,1,1"], "row 3: time_s = 0.5 follows 1; times must rise"),
        (["0,1,1,1", "1,1,1,1", "1,1,1,1"], "row 3: time_s = 1 follows 1; times must rise"),
        ([*(f"{t},1,1,1" for t in range(5)), "10,1,1,1"], "row 6: a gap of 6 s; the median step is 1 s, and 5 times"),
        (["0,1,1,1", "1,1,nan,1"], "row 2: y = nan is not a finite number"),
        (["0,1,1,1", "inf,1,1,1"], "row 2: time_s = inf is not a finite number"),
        (["0,1,1,1", "1,1,1,-800"], "row 2: z = -800 m/s; at most 50 m/s is wind: is it in other units"),
        (["0,1,1,1", "1,1,1,1"], "lasts 1 s, and run.duration_s = 45"),
        (["0,1,1,1"], "1 rows; a recorded wind has two or more"),
        ([], "0 rows"),
        (["0,1,one,1"], "should have a header with time_s, x, y, z, and numbers"),
        (["0,1"], "should have a header with time_s, x, y, z, and numbers"),
    ],
)
def test_what_is_no_record_of_wind_is_refused(tmp_path, rows, message):
    with pytest.raises(ConfigurationError, match=f"^wind.csv: .*{message}"):
        read_trace(written(tmp_path, *rows), 45.0)


def test_file_without_the_columns_or_that_is_not_there_is_refused(tmp_path):
    with pytest.raises(ConfigurationError, match="should have a header"):
        read_trace(written(tmp_path, "0,1,1,1", head="t,u,v,w"), 1.0)
    with pytest.raises(ConfigurationError, match="cannot be read: No such file"):
        read_trace(tmp_path / "none.csv", 1.0)
    (tmp_path / "bytes.csv").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(ConfigurationError, match="should have a header"):
        read_trace(tmp_path / "bytes.csv", 1.0)
