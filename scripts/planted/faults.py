"""Which small faults can be planted in a source file?

One at a time: a comparison turned round, an operator or function exchanged for its like, a sign lost, a number changed. What
steers no computation is not changed: texts, annotations, imports, default documentation.
"""

import ast
from collections.abc import Iterator
from dataclasses import dataclass

COMPARISONS: dict[type[ast.cmpop], type[ast.cmpop]] = {
    **{ast.Lt: ast.GtE, ast.LtE: ast.Gt, ast.Gt: ast.LtE, ast.GtE: ast.Lt, ast.Eq: ast.NotEq, ast.NotEq: ast.Eq},
    **{ast.Is: ast.IsNot, ast.IsNot: ast.Is, ast.In: ast.NotIn, ast.NotIn: ast.In},
}
OPERATORS: dict[type[ast.operator], type[ast.operator]] = {
    **{ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult, ast.Mod: ast.Mult},
    **{ast.FloorDiv: ast.Mult, ast.BitAnd: ast.BitOr, ast.BitOr: ast.BitAnd},
}
LIKE = {"sin": "cos", "cos": "sin", "min": "max", "max": "min", "floor": "ceil", "ceil": "floor", "any": "all", "all": "any"}
FACTOR = 1.25  # by which a number with a point is changed


@dataclass(frozen=True)
class Fault:
    """What stands at (line, column) of a file, and what it is replaced by."""

    line: int
    column: int
    before: str
    after: str
    source: str  # the whole file with the fault in it


def faults(source: str) -> Iterator[Fault]:
    """Every fault that can be planted in this text."""
    tree = ast.parse(source)
    quiet = _quiet(tree)
    lines = source.encode().splitlines(keepends=True)
    for node in ast.walk(tree):
        if id(node) in quiet or not isinstance(node, ast.expr):
            continue
        for changed in _changed(node):
            before, text = _replaced(lines, node, changed)
            if before != changed:
                yield Fault(node.lineno, node.col_offset, before, changed, text)


def _quiet(tree: ast.Module) -> set[int]:
    """Nodes in which nothing is computed: annotations, texts, what is raised, names of types."""
    found: set[int] = set()
    for node in ast.walk(tree):
        for part in _hushed(node):
            found.update(id(one) for one in ast.walk(part))
    return found


def _hushed(node: ast.AST) -> list[ast.AST]:
    """The parts of a node that compute nothing."""
    if isinstance(node, (ast.Raise, ast.JoinedStr, ast.Import, ast.ImportFrom, ast.Assert)):
        return [node]
    if isinstance(node, ast.FunctionDef):
        return [*node.decorator_list, *([node.returns] if node.returns else [])]
    if isinstance(node, ast.ClassDef):
        return list(node.decorator_list)
    if isinstance(node, (ast.arg, ast.AnnAssign)):
        return [node.annotation] if node.annotation else []
    if isinstance(node, ast.If) and isinstance(node.test, ast.Name) and node.test.id == "TYPE_CHECKING":
        return [node]
    if isinstance(node, ast.Assign) and isinstance(node.value, ast.BinOp) and _is_type(node.value):
        return [node]
    return []


def _is_type(node: ast.BinOp) -> bool:
    """`Side = str | Point` names a type."""
    return isinstance(node.op, ast.BitOr) and isinstance(node.left, (ast.Name, ast.BinOp)) and isinstance(node.right, ast.Name)


def _changed(node: ast.expr) -> Iterator[str]:
    """The texts that a node is exchanged for."""
    if isinstance(node, ast.Compare) and len(node.ops) == 1 and type(node.ops[0]) in COMPARISONS:
        yield ast.unparse(ast.Compare(node.left, [COMPARISONS[type(node.ops[0])]()], node.comparators))
    elif isinstance(node, ast.BinOp) and type(node.op) in OPERATORS and not _is_text(node):
        yield f"({ast.unparse(ast.BinOp(node.left, OPERATORS[type(node.op)](), node.right))})"
    elif isinstance(node, ast.BoolOp):
        other = ast.Or() if isinstance(node.op, ast.And) else ast.And()
        yield f"({ast.unparse(ast.BoolOp(other, node.values))})"
    elif isinstance(node, ast.UnaryOp) and isinstance(node.op, (ast.Not, ast.USub)):
        yield f"({ast.unparse(node.operand)})"
    elif isinstance(node, ast.Call):
        yield from _called(node)
    elif isinstance(node, ast.Constant) and type(node.value) is int:
        yield repr(node.value + 1)
    elif isinstance(node, ast.Constant) and type(node.value) is float:
        yield repr(FACTOR * node.value if node.value else 1e-3)


def _called(node: ast.Call) -> Iterator[str]:
    name = node.func.attr if isinstance(node.func, ast.Attribute) else node.func.id if isinstance(node.func, ast.Name) else ""
    if name in LIKE:
        swapped: ast.expr = (
            ast.Attribute(node.func.value, LIKE[name], ast.Load())
            if isinstance(node.func, ast.Attribute)
            else ast.Name(LIKE[name], ast.Load())
        )
        yield ast.unparse(ast.Call(swapped, node.args, node.keywords))
    elif name in ("abs", "fabs") and len(node.args) == 1:
        yield f"({ast.unparse(node.args[0])})"


def _is_text(node: ast.BinOp) -> bool:
    return any(
        isinstance(one, ast.JoinedStr) or (isinstance(one, ast.Constant) and isinstance(one.value, str))
        for one in ast.walk(node)
    )


def _replaced(lines: list[bytes], node: ast.expr, text: str) -> tuple[str, str]:
    """What stood there, and the whole file with `text` in its place."""
    assert node.end_lineno is not None and node.end_col_offset is not None
    first, last = node.lineno - 1, node.end_lineno - 1
    head, tail = lines[first][: node.col_offset], lines[last][node.end_col_offset :]
    before = b"".join(lines[first : last + 1])[node.col_offset : len(b"".join(lines[first : last + 1])) - len(tail)]
    whole = b"".join((*lines[:first], head, text.encode(), tail, *lines[last + 1 :]))
    return before.decode(), whole.decode()
