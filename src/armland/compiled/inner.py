"""What is called by compiled code alone is optimised and emitted once, with the function that Python calls.

Numba optimises every compiled function, emits machine code and an entry for Python, and does most of it again in each caller:
a tree of three hundred functions six deep takes more than twice the time that its Python part, typing and lowering, needs.
Here a function that is compiled because another of this package calls it keeps its plain LLVM code; the function that Python
called is linked with all that it reaches, optimised, emitted and cached. Called from Python later, an inner one is compiled
again as one with an entry. Code that others compile is left alone.

This reaches into Numba's own parts, so it is done with the versions only that it was tried with. With others all works as well, and
the first compilation takes two to three times as long.
"""

import threading
from typing import Any

PACKAGE = "armland."

TRIED = ("0.68",)
"""Versions of Numba, major and minor, whose parts are as this module expects."""


class _State(threading.local):
    ours = False
    """Whether the compilation in progress was begun for a function of this package."""
    nested = 0
    """How deep it is below the function that Python called."""


_state = _State()


class Inner:
    """Stands for the entry of a function that has none."""

    def __init__(self, name: str) -> None:
        self.name = name


def deferring() -> bool:
    """Whether what is being compiled is an inner function."""
    return _state.ours and _state.nested > 0


def deferred(library: Any) -> bool:
    """Whether a code library keeps its plain LLVM code."""
    return getattr(library, "armland_deferred", False)


def defer() -> None:
    """Make Numba do so; to be called before anything is compiled. A second call does nothing."""
    import numba
    from numba.core import caching, codegen, cpu, dispatcher

    if ".".join(numba.__version__.split(".")[:2]) not in TRIED or hasattr(dispatcher.Dispatcher, "armland_defers"):
        return
    dispatcher.Dispatcher.armland_defers = True  # type: ignore[attr-defined]
    _defer_compilation(dispatcher, caching)
    _defer_code(codegen.CPUCodeLibrary, cpu.CPUContext)
    _compare_flags_fast()


def _defer_compilation(module: Any, caching: Any) -> None:
    from numba.core.compiler_lock import global_compiler_lock

    functions, compiler = module.Dispatcher, module._FunctionCompiler
    compile_, template, add = functions.compile, functions.get_call_template, functions.add_overload
    flags, save = compiler._customize_flags, caching.Cache.save_overload

    # Whole, not in parts: what another thread compiles as an inner function meanwhile would pass for one with an entry.
    @global_compiler_lock
    def compile_as(self: Any, signature: Any) -> Any:
        arguments = tuple(module.sigutils.normalize_signature(signature)[0])
        existing = self.overloads.get(arguments)
        if existing is not None and deferred(existing.library) and not _state.nested:
            del self.overloads[arguments]
        if _state.ours or not self.py_func.__module__.startswith(PACKAGE):
            return compile_(self, signature)
        nested, _state.ours, _state.nested = _state.nested, True, 0
        try:
            return compile_(self, signature)
        finally:
            _state.ours, _state.nested = False, nested

    def get_call_template(self: Any, arguments: Any, keywords: Any) -> Any:
        _state.nested += 1
        try:
            return template(self, arguments, keywords)
        finally:
            _state.nested -= 1

    def customize_flags(self: Any, options: Any) -> Any:
        options = flags(self, options)
        if _state.ours:
            options.no_cfunc_wrapper, options.no_cpython_wrapper = True, _state.nested > 0
        return options

    def add_overload(self: Any, result: Any) -> None:
        if deferred(result.library):
            self.overloads[tuple(result.signature.args)] = result
        else:
            add(self, result)

    def save_overload(self: Any, signature: Any, result: Any) -> None:
        if not deferred(result.library):
            save(self, signature, result)

    functions.compile, functions.get_call_template, functions.add_overload = compile_as, get_call_template, add_overload
    compiler._customize_flags, caching.Cache.save_overload = customize_flags, save_overload


def _defer_code(library: Any, context: Any) -> None:
    from numba.core.environment import lookup_environment

    from armland.compiled.stack import optimise

    finalize, optimize, executable = library.finalize, library._optimize_functions, context.get_executable
    optimize_whole = library._optimize_final_module

    def finalize_or_defer(self: Any) -> None:
        if deferring():
            self._raise_if_finalized()
            self._finalized = self.armland_deferred = True
            return
        self._linking_libraries = _reached(self._linking_libraries)
        finalize(self)
        codes = self.codegen
        for variable in self._final_module.global_variables:
            # What a function holds of Python's is found through these.
            environment = lookup_environment(variable.name) if variable.name.startswith("_ZN08NumbaEnv") else None
            if environment is not None and codes._engine.get_global_value_address(variable.name):
                codes.set_env(variable.name, environment)

    def optimize_functions(self: Any, module: Any) -> None:
        if deferring():
            module.data_layout = self._codegen._data_layout
        else:
            optimize(self, module)

    def optimize_final_module(self: Any) -> None:
        if _state.ours:
            optimise(self)
        else:
            optimize_whole(self)

    def get_executable(self: Any, code: Any, description: Any, environment: Any) -> Any:
        if deferring():
            # What comes from the cache is whole.
            code._ensure_finalized()
        if deferred(code):
            return Inner(description.qualname)
        _refuse_unknown(code, description.qualname)
        return executable(self, code, description, environment)

    library.finalize, library._optimize_functions = finalize_or_defer, optimize_functions
    library._optimize_final_module = optimize_final_module
    context.get_executable = get_executable


def _refuse_unknown(code: Any, name: str) -> None:
    # LLVM takes a symbol that nobody knows for the address 0, and the call for a crash. What comes from the cache may call one:
    # sources that changed while the process ran have had others compiled.
    from llvmlite.binding import address_of_symbol

    for function in (code._shared_module or code._final_module).functions:
        if function.is_declaration and function.name.startswith(PACKAGE) and not address_of_symbol(function.name):
            raise RuntimeError(f"{name} calls {function.name}, whose address is not known: `linking.link` comes first")


def _reached(libraries: Any) -> list[Any]:
    found, ahead = {}, list(libraries)
    while ahead:
        library = ahead.pop(0)
        if id(library) not in found:
            found[id(library)] = library
            if deferred(library):
                ahead += library._linking_libraries
    return list(found.values())


def _compare_flags_fast() -> None:
    # A tenth of the Python part: sets of options are hashed and compared whenever a type is resolved.
    from numba.core.targetconfig import TargetConfig

    equal = TargetConfig.__eq__

    def __eq__(self: Any, other: Any) -> Any:
        if isinstance(other, TargetConfig) and type(self) is type(other) and self._values == other._values:
            return True
        return equal(self, other)

    TargetConfig.__eq__ = __eq__  # type: ignore[method-assign]
    TargetConfig.__hash__ = lambda self: hash(type(self))  # type: ignore[method-assign]
