"""What are the functions of a source called, and in which of them is a line?"""

from __future__ import annotations

import ast
from collections import Counter
from functools import cache
from pathlib import Path
from typing import NamedTuple

MODULE = ""  # the "function" of what is done while a file is imported


class Function(NamedTuple):
    """Where a function stands: its first line with decorators, that of its body, and its last one."""

    first: int
    body: int
    last: int
    name: str


def functions(source: str) -> list[Function]:
    """Every function, inner ones after what they stand in. Those of one name are told apart by their order."""
    found: list[Function] = []
    seen: Counter[str] = Counter()

    def look(node: ast.AST, prefix: str) -> None:
        for child in ast.iter_child_nodes(node):
            inner = prefix
            if isinstance(child, (ast.FunctionDef, ast.ClassDef, ast.Lambda)):
                name = prefix + getattr(child, "name", "lambda")
                inner = name + "."
            if isinstance(child, (ast.FunctionDef, ast.Lambda)):
                seen[name] += 1
                first = min([child.lineno, *(one.lineno for one in getattr(child, "decorator_list", []))])
                body = child.body[0].lineno if isinstance(child, ast.FunctionDef) else child.lineno
                own = name if seen[name] == 1 else f"{name} {seen[name]}"
                found.append(Function(first, body, child.end_lineno or child.lineno, own))
            look(child, inner)

    look(ast.parse(source), "")
    return found


def function_of(source: str, line: int) -> str:
    """The name of the innermost function in whose body a line is; MODULE where it is in none (defaults, constants)."""
    holding = [one for one in functions(source) if one.body <= line <= one.last]
    return max(holding, default=Function(0, 0, 0, MODULE)).name


@cache
def names_at(path: str) -> dict[int, list[str]]:
    """The names of the functions that begin in a line of a file."""
    found: dict[int, list[str]] = {}
    for one in functions(Path(path).read_text(encoding="utf-8")):
        found.setdefault(one.first, []).append(one.name)
    return found
