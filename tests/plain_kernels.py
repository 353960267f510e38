"""How is a kernel called from a test without being compiled?"""

import builtins
from collections.abc import Callable
from types import CodeType, FunctionType
from typing import Any


def in_python(kernel: Any, **instead: Any) -> Callable[..., Any]:
    """A kernel, and every kernel that it calls, as the plain Python that they are; `instead`: what stands in for some of them.

    Small kernels are asked about single decisions this way, with made-up answers of those that they call.
    """
    made: dict[CodeType, FunctionType] = {}

    def plain(value: Any) -> Any:
        body = getattr(value, "py_func", value)
        if not isinstance(body, FunctionType) or not body.__module__.startswith("watchsim."):
            return value
        if body.__code__ not in made:
            known: dict[str, Any] = {"__builtins__": builtins}
            made[body.__code__] = FunctionType(body.__code__, known, body.__name__, body.__defaults__, body.__closure__)
            for name in body.__code__.co_names:
                if name in instead or name in body.__globals__:
                    known[name] = instead[name] if name in instead else plain(body.__globals__[name])
        return made[body.__code__]

    function: Callable[..., Any] = plain(kernel)
    return function
