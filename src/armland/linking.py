"""Compiled functions that are compiled once, and called by address: not compiled anew inside each function that calls them.

Numba puts the code of a called function into the caller's, and the optimiser works on it once more in each of them: what stands
five calls down is compiled five times. A function that is `linked` is a border: callers hold its symbol, and the address is
put in before they run.

    @linked(lambda joints: (named("board", joints),))
    @njit(cache=True)
    def decide(b): ...

`link(joints)` compiles all linked functions for an arm with `joints` joints, or loads them from the cache, and makes their
addresses known; a compiled function that calls them may only be loaded afterwards. From Python a linked function is called as
the function itself.
"""

import hashlib
import threading
from collections.abc import Callable
from typing import Any

import llvmlite.binding
import numpy as np
from numba import config, from_dtype, types
from numba.core import cgutils
from numba.core.errors import TypingError
from numba.core.extending import _Intrinsic

from armland.records import MESSAGES, head_layout

VECTOR = types.Array(types.float64, 1, "C")
MATRIX = types.Array(types.float64, 2, "C")
"""Numba's types of float64 arrays (k,) and (k, m), C-contiguous."""

Types = Callable[[int], tuple[Any, ...]]
"""From the number of joints to the Numba types of a function's arguments."""


def record(layout: np.dtype) -> Any:
    """Numba's type of one record of `layout`."""
    return from_dtype(layout)


def heads(*messages: str) -> tuple[Any, ...]:
    """Numba's types of the `head` of `messages`."""
    return tuple(record(head_layout(message)) for message in messages)


LAYOUTS: dict[str, Callable[[int], np.dtype]] = {}
"""Layouts by name and number of joints, of records that are composed behind the functions that take them."""


def named(name: str, joints: int) -> Any:
    """Numba's type of one record of the layout `name` in `LAYOUTS`, for an arm with `joints` joints."""
    return record(LAYOUTS[name](joints))


NAMES = {frozenset(field.name for field in fields): name for name, fields in MESSAGES.items()}
"""Messages by their fields, whose order in Numba is another one where some have no elements."""


class Head(_Intrinsic):  # type: ignore[misc]
    """The fields of a message that are the same for every arm, as one record; from Python the message itself.

    What takes no more than these is compiled once, and not anew for each number of joints.
    """

    def __init__(self) -> None:
        super().__init__("head", _head)
        self._register()

    def __call__(self, message: Any) -> Any:
        """The message."""
        return message

    def _reduce_states(self) -> dict[str, str]:
        return {}

    @classmethod
    def _rebuild(cls) -> "Head":  # type: ignore[override]
        return head


def _head(typing: Any, message: Any) -> Any:
    (kind,) = heads(NAMES[frozenset(message.fields)])

    def build(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        return builder.bitcast(values[0], context.get_value_type(kind))

    return kind(message), build


head = Head()

LINKED: list["Linked"] = []
"""All linked functions of the modules that are imported."""


class Linked(_Intrinsic):  # type: ignore[misc]
    """A compiled function behind a symbol."""

    def __init__(self, dispatcher: Any, types_of: Types, returns: Any) -> None:
        """Make `dispatcher`, a function of Numba's `njit`, callable by symbol with arguments of `types_of`."""
        self.dispatcher, self.types_of, self.returns = dispatcher, types_of, returns
        self._linked: set[int] = set()
        self._known: set[tuple[Any, ...]] = set()
        function = dispatcher.py_func
        # Numba looks at the names of the arguments.
        names = function.__code__.co_varnames[: function.__code__.co_argcount]
        scope: dict[str, Any] = {"typed": self._typed}
        exec(f"def call(typing, {', '.join(names)}): return typed(({', '.join(names)},))", scope)
        super().__init__(function.__name__, scope["call"])
        self.__doc__, self.__module__ = function.__doc__, function.__module__
        self._register()

    def __call__(self, *arguments: Any) -> Any:
        """Call the function from Python."""
        return self.dispatcher(*arguments)

    @property
    def name(self) -> str:
        """Of the function."""
        return str(self._name)

    def symbol(self, arguments: tuple[Any, ...]) -> str:
        """Name under which callers know it."""
        kinds = hashlib.sha256(str(arguments).encode()).hexdigest()[:24]
        return f"armland.{self.__module__}.{self._name}.{kinds}"

    def expect(self, joints: int) -> None:
        """Let it be called by what is compiled here and never run: its symbol leads nowhere, unless its address is known already."""
        if joints in self._linked:
            return
        arguments = tuple(self.types_of(joints))
        self._known.add(arguments)
        self._linked.add(joints)
        llvmlite.binding.add_symbol(self.symbol(arguments), 1)

    def link(self, joints: int) -> None:
        """Compile it, or load it from the cache, and make its address known; waits for another thread that does so.

        Raises:
            RuntimeError: what was compiled has no address.
        """
        with _LINKING:
            if joints in self._linked:
                return
            arguments = tuple(self.types_of(joints))
            self.dispatcher.compile(arguments)
            result = self.dispatcher.overloads[arguments]
            if not (address := result.library.get_pointer_to_function(result.fndesc.mangled_name)):
                raise RuntimeError(f"{self._name} was compiled and has no address")
            llvmlite.binding.add_symbol(self.symbol(arguments), address)
            # Not before: who finds it linked loads what calls it, and a symbol without address is a jump to nowhere.
            self._known.add(arguments)
            self._linked.add(joints)

    def _typed(self, arguments: tuple[Any, ...]) -> Any:
        if arguments not in self._known:
            wanted = ", ".join(map(str, arguments))
            raise TypingError(f"{self._name} is not linked for ({wanted}); it is for {[*map(str, self._known)]}")
        symbol, returns = self.symbol(arguments), self.returns

        def build(context: Any, builder: Any, signature: Any, values: Any) -> Any:
            kind = context.call_conv.get_function_type(returns, arguments)
            function = cgutils.get_or_insert_function(builder.module, kind, symbol)
            status, result = context.call_conv.call_function(builder, function, returns, arguments, values)
            with cgutils.if_unlikely(builder, status.is_error):
                context.call_conv.return_status_propagate(builder, status)
            return result

        return returns(*arguments), build

    def _reduce_states(self) -> dict[str, str]:
        return {"module": self.__module__, "name": self._name}

    @classmethod
    def _rebuild(cls, module: str, name: str) -> "Linked":  # type: ignore[override]
        import importlib

        found = getattr(importlib.import_module(module), name)
        assert isinstance(found, cls)
        return found


def linked(types_of: Types, returns: Any = types.none) -> Callable[[Any], Any]:
    """Decorator of a compiled function that returns nothing, or a number of Numba's type `returns`; see the module."""

    def made(dispatcher: Any) -> Any:
        if config.DISABLE_JIT:  # type: ignore[attr-defined]
            return dispatcher
        found = Linked(dispatcher, types_of, returns)
        LINKED.append(found)
        return found

    return made


_LINKING = threading.RLock()


def link(joints: int) -> None:
    """Make the addresses of all linked functions known, for an arm with `joints` joints; waits for another thread that does so."""
    with _LINKING:
        for function in LINKED:
            # What a function calls stands before it, for its module was imported first.
            function.link(joints)
