"""Small arrays that never leave the function that makes them stand on its stack: no memory is asked for, no reference counted.

Numba asks for memory for every array, a vector of three numbers too, and counts its references with atomic instructions;
a tick of the experiments' loop made 150 to 290 of them. Once inner functions have been put into their callers most of them are made and
dropped in one function. There they become variables of LLVM's, which the optimiser keeps in registers.

An array is moved where its size is a constant and its handle is used by nothing but these: the check that there was memory, the
reference counts, and the question where its numbers are. It is then known to be dropped before the function returns, and before
the same place makes the next one: a handle that lived on would be stored, returned, passed on or merged with another one.
"""

import re
from collections import Counter
from typing import Any

from llvmlite.binding import Linkage, parse_assembly

ROUNDS = 2
"""Times that arrays are looked for: what the optimiser puts into its callers after the first brings more of them together."""

GROWTH = 4000
"""Lines of LLVM code by which copies of one function may make a module longer."""

MOST = 2048
"""Largest array that is moved, bytes."""

_HEADER, _DATA = 24, 64
"""Where Numba's handle of an array keeps the address of its numbers, and where they stand here, bytes from the handle's begin."""

_FUNCTION = re.compile(r"^(?=define )", re.MULTILINE)
_CALLED = re.compile(r"\bcall [^@\n]*@(\"[^\"]+\"|[\w.$]+)\(")
_DEFINED = re.compile(r"@(\"[^\"]+\"|[\w.$]+)\(")
_NAME = re.compile(r"%[\w.$-]+|%\"[^\"]+\"")
_MADE = re.compile(
    r"^  (%[\w.]+) = (?:tail )?call [^@]*@NRT_MemInfo_alloc_aligned\(i64 (?:range\([^)]*\) )?(?:noundef )?(\d+), "
)
_COUNTED = re.compile(r"call void @NRT_(?:inc|dec)ref\(")
_WHERE = re.compile(r"^  (\S+) = (?:tail )?call [^@]*@NRT_MemInfo_data_fast\(")
_HARMLESS = re.compile(rf"^  \S+ = (?:icmp \w+ ptr \S+, null|getelementptr [a-z ]*i8, ptr \S+, i64 {_HEADER})(?:,|$)")


def optimise(library: Any) -> None:
    """Optimise the whole module of a code library, inner functions put into their callers and small arrays on the stack."""
    small = embeddable(str(library._final_module))
    for function in library._final_module.functions:
        # Nobody else can call them: what stands in all its callers is dropped. Numba's own reference counts are left alone.
        if function.linkage is Linkage.linkonce_odr and not function.name.startswith("NRT_"):
            function.linkage = Linkage.internal
            if function.name in small and not any(b"noinline" in group for group in function.attributes):
                function.add_function_attribute("alwaysinline")
    _run(library)
    for _ in range(ROUNDS):
        moved = put_on_stack(str(library._final_module))
        if moved is None:
            return
        try:
            module = parse_assembly(moved)
        except RuntimeError:
            # What was optimised so far is whole.
            return
        module.name, library._final_module = library._final_module.name, module
        _run(library)


def _run(library: Any) -> None:
    passes, builder = library._codegen._module_pass_manager()
    passes.run(library._final_module, builder)


def embeddable(code: str) -> set[str]:
    """Names of the functions in LLVM `code` of which each caller gets a copy: those called once, and the small ones."""
    calls = Counter(name.strip('"') for name in _CALLED.findall(code))
    found = set()
    for function in _FUNCTION.split(code)[1:]:
        defined = _DEFINED.search(function)
        name = defined[1].strip('"') if defined else ""
        if function.count("\n") * (calls[name] - 1) <= GROWTH:
            found.add(name)
    return found


def put_on_stack(code: str) -> str | None:
    """LLVM code of a module with small local arrays on the stack, from its optimised `code`; None where there is none."""
    head, *functions = _FUNCTION.split(code)
    mark = f".stack{code.count('.stack')}"
    moved = [_moved(f, mark) if "@NRT_MemInfo_alloc_aligned(" in f else None for f in functions]
    if not any(moved):
        return None
    return "".join([head, *(new or old for new, old in zip(moved, functions, strict=True))])


def _moved(function: str, mark: str) -> str | None:
    lines = function.split("\n")
    made = {m[1]: (i, int(m[2])) for i, line in enumerate(lines) if (m := _MADE.match(line)) and int(m[2]) <= MOST}
    uses = [(i, n) for i, line in enumerate(lines) for n in made.keys() & set(_NAME.findall(line)) if made[n][0] != i]
    local = made.keys() - {name for i, name in uses if not _allowed(lines[i])}
    if not local:
        return None
    for i, name in uses:
        if name not in local:
            continue
        if _COUNTED.search(lines[i]):
            lines[i] = ""
        elif where := _WHERE.match(lines[i]):
            lines[i] = f"  {where[1]} = getelementptr i8, ptr {name}, i64 {_DATA}"
    room = []
    for name in sorted(local):
        i, size = made[name]
        room.append(f"  {name}{mark} = alloca [{_DATA + size} x i8], align 32")
        lines[i] = (
            f"  {name} = getelementptr i8, ptr {name}{mark}, i64 0\n"
            f"  {name}{mark}.data = getelementptr i8, ptr {name}, i64 {_DATA}\n"
            f"  {name}{mark}.header = getelementptr i8, ptr {name}, i64 {_HEADER}\n"
            f"  store ptr {name}{mark}.data, ptr {name}{mark}.header, align 8"
        )
    # Behind the line that opens the function, and its first block's name where it has one.
    first = 2 if re.match(r"^[\w.\"$-]+:", lines[1]) else 1
    lines[first:first] = room
    # A call marked `tail` promises to leave the caller's stack alone.
    return "\n".join(lines).replace(" tail call ", " call ")


def _allowed(line: str) -> bool:
    return bool(_COUNTED.search(line) or _WHERE.match(line) or _HARMLESS.match(line))
