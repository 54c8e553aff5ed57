"""Small changes of a Python source that a good test notices: signs, terms, indices, comparisons, halves, bounds.

| kind | for example |
|---|---|
| sign | `a + b` becomes `a - b`, `-a` becomes `a` |
| term | `a + b` becomes `a`, or `b`; `a * b` becomes `a / b` |
| index | `x[0]` becomes `x[1]`, `x[i, j]` becomes `x[j, i]`, `x[:3]` becomes `x[3:]` |
| comparison | `a < b` becomes `a >= b`; for whole numbers `a <= b` as well; `and` becomes `or`, `not a` becomes `a` |
| number | `0.5` becomes `1.0`, `2.0` becomes `1.0`; a whole number in a sum or a range becomes one more |
| bound | `min` becomes `max`, `sin` becomes `cos` |
"""

import ast
from collections import Counter
from collections.abc import Iterator
from typing import NamedTuple

SWAPPED = {"min": "max", "minimum": "maximum", "fmin": "fmax", "sin": "cos", "argmin": "argmax", "any": "all"}
SWAPPED |= {new: old for old, new in SWAPPED.items()}
OPPOSITE: dict[type[ast.cmpop], type[ast.cmpop]] = {
    ast.Lt: ast.GtE,
    ast.LtE: ast.Gt,
    ast.Gt: ast.LtE,
    ast.GtE: ast.Lt,
    ast.Eq: ast.NotEq,
    ast.NotEq: ast.Eq,
    ast.Is: ast.IsNot,
    ast.IsNot: ast.Is,
    ast.In: ast.NotIn,
    ast.NotIn: ast.In,
}
BOUNDARY: dict[type[ast.cmpop], type[ast.cmpop]] = {ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt}
WHOLE = {"k", "i", "j", "n", "tick", "count", "ticks", "joints", "phase", "retries", "end", "first", "size"}
"""Names of whole numbers, for which `<` and `<=` differ."""
CONSTANTS = {0.5: 1.0, 2.0: 1.0, 1.5: 1.0}


class Change(NamedTuple):
    """One change of a module: the text from `start` to `end`, in characters, becomes `after`."""

    module: str
    line: int
    function: str
    before: str
    after: str
    start: int
    end: int
    number: int
    """Which of those with the same words in the same function it is, from 1."""

    @property
    def key(self) -> str:
        """What names the change for as long as the function stands as it is, wherever its lines are."""
        number = f" #{self.number}" if self.number > 1 else ""
        return f"{self.module}:{self.function}: {self.before} -> {self.after}{number}"

    @property
    def place(self) -> str:
        """File and line."""
        return f"{self.module}:{self.line}"

    def applied(self, source: str) -> str:
        """The source of the module with the change made."""
        return source[: self.start] + self.after + source[self.end :]


def changes(module: str, source: str) -> list[Change]:
    """All changes of a module's source."""
    offsets = [0]
    for line in source.splitlines(keepends=True):
        offsets.append(offsets[-1] + len(line))
    lines = source.split("\n")

    def at(line: int, column: int) -> int:
        # The parser counts columns in bytes.
        return offsets[line - 1] + len(lines[line - 1].encode()[:column].decode())

    found: list[Change] = []
    seen: Counter[str] = Counter()
    for function, node, new in _sites(ast.parse(source), ""):
        start, end = at(node.lineno, node.col_offset), at(node.end_lineno, node.end_col_offset)
        before, after = " ".join(source[start:end].split()), ast.unparse(new)
        # In brackets, so that it stays one operand of what surrounds it.
        after = (
            f"({after})"
            if isinstance(new, ast.expr) and not isinstance(new, ast.Name | ast.Constant | ast.Call)
            else after
        )
        words = f"{function}: {before} -> {after}"
        seen[words] += 1
        found.append(Change(module, node.lineno, function, before, after, start, end, seen[words]))
    return found


def _sites(node: ast.AST, function: str) -> Iterator[tuple[str, ast.AST, ast.AST]]:
    # Function, node and what it becomes, for all nodes in bodies of functions.
    for child in _living(node):
        name = function
        if isinstance(child, ast.FunctionDef | ast.ClassDef):
            name = f"{function}.{child.name}".lstrip(".")
        elif function:
            for new in _variants(child):
                yield function, child, new
        yield from _sites(child, name)


