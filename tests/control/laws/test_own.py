"""A user's own law: compiled or plain it gives the same, and no way of failing escapes."""

import re
import threading

import numpy as np
import pytest

from armland.control.laws.exact import Reference, exact_law
from armland.control.laws.own import NOT_FINITE, RAISED, SHAPE, call, load, pack
from armland.control.laws.rigid_body import ExactGains, UavParameters
from armland.errors import ConfigurationError

LAW = """
import numpy as np
from armland.control.laws.exact import exact_law

SEEN = []

def spring(q, omega, r, v, reference, thrust, tau_att, uav, gains):
    stiffness = gains.k1[3:] * gains.k2[3:] + gains.k3_position
    weight = np.array([0.0, 0.0, uav.mass * 9.81 - thrust])
    return 0.1 * tau_att + reference.omega_d, stiffness * (reference.r_d - r) - 44.4 * v + weight + uav.lever + q[1:] + omega

def plain(q, omega, r, v, reference, thrust, tau_att, uav, gains):
    SEEN.append({"kept": [r]})
    return spring(q, omega, r, v, reference, thrust, tau_att, uav, gains)

def exact(q, omega, r, v, reference, thrust, tau_att, uav, gains):
    return exact_law(q, omega, r, v, reference, thrust, tau_att, uav, gains)

def low(q, omega, r, v, reference, thrust, tau_att, uav, gains):
    if r[2] < 100.0:
        raise ValueError("too low")
    return np.zeros(3), np.zeros(3)

def plainly_low(q, omega, r, v, reference, thrust, tau_att, uav, gains):
    SEEN.append(None)
    raise ValueError("too low")

def holes(q, omega, r, v, reference, thrust, tau_att, uav, gains):
    return np.zeros(3), np.array([0.0, np.nan, np.inf])

def short(q, omega, r, v, reference, thrust, tau_att, uav, gains):
    return np.zeros(3), np.zeros(2)

def nothing(q, omega, r, v, reference, thrust, tau_att, uav, gains):
    return None

def beyond(q, omega, r, v, reference, thrust, tau_att, uav, gains):
    i = 7
    return np.zeros(3), np.zeros(3) + r[i]

def swapped(omega, q, r, v, reference, thrust, tau_att, uav, gains):
    return np.zeros(3), np.zeros(3)

number = 5
"""


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    path = tmp_path_factory.mktemp("laws") / "my_law.py"
    path.write_text(LAW, encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def arguments():
    rng = np.random.default_rng(0)
    q = rng.normal(size=4)
    omega, r, v, tau_att, *reference = rng.normal(size=(9, 3))
    uav = UavParameters(0.48, np.diag([0.006, 0.007, 0.012]) + 1e-4, np.array([0.01, 0.02, -0.06]))
    gains = ExactGains(rng.uniform(1.0, 2.0, 6), rng.uniform(3.0, 4.0, 6), 7.0, 35.0)
    q /= np.linalg.norm(q)
    return q, omega, r, v, Reference(np.array([1.0, 0, 0, 0]), *reference), 2.35, tau_att, uav, gains


def called(law, arguments):
    returned = np.full(6, np.nan)
    return call(law.address, pack(arguments[:4], *arguments[4:]), returned), returned


@pytest.mark.parametrize(("name", "compiled"), [("spring", True), ("plain", False), ("exact", True)])
def test_called_by_address_a_law_gives_what_it_gives_by_name(file, arguments, name, compiled):
    law = load(f"{file}:{name}")
    assert law.compiled == compiled
    status, returned = called(law, arguments)
    assert status == 0
    np.testing.assert_array_equal(returned, np.concatenate(law.function(*arguments)))
    if name == "exact":
        np.testing.assert_array_equal(returned, np.concatenate(exact_law(*arguments)))


def test_plain_law_may_be_called_from_any_thread(file, arguments):
    law, found = load(f"{file}:plain"), []
    threads = [threading.Thread(target=lambda: found.append(called(law, arguments))) for _ in range(4)]
    for t in threads:
        t.start()
    for t in threads:
        t.join()
    assert [status for status, _ in found] == [0] * 4


@pytest.mark.parametrize(
    ("name", "status", "says"),
    [
        ("low", RAISED, r"failed at tick 1234: it raised ValueError: too low"),
        ("plainly_low", RAISED, r"raised ValueError: too low"),
        pytest.param("beyond", RAISED, r"raised IndexError", marks=pytest.mark.slow),
        ("holes", NOT_FINITE, r"returned force\[1\] = nan, force\[2\] = inf; every number must be finite"),
        pytest.param("short", SHAPE, r"must return delta_tau and force, each three numbers", marks=pytest.mark.slow),
        pytest.param("nothing", RAISED, r"raised TypeError: cannot unpack", marks=pytest.mark.slow),
    ],
)
def test_a_law_that_fails_gives_a_status_and_words(file, arguments, capfd, name, status, says):
    law = load(f"{file}:{name}")
    found, returned = called(law, arguments)
    assert found == status
    message = law.explain(found, 1234, pack(arguments[:4], *arguments[4:]), returned)
    assert message.startswith(f"the law {file}:{name} failed at tick 1234")
    assert re.search(says, message)
    # Nothing is printed behind the user's back.
    assert capfd.readouterr().err == ""


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("my_law", r"named FILE\.py:FUNCTION, e\.g\. my_law\.py:my_law"),
        ("{folder}/none.py:f", r"there is no file .*none\.py; .* has .*my_law\.py"),
        ("{file}:absent", r"has no function 'absent'; it has spring, plain"),
        ("{file}:number", r"has no function 'number'"),
        ("{file}:exact_law", r"has no function 'exact_law'"),
        ("{file}:swapped", r"its arguments are \(omega, q, .*\); they must be \(q, omega, r, v, reference, thrust"),
        ("{folder}/broken.py:f", r"cannot be run: SyntaxError"),
        ("{folder}/quits.py:f", r"cannot be run: SystemExit"),
    ],
)
def test_what_is_no_law_is_refused_with_what_would_have_worked(file, text, says):
    (file.parent / "broken.py").write_text("def f(:", encoding="utf-8")
    (file.parent / "quits.py").write_text("raise SystemExit(3)", encoding="utf-8")
    with pytest.raises(ConfigurationError, match=says):
        load(text.format(file=file, folder=file.parent))
