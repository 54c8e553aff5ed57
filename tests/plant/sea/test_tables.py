"""A response as a table gives what its closed form gives; what no hull has is refused with number, bound and what would work."""

import numpy as np
import pytest
import waveresponse

from armland.errors import ConfigurationError
from armland.plant.sea.hull import MOTIONS, contour
from armland.plant.sea.tables import read_response, read_spectrum
from armland.plant.sea.waves import wave_motion

OMEGA = np.linspace(0.3, 6.0, 115)


def rolling(omega, towards):
    """A monohull's roll: second order, resonant at 2 rad/s with a tenth of critical damping."""
    H = contour(omega, towards, 4.0, 1.6)
    H[:, 3] *= 4.0 / (4.0 - omega**2 + 0.4j * omega)
    return H


def written(path, directions, response=rolling, change=lambda H: H):
    names = ",".join(f"{m}_{p}" for m in MOTIONS for p in ("re", "im"))
    lines = [f"omega_radps,towards_deg,{names}"]
    for d in directions:
        H = change(response(OMEGA, np.full_like(OMEGA, np.deg2rad(d))))
        for w, row in zip(OMEGA, H, strict=True):
            parts = ",".join(f"{x.real:.9g},{x.imag:.9g}" for x in row)
            lines.append(f"{w},{d},{parts}")
    path.write_text("\n".join(lines) + "\n")
    return str(path)


def test_table_is_its_closed_form_and_has_two_sides(tmp_path):
    """Also where the table has one side only: the other is mirrored."""
    whole = read_response(written(tmp_path / "a.csv", range(-180, 180, 10)))
    half = read_response(written(tmp_path / "b.csv", range(0, 181, 10)))
    omega, towards = np.array([0.7, 1.3, 2.2, 2.9]), np.array([-2.9, 0.35, 1.9, 3.0])
    exact = rolling(omega, towards)
    for table in (whole, half):
        assert np.abs(table.at(omega, towards) - exact).max() < 0.03
    # At a row nothing is lost.
    np.testing.assert_allclose(
        half.at(OMEGA[20:21], np.array([-np.pi / 3])), rolling(OMEGA[20:21], np.array([-np.pi / 3]))
    )


def test_interpolation_is_that_of_waveresponse(tmp_path):
    """Its RAO between rows, real and imaginary parts: the same numbers within 2 %, where amplitude and phase go their own way."""
    table = read_response(written(tmp_path / "a.csv", range(0, 360, 15)))
    directions = np.deg2rad(np.arange(0, 360, 15))
    roll = np.stack([rolling(OMEGA, np.full_like(OMEGA, d))[:, 3] for d in directions], axis=1)
    rao = waveresponse.RAO(OMEGA, directions, roll, freq_hz=False, degrees=False)
    omega, towards = np.array([0.9, 1.7, 1.98, 2.41]), 1.234
    theirs = rao.interpolate(omega, np.array([towards]), freq_hz=False, degrees=False)[:, 0]
    ours = table.at(omega, np.full(4, towards))[:, 3]
    np.testing.assert_allclose(ours, theirs, rtol=0.02)


def test_deck_moves_by_the_table(landing, tmp_path):
    sea = {"state": "ss3", "crests": "long", "towards_deg": 90.0}
    file = written(tmp_path / "a.csv", range(0, 181, 15))
    rolls, follows = (wave_motion(landing(sea=s)) for s in ({**sea, "response_file": file}, sea))
    assert rolls.significant()[3] > 1.5 * follows.significant()[3]
    assert rolls.significant()[2] == pytest.approx(follows.significant()[2], rel=0.02)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            lambda H: H * np.where(np.arange(6) == 3, 180.0 / np.pi, 1.0),
            r"roll of \S+ rad/m at .* in other units, such as deg/m",
        ),
        (
            lambda H: 30.0 * H * (np.arange(6) == 2),
            r"heave of \S+ m/m at .*; at most 20, 20 times the wave, is a hull's",
        ),
        (
            np.conj,
            r"\d+% of roll's response .* comes before its wave; at most 80%: .* imaginary parts have the other sign",
        ),
        (lambda H: H * np.where(OMEGA > 3.0, np.nan, 1.0)[:, None], r"row 56: surge_re = nan is not a finite number"),
    ],
)
def test_what_no_hull_has_is_refused(tmp_path, change, message):
    file = written(tmp_path / "bad.csv", range(0, 181, 30), change=change)
    with pytest.raises(ConfigurationError, match=f"^bad.csv: .*{message}"):
        read_response(file)


def test_causal_table_with_resonance_is_taken(tmp_path):
    read_response(written(tmp_path / "a.csv", range(0, 181, 30)))
    read_response(written(tmp_path / "b.csv", range(0, 181, 30), response=lambda w, d: contour(w, d, 4.0, 1.6)))


def test_table_with_holes_is_refused(tmp_path, landing):
    with pytest.raises(ConfigurationError, match="no direction between -180 and -120 degrees; at most 46"):
        read_response(written(tmp_path / "a.csv", (0, 60, 120, 180)))
    file = tmp_path / "b.csv"
    file.write_text("omega_radps,towards_deg\n1,0\n2,0\n")
    with pytest.raises(ConfigurationError, match="no motion; a hull's response has columns such as heave_re"):
        read_response(str(file))
    whole = written(tmp_path / "c.csv", range(0, 181, 30))
    lines = (tmp_path / "c.csv").read_text().splitlines()
    (tmp_path / "d.csv").write_text("\n".join(lines[:-1]))
    with pytest.raises(ConfigurationError, match="804 rows of 115 frequencies and 7 directions; a full grid"):
        read_response(str(tmp_path / "d.csv"))
    slow = {"height_m": 1.0, "period_s": 24.0, "response_file": whole}
    with pytest.raises(ConfigurationError, match=r"from 0.3 to 6 rad/s are \d+% of the waves' energy; 98% are needed"):
        wave_motion(landing(sea=slow))


def test_own_spectrum_is_the_sea(tmp_path, landing):
    """A box of 1 m²·s/rad from 1 to 2 rad/s has m₀ = 1 m², H_s = 4 m."""
    file = tmp_path / "s.csv"
    file.write_text("omega_radps,density_m2s\n" + "".join(f"{w},1\n" for w in np.linspace(1, 2, 50)))
    motion = wave_motion(landing(sea={"spectrum_file": str(file), "hull_m": 0.5}))
    assert motion.significant()[2] == pytest.approx(2.0, rel=0.02)
    assert (motion.omega >= 1.0).all() and (motion.omega <= 2.0).all()  # noqa: PT018


@pytest.mark.parametrize(
    ("rows", "message"),
    [
        (["1,1", "1,1"], "must lie above 0 and rise"),
        (["1,1", "2,-1"], "must not be negative"),
        (["1,1000", "2,1000"], "a significant wave height of 126 m; from 0.01 to 15 m is a sea's"),
    ],
)
def test_spectrum_of_no_sea_is_refused(tmp_path, rows, message):
    file = tmp_path / "s.csv"
    file.write_text("\n".join(["omega_radps,density_m2s", *rows]))
    with pytest.raises(ConfigurationError, match=message):
        read_spectrum(str(file))