def _living(node: ast.AST) -> Iterator[ast.AST]:
    # Children that compute: no annotations, decorators, docstrings, messages, layouts of records.
    if isinstance(node, ast.FunctionDef):
        yield from [] if node.name.endswith("layout") else node.body
    elif isinstance(node, ast.AnnAssign):
        yield from [node.value] if node.value is not None else []
    elif isinstance(node, ast.ClassDef):
        yield from (n for n in node.body if isinstance(n, ast.FunctionDef | ast.ClassDef))
    elif not isinstance(node, ast.Raise | ast.JoinedStr | ast.Assert | ast.Import | ast.ImportFrom):
        docstring = isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)
        yield from [] if docstring else ast.iter_child_nodes(node)


def _variants(node: ast.AST) -> Iterator[ast.AST]:
    match node:
        case ast.BinOp(left, ast.Add() | ast.Sub() as op, right) if not _text(left) and not _text(right):
            yield ast.BinOp(left, ast.Sub() if isinstance(op, ast.Add) else ast.Add(), right)
            yield left
            yield right if isinstance(op, ast.Add) else ast.UnaryOp(ast.USub(), right)
            yield from (ast.BinOp(left, op, more) for more in _one_more(right))
        case ast.BinOp(left, ast.Mult() | ast.Div() as op, right) if not _text(left) and not isinstance(left, ast.List):
            yield ast.BinOp(left, ast.Div() if isinstance(op, ast.Mult) else ast.Mult(), right)
        case ast.BinOp(left, ast.MatMult(), right) if isinstance(left, ast.Attribute) and left.attr == "T":
            yield ast.BinOp(left.value, ast.MatMult(), right)
        case ast.AugAssign(target, ast.Add() | ast.Sub() as op, value):
            yield ast.AugAssign(target, ast.Sub() if isinstance(op, ast.Add) else ast.Add(), value)
            yield ast.Pass()
        case ast.AugAssign(target, ast.Mult() | ast.Div() as op, value):
            yield ast.AugAssign(target, ast.Div() if isinstance(op, ast.Mult) else ast.Mult(), value)
        case ast.UnaryOp(ast.USub() | ast.Not(), operand):
            yield operand
        case ast.Compare(left, [op], [right]) if type(op) in OPPOSITE:
            yield ast.Compare(left, [OPPOSITE[type(op)]()], [right])
            if type(op) in BOUNDARY and (_whole(left) or _whole(right)):
                yield ast.Compare(left, [BOUNDARY[type(op)]()], [right])
        case ast.BoolOp(op, values):
            yield ast.BoolOp(ast.Or() if isinstance(op, ast.And) else ast.And(), values)
        case ast.Constant(float() as value) if value in CONSTANTS:
            yield ast.Constant(CONSTANTS[value])
        case ast.Call(ast.Name(name), arguments, keywords) if name in SWAPPED:
            yield ast.Call(ast.Name(SWAPPED[name]), arguments, keywords)
        case ast.Call(ast.Name("range"), [*before, last], _):
            yield from (ast.Call(ast.Name("range"), [*before, more], []) for more in _one_more(last))
        case ast.Call(ast.Attribute(owner, name), arguments, keywords) if name in SWAPPED:
            yield ast.Call(ast.Attribute(owner, SWAPPED[name]), arguments, keywords)
        case ast.Subscript(value, index):
            yield from (ast.Subscript(value, other) for other in _indices(index))


def _indices(index: ast.expr) -> Iterator[ast.expr]:
    match index:
        case ast.Constant(int() as value) if not isinstance(value, bool):
            yield ast.Constant(value - 1 if value == 2 else value + 1)
        case ast.Tuple([first, second]) if ast.dump(first) != ast.dump(second):
            yield ast.Tuple([second, first])
            yield from (ast.Tuple([other, second]) for other in _indices(first))
            yield from (ast.Tuple([first, other]) for other in _indices(second))
        case ast.Slice(None, ast.expr() as upper, None):
            yield ast.Slice(upper, None, None)
        case ast.Slice(ast.expr() as lower, None, None):
            yield ast.Slice(None, lower, None)


def _one_more(node: ast.expr) -> Iterator[ast.expr]:
    if isinstance(node, ast.Constant) and type(node.value) is int:
        yield ast.Constant(node.value + 1)


def _whole(node: ast.expr) -> bool:
    name = node.id if isinstance(node, ast.Name) else node.attr if isinstance(node, ast.Attribute) else ""
    return (isinstance(node, ast.Constant) and type(node.value) is int) or name in WHOLE or name.endswith("tick")


def _text(node: ast.expr) -> bool:
    return isinstance(node, ast.JoinedStr | ast.List) or (
        isinstance(node, ast.Constant) and isinstance(node.value, str)
    )
