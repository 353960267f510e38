"""How long is a run in each of its kernels? The event loop, compiled anew with a clock around some of them.

The processor's own counter is read when such a kernel begins and when it ends; what kernels with a clock take within is left
out. Each run is a whole one, and nothing is estimated: this shares nothing with watchsim.bench but the kernels.
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

WITHIN, FIRST = 0, 1  # places on the board: ticks of the clocks within, then ticks and calls of each kernel
BOARD = np.zeros(100, np.int64)
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
    """The kernel, its ticks and calls added up at this place of the board."""

    def clocked(*arguments):  # type: ignore[no-untyped-def]
        before = read(WITHIN)
        write(WITHIN, 0)
        begun = ticks()
        result = kernel(*arguments)
        taken = ticks() - begun
        write(place, read(place) + taken - read(WITHIN))
        write(place + 1, read(place + 1) + 1)
        write(WITHIN, before + taken)
        return result

    clocked.__qualname__ = f"{kernel.py_func.__qualname__}_by_the_clock"
    return jit.kernel(clocked)


def globals_read(function: Any) -> set[str]:
    """Names that the function looks up in its module: `co_names` holds those of attributes, too."""
    return {step.argval for step in dis.get_instructions(function) if step.opname == "LOAD_GLOBAL"}


def clocked_loop(entry: Any, names: tuple[str, ...]) -> tuple[Callable[..., Any], Callable[[], dict[str, tuple[int, int]]]]:
    """(`entry` with clocks around the named kernels below it, what reads them: name -> (ticks, calls)).

    Each kernel below the entry is compiled anew under a name of its own: under the old one, the machine code that is loaded for
    the old one would be called.
    """
    made: dict[tuple[str, str], Any] = {}

    def anew(function: Any) -> Any:
        around = dict(function.__globals__)
        for name in globals_read(function):
            if hasattr(around.get(name), "targetoptions"):
                around[name] = kernel_anew(around[name])
        copy = types.FunctionType(function.__code__, around, f"anew_{function.__name__}", function.__defaults__)
        copy.__module__, copy.__qualname__ = function.__module__, f"anew_{function.__qualname__}"
        return copy

    def kernel_anew(kernel: Any) -> Any:
        function = kernel.py_func
        key = function.__module__, function.__qualname__
        if kernel.targetoptions.get("inline") == "always":
            return kernel
        if key not in made:
            made[key] = jit.kernel(anew(function))
            if function.__name__ in names:
                made[key] = _with_clock(made[key], FIRST + 2 * names.index(function.__name__))
        return made[key]

    def clocks() -> dict[str, tuple[int, int]]:
        numbers = BOARD[FIRST : FIRST + 2 * len(names)].reshape(-1, 2).tolist()
        BOARD[:] = 0
        return {name: (spent, calls) for name, (spent, calls) in zip(names, numbers, strict=True)}

    return numba.njit(error_model="numpy")(anew(entry.py_func)), clocks
