"""A user's own law: a function in a file, compiled if it can be, else plain Python, called by its address from compiled code.

    def my_law(q, omega, r, v, reference, thrust, tau_att, uav, gains):
        ...
        return delta_tau, force

| argument | is |
|---|---|
| q (4,) | attitude, D<-B, scalar first |
| omega (3,) | angular velocity, rad/s, B |
| r, v (3,) | position of the pivot, m, and velocity of the centre of mass, m/s, D |
| reference | `control.laws.exact.Reference`: q_d, omega_d, omega_dot_d, r_d, v_d, a_d |
| thrust, tau_att (3,) | N along the body's z; torque of the controller on board, N·m, B |
| uav, gains | `control.laws.rigid_body.UavParameters`, `ExactGains` |
| delta_tau, force (3,) | extra torque for the UAV, N·m, B; force of the end effector on it, N, D |

A law that raises, or returns anything but finite numbers, gives a status and never an exception: the flight goes on with `exact`, and
what the law was given is kept, so that `OwnLaw.explain` can say what went wrong.
"""

import ctypes
import importlib.util
import inspect
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
from llvmlite import ir
from numba import carray, cfunc, njit, types
from numba.extending import intrinsic

from armland.control.laws.exact import Reference
from armland.control.laws.rigid_body import ExactGains, UavParameters
from armland.errors import ConfigurationError
from armland.rotations import Array

ARGUMENTS = ("q", "omega", "r", "v", "reference", "thrust", "tau_att", "uav", "gains")

GIVEN = 63
"""Numbers that a law is given, in the order of `pack`."""

RAISED, SHAPE, NOT_FINITE = 1, 2, 3
"""How a law can fail: an exception; results that are not two vectors (3,); a result that is no finite number."""

_POINTER = types.CPointer(types.float64)
_CALLBACK = ctypes.CFUNCTYPE(ctypes.c_int64, ctypes.POINTER(ctypes.c_double), ctypes.POINTER(ctypes.c_double))


