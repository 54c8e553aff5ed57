"""Lets armland's compiled code run as plain Python: for the script that tries changes, and for a debugger.

With `NUMBA_DISABLE_JIT=1` two things of compiled code are missing: fields of a record as attributes, which NumPy has for record
arrays alone and not for every name, and MuJoCo's functions by address. Both are put in place here, before anything else of armland
is imported.
"""

import ctypes
import os
from pathlib import Path
from typing import Any

CREATORS = ("zeros", "empty", "ones", "zeros_like", "empty_like", "array")


def interpret() -> None:
    """Run what is imported from now on as plain Python. To be called before numba is imported."""
    os.environ["NUMBA_DISABLE_JIT"] = "1"
    import numpy

    for name in CREATORS:
        setattr(numpy, name, _recorded(getattr(numpy, name)))
    _name_fields()
    _call_mujoco()


def _recorded(create: Any) -> Any:
    import numpy

    def created(*arguments: Any, **keywords: Any) -> Any:
        made = create(*arguments, **keywords)
        return made.view(numpy.recarray) if made.dtype.names and type(made) is numpy.ndarray else made

    return created


def _name_fields() -> None:
    # NumPy's records have attributes of their own, such as `flags` and `sum`, which hide fields of those names.
    import numpy

    own, plain = frozenset(dir(numpy.void)) - {"dtype"}, numpy.record.__getattribute__

    def attribute(record: Any, name: str) -> Any:
        if name in own and name in (record.dtype.names or ()):
            return record[name]
        return plain(record, name)

    numpy.record.__getattribute__ = attribute  # type: ignore[method-assign]


def _call_mujoco() -> None:
    # What the module of native functions declares for compiled code, as functions that Python can call.
    import mujoco
    from numba import types

    try:
        from armland import native
    except ImportError:
        return
    library = ctypes.CDLL(str(native.library(Path(mujoco.__file__).parent)))
    kinds = {types.uintp: ctypes.c_size_t, types.int32: ctypes.c_int32}
    for name, function in list(vars(native).items()):
        if isinstance(function, types.ExternalFunction):
            callable_ = getattr(library, function.symbol)
            callable_.restype, callable_.argtypes = None, [kinds[kind] for kind in function.sig.args]
            setattr(native, name, callable_)
