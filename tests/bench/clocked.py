"""How long is a run in each of its kernels? The event loop, compiled anew with a clock around some of them.

The processor's own counter is read when such a kernel begins and when it ends; what kernels with a clock take within is left
out. Each call is kept by itself: a run does the same again every time, and of the same call in several runs the quickest is the
one that nothing interrupted. Nothing is estimated: this shares nothing with watchsim.bench but the kernels.
"""

from __future__ import annotations

import dis
import types
from collections.abc import Callable
from typing import Any

import numba
import numpy as np
from llvmlite import ir
from numba.core import cgutils
from numba.core import types as numba_types
from numba.extending import intrinsic

from watchsim import jit

WITHIN, FIRST = 0, 1  # places on the board: ticks of the clocks within, then for each kernel its calls and the ticks of each
CALLS = 200_000  # of one kernel that find room
BOARD = np.zeros(FIRST + 10 * (1 + CALLS), np.int64)
WORD = ir.IntType(64)


@intrinsic
def ticks(_context: Any) -> Any:
    """The processor's counter."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        counter = cgutils.get_or_insert_function(builder.module, ir.FunctionType(WORD, ()), "llvm.readcyclecounter")
        return builder.call(counter, ())

    return numba_types.int64(), generate


def _on_board(builder: Any, place: Any) -> Any:
    board = builder.inttoptr(ir.Constant(WORD, BOARD.ctypes.data), WORD.as_pointer())
    return builder.gep(board, [place])


@intrinsic
def read(_context: Any, _place: Any) -> Any:
    """The number at a place of the board."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.load(_on_board(builder, arguments[0]))

    return numba_types.int64(numba_types.int64), generate


@intrinsic
def write(_context: Any, _place: Any, _number: Any) -> Any:
    """Put a number at a place of the board."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        builder.store(arguments[1], _on_board(builder, arguments[0]))
        return context.get_dummy_value()

    return numba_types.void(numba_types.int64, numba_types.int64), generate


def _with_clock(kernel: Any, place: int) -> Any:
    """The kernel, its calls counted at this place of the board and their ticks put behind it."""

    def clocked(*arguments):  # type: ignore[no-untyped-def]
        before = read(WITHIN)
        write(WITHIN, 0)
        begun = ticks()
        result = kernel(*arguments)
        taken = ticks() - begun
        calls = read(place) + 1
        write(place, calls)
        write(place + min(calls, CALLS), taken - read(WITHIN))
        write(WITHIN, before + taken)
        return result

    clocked.__qualname__ = f"{kernel.py_func.__qualname__}_by_the_clock"
    return jit.kernel(clocked)


def globals_read(function: Any) -> set[str]:
    """Names that the function looks up in its module: `co_names` holds those of attributes, too."""
    return {step.argval for step in dis.get_instructions(function) if step.opname == "LOAD_GLOBAL"}


def clocked_loop(entry: Any, names: tuple[str, ...]) -> tuple[Callable[..., Any], Callable[[], dict[str, np.ndarray]]]:
    """(`entry` with clocks around the named kernels below it, what reads them: name -> ticks of each call since the last time).

    Each kernel below the entry is compiled anew under a name of its own: under the old one, the machine code that is loaded for
    the old one would be called.
    """
    made: dict[tuple[str, str], Any] = {}
    parts = BOARD[FIRST:].reshape(-1, 1 + CALLS)[: len(names)]

    def anew(function: Any) -> Any:
        around = dict(function.__globals__)
        for name in globals_read(function):
            if hasattr(around.get(name), "py_func"):
                around[name] = kernel_anew(around[name])
        copy = types.FunctionType(function.__code__, around, f"anew_{function.__name__}", function.__defaults__)
        copy.__module__, copy.__qualname__ = function.__module__, f"anew_{function.__qualname__}"
        return copy

    def kernel_anew(kernel: Any) -> Any:
        function = kernel.py_func
        key = function.__module__, function.__qualname__
        if getattr(kernel, "targetoptions", {}).get("inline") == "always":
            return kernel
        if key not in made:
            made[key] = jit.kernel(anew(function))
            if function.__name__ in names:
                made[key] = _with_clock(made[key], FIRST + (1 + CALLS) * names.index(function.__name__))
        return made[key]

    def clocks() -> dict[str, np.ndarray]:
        assert parts[:, 0].max() <= CALLS
        found = {name: part[1 : 1 + part[0]].copy() for name, part in zip(names, parts, strict=True)}
        parts[:, 0] = 0
        return found

    return numba.njit(error_model="numpy")(anew(entry.py_func)), clocks