@intrinsic
def _call(typing: Any, address: Any, given: Any, returned: Any) -> Any:
    # The function at `address`: int64 (double *, double *).
    del typing, address, given, returned

    def build(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        del context, signature
        number, pointer = ir.IntType(64), ir.DoubleType().as_pointer()
        kind = ir.FunctionType(number, [pointer, pointer])
        at = builder.inttoptr(arguments[0], kind.as_pointer())
        return builder.call(at, [builder.inttoptr(a, pointer) for a in arguments[1:]])

    return types.int64(types.int64, types.uintp, types.uintp), build


@njit(cache=True)
def call(address: int, given: Array, returned: Array) -> int:
    """Call the law at `address`; 0, or how it failed: RAISED, SHAPE, NOT_FINITE.

    Args:
        address: of a function int64 (double *, double *).
        given: (63,), in the units of `pack`.
        returned: (6,), N·m and N, receives delta_tau and force.
    """
    status: int = _call(address, given.ctypes.data, returned.ctypes.data)  # type: ignore[call-arg]
    total = 0.0
    for i in range(6):
        total += returned[i]
    return NOT_FINITE if status == 0 and not np.isfinite(total) else status


@njit(cache=True)
def pack(
    state: tuple[Array, Array, Array, Array],
    reference: Reference,
    thrust: float,
    tau_att: Array,
    uav: UavParameters,
    gains: ExactGains,
) -> Array:
    """The arguments of a law as one array (63,); `state` is (q, omega, r, v); shapes, units and frames as in the module's table."""
    a, (q, omega, r, v) = np.empty(GIVEN), state
    for i in range(4):
        a[i], a[13 + i] = q[i], reference.q_d[i]
    for i in range(3):
        a[4 + i], a[7 + i], a[10 + i] = omega[i], r[i], v[i]
        a[17 + i], a[20 + i] = reference.omega_d[i], reference.omega_dot_d[i]
        a[23 + i], a[26 + i], a[29 + i] = reference.r_d[i], reference.v_d[i], reference.a_d[i]
        a[33 + i], a[46 + i] = tau_att[i], uav.lever[i]
        for k in range(3):
            a[37 + 3 * i + k] = uav.inertia[i, k]
    for i in range(6):
        a[49 + i], a[55 + i] = gains.k1[i], gains.k2[i]
    a[32], a[36], a[61], a[62] = thrust, uav.mass, gains.k3_attitude, gains.k3_position
    return a


def _unpacked(a: Array) -> tuple:
    reference = Reference(a[13:17], a[17:20], a[20:23], a[23:26], a[26:29], a[29:32])
    uav = UavParameters(a[36], a[37:46].reshape(3, 3), a[46:49])
    return (
        a[0:4],
        a[4:7],
        a[7:10],
        a[10:13],
        reference,
        a[32],
        a[33:36],
        uav,
        ExactGains(a[49:55], a[55:61], a[61], a[62]),
    )


class OwnLaw:
    """A law from a file; `address` is good as long as this object lives. Make it with `load`."""

    def __init__(self, name: str, function: Callable[..., Any]) -> None:
        """Compile `function`, called `name` in messages, or wrap it as it is; `compiled` says which."""
        self.name, self.function = name, function
        self._raised = ""
        try:
            self._entry: Any = _compiled(function)
            self.compiled, self.address = True, int(self._entry.address)
        except Exception as refusal:
            # Numba refuses with many kinds of exception, and what it cannot compile runs as it is.
            self.why = str(refusal).strip().partition("\n")[0]
            self._entry = _CALLBACK(self._plain)
            self.compiled, self.address = False, int(ctypes.cast(self._entry, ctypes.c_void_p).value or 0)

    def explain(self, status: int, tick: int, given: Array, returned: Array) -> str:
        """What went wrong at `tick`: `status`, `given` (63,) and `returned` (6,), N·m and N, as `call` left them."""
        start = f"the law {self.name} failed at tick {tick}: it "
        if status == NOT_FINITE:
            bad = [f"{n} = {x}" for n, x in zip(_RESULTS, returned, strict=True) if not np.isfinite(x)]
            return f"{start}returned {', '.join(bad)}; every number must be finite"
        if status == SHAPE:
            return f"{start}must return delta_tau and force, each three numbers"
        if not self._raised:
            # Compiled code keeps no message: the same call in plain Python tells it.
            self._answer(np.array(given))
        return f"{start}raised {self._raised or 'an exception that plain Python does not'}"

    def _plain(self, given: Any, returned: Any) -> int:
        answer = self._answer(np.ctypeslib.as_array(given, (GIVEN,)).copy())
        if isinstance(answer, int):
            return answer
        np.ctypeslib.as_array(returned, (6,))[:] = answer
        return 0

    def _answer(self, given: Array) -> int | Array:
        try:
            delta_tau, force = self.function(*_unpacked(given))
            answer = [np.asarray(x, dtype=float) for x in (delta_tau, force)]
        except BaseException as e:
            # Nothing may escape into the compiled code that called.
            self._raised = f"{type(e).__name__}: {e}"
            return RAISED
        return np.concatenate(answer) if all(x.shape == (3,) for x in answer) else SHAPE


_RESULTS = tuple(f"{name}[{i}]" for name in ("delta_tau", "force") for i in range(3))


def _compiled(function: Callable[..., Any]) -> Any:
    law = njit(boundscheck=True)(function)

    @cfunc(types.int64(_POINTER, _POINTER))
    def entry(given: Any, returned: Any) -> int:
        a, out, status = carray(given, (63,)), carray(returned, (6,)), 1
        try:
            reference = Reference(a[13:17], a[17:20], a[20:23], a[23:26], a[26:29], a[29:32])
            uav = UavParameters(a[36], a[37:46].reshape((3, 3)), a[46:49])
            gains = ExactGains(a[49:55], a[55:61], a[61], a[62])
            delta_tau, force = law(a[0:4], a[4:7], a[7:10], a[10:13], reference, a[32], a[33:36], uav, gains)
            status = 2
            if delta_tau.size == 3 and force.size == 3:
                for i in range(3):
                    out[i], out[3 + i] = delta_tau[i], force[i]
                status = 0
        except Exception:
            status = status + 0
        return status

    return entry


def load(text: str) -> OwnLaw:
    """The law `FILE.py:FUNCTION`.

    Raises:
        ConfigurationError: no such file, a file that cannot be run, no such function, or one with other arguments.
    """
    path, _, name = text.rpartition(":")
    if not path or not name:
        raise ConfigurationError(f"law {text!r}: a law of one's own is named FILE.py:FUNCTION, e.g. my_law.py:my_law")
    module = _module(Path(path), text)
    functions = [n for n, f in vars(module).items() if inspect.isfunction(f) and f.__module__ == module.__name__]
    if name not in functions:
        raise ConfigurationError(
            f"law {text!r}: {path} has no function {name!r}; it has {', '.join(functions) or 'none'}"
        )
    function = getattr(module, name)
    found = tuple(inspect.signature(function).parameters)
    if found != ARGUMENTS:
        raise ConfigurationError(
            f"law {text!r}: its arguments are ({', '.join(found)}); they must be ({', '.join(ARGUMENTS)})"
        )
    return OwnLaw(text, function)


def _module(path: Path, text: str) -> ModuleType:
    if not path.is_file():
        here = sorted(p.name for p in path.parent.glob("*.py"))[:8] if path.parent.is_dir() else []
        near = f"; {path.parent} has {', '.join(here)}" if here else ""
        raise ConfigurationError(f"law {text!r}: there is no file {path}{near}")
    spec = importlib.util.spec_from_file_location(f"armland_own_law_{path.stem}", path)
    if spec is None or spec.loader is None:
        raise ConfigurationError(f"law {text!r}: {path} is no Python file; its name must end in .py")
    module = importlib.util.module_from_spec(spec)
    try:
        spec.loader.exec_module(module)
    except (Exception, SystemExit) as e:
        raise ConfigurationError(f"law {text!r}: {path} cannot be run: {type(e).__name__}: {e}") from e
    return module
