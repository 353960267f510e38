"""How is a kernel compiled?

The only file that imports numba. `NUMBA_DISABLE_JIT=1` leaves kernels plain Python. What each departure from plain `njit`
saves stands in docs/develop/design.md; with a release of numba that was not tried, those that need its private classes are
left out (`as_tried`).
"""

from __future__ import annotations

import functools
import hashlib
import inspect
import os
import sys
from collections.abc import Callable
from typing import Any, TypeVar

from watchsim.jit_cache import MOVE, cache_folder, checked_files, complain, one_compiles

Function = TypeVar("Function", bound=Callable[..., Any])

TRIED = ((0, 60), (0, 68))  # first and last release of numba whose private classes were tried, as in pyproject.toml


def kernel(function: Function) -> Function:
    """Compile `function` as a part of the entries that call it; from Python use `entry(function)` or `callable_kernel`.

    Division by zero gives inf or nan as in numpy; no fast-math, which would make isnan(nan) False. Parts own no memory and
    count no references: the entry's caller holds all arrays.
    """
    lazy: Any = LazyKernel(function, _part)
    return lazy if is_compiled() else function


def hot_kernel(function: Function) -> Function:
    """As `kernel`, for small functions of the innermost loops: their machine code stands in that of all who call them.

    Left to itself LLVM calls most of them, which makes a run of a lever a quarter longer.
    """
    lazy: Any = LazyKernel(function, functools.partial(_part, forceinline=True))
    return lazy if is_compiled() else function


def entry(function: Function) -> Function:
    """Compile `function`, for Python or for kernels to call, at its first call; later processes find the machine code.

    Other threads may run Python meanwhile.
    """
    lazy: Any = LazyEntry(function, _entry)
    return lazy if is_compiled() else function


def inlined(function: Function) -> Function:
    """Compile `function` into the body of whoever calls it: what it makes by reference lives as long as its caller runs."""
    lazy: Any = LazyKernel(function, _inlined)
    return lazy if is_compiled() else function


class LazyKernel:
    """A kernel whose dispatcher is made when a compiler asks for its type: hardly ever, since entries are in the cache.

    Numba is not loaded before: that takes longer than all else that has to be loaded to read a scene.
    """

    def __init__(self, function: Callable[..., Any], compiled: Callable[..., Any]) -> None:
        self.py_func, self._compiled = function, compiled
        self.__name__, self.__doc__, self.__module__ = function.__name__, function.__doc__, function.__module__
        self.__wrapped__ = function

    @functools.cached_property
    def dispatcher(self) -> Any:
        """What numba compiles."""
        _define_references()
        return self._compiled(self.py_func)

    @property
    def _numba_type_(self) -> Any:
        return self.dispatcher._numba_type_

    def __getattr__(self, name: str) -> Any:
        """What numba asks of a dispatcher, such as whether to inline it."""
        if name.startswith("__"):
            raise AttributeError(name)
        return getattr(self.dispatcher, name)


class LazyEntry(LazyKernel):
    """The same, for Python to call."""

    def __call__(self, *values: Any) -> Any:
        return self.dispatcher(*values)


def _part(function: Callable[..., Any], **more: Any) -> Any:
    import numba

    # No wrapper for calls from Python: unpacking records there would take longer to compile than the kernels themselves.
    options = {"error_model": "numpy", "no_cpython_wrapper": True, "no_cfunc_wrapper": True, **more}
    if as_tried():
        options |= {"_nrt": False, "pipeline_class": _part_compiler()}
    return numba.njit(**options)(function)


def _inlined(function: Callable[..., Any]) -> Any:
    import numba

    return numba.njit(inline="always", error_model="numpy")(function)


def _entry(function: Callable[..., Any]) -> Any:
    import numba

    folder = cache_folder()
    before, numba.config.CACHE_DIR = numba.config.CACHE_DIR, str(folder or "")
    try:
        compiled = numba.njit(cache=folder is not None, error_model="numpy", fastmath=False, nogil=True)(function)
        if folder is not None and as_tried():
            checked_files(compiled, complain)
            _load_lightly(compiled)
            one_compiles(compiled, complain)
    except (OSError, RuntimeError) as error:  # the disk has become full, or the folder has been taken away
        complain(f"The machine code cannot be kept in {folder} ({error}): it is compiled each time. {MOVE}")
        compiled = numba.njit(error_model="numpy", fastmath=False, nogil=True)(function)
    finally:
        numba.config.CACHE_DIR = before
    return compiled


@functools.lru_cache(maxsize=1)
def as_tried() -> bool:
    """Is this a release of numba whose private classes are known?"""
    import numba

    major, minor = numba.__version__.split(".")[:2]
    return TRIED[0] <= (int(major), int(minor)) <= TRIED[1]


def _load_lightly(compiled: Any) -> None:
    """Load machine code from the cache without what only the compiler needs.

    Numba first imports every function it could compile, half of scipy among it: more than all else that a start takes.
    A function that is not in the cache is compiled as ever: the compiler asks for all this itself.
    """
    from llvmlite import binding
    from numba.core.runtime import _nrt_python, rtsys

    cache = compiled._cache

    def load_overload(signature: Any, target: Any) -> Any:
        # What wrappers for calls from Python use of the counter of references. Numba also compiles the rest of it, which every
        # piece of machine code carries with it.
        for name, place in () if rtsys._init else _nrt_python.c_helpers.items():
            binding.add_symbol(name if name.startswith("_") else f"NRT_{name}", place)
        try:
            data = cache._cache_file.load(cache._index_key(signature, target.codegen()))
            return None if data is None else _rebuilt(cache, target, data)
        except Exception as error:  # whatever it is, the function can be compiled
            complain(f"Machine code in {cache.cache_path} cannot be used ({error}): compiled again. {MOVE}")
            return None

    cache.load_overload = load_overload


def _rebuilt(cache: Any, target: Any, data: Any) -> Any:
    """What numba makes of a file of its cache, but for the code in LLVM's language, which is put by.

    It lies beside the machine code for functions that are compiled later and call this one: with a large function two thirds of
    the time that loading takes, and hardly ever needed.
    """
    (name, kind, code), about, *rest = data
    if kind != "object":
        return cache._impl.rebuild(target, data)
    from llvmlite import binding

    machine_code, intermediate = code
    names = (about.llvm_func_name, about.llvm_cpython_wrapper_name, about.llvm_cfunc_wrapper_name)
    defined = "".join(f'define void @"{one}"() {{ ret void }}\n' for one in names)  # numba looks up what is named here only
    code = machine_code, binding.parse_assembly(defined).as_bitcode()
    made = cache._impl.rebuild(target, ((name, kind, code), about, *rest))
    made.library.__class__ = _lazy_library()
    made.library._shared_module, made.library._intermediate = None, intermediate
    return made


@functools.lru_cache(maxsize=1)
def _lazy_library() -> type:
    """Machine code whose LLVM code is read when somebody links it."""
    from llvmlite import binding
    from numba.core.codegen import JITCodeLibrary

    class LazyLibrary(JITCodeLibrary):
        """As every library from the cache, whose `_shared_module` is None until then."""

        _intermediate: bytes
        _shared_module: Any

        def _get_module_for_linking(self) -> Any:
            if self._shared_module is None:
                self._shared_module = binding.parse_bitcode(self._intermediate)
            return super()._get_module_for_linking()

    return LazyLibrary


def callable_kernel(function: Function) -> Function:
    """A kernel made callable from Python, for tests and for researchers."""
    return entry(getattr(function, "py_func", function))


@functools.lru_cache(maxsize=1)
def _part_compiler() -> type:
    """A compiler for kernels that only entries call.

    Numba optimises every function together with all it calls and emits machine code for it: a function ten calls deep goes
    through that ten times and more, for code that nobody calls. Parts are typed and translated as ever, but optimised and
    emitted once, with their entry. The first compile takes a quarter of the time.
    """
    from numba.core.codegen import JITCodeLibrary
    from numba.core.compiler import Compiler

    class NoEnvironment:
        """Parts raise no exceptions and print nothing: they need no Python objects at run time."""

        @staticmethod
        def set_env(*_: Any) -> None:
            """Nothing to set."""

    class Part(JITCodeLibrary):
        """The code of one kernel and of all it calls, linked but not emitted."""

        def finalize(self) -> None:
            self._raise_if_finalized()
            for library in dict.fromkeys(self._linking_libraries):
                if hasattr(library, "_reload_init"):  # releases after 0.60
                    self._reload_init.update(library._reload_init)
                self._final_module.link_in(library._get_module_for_linking(), preserve=True)
            self._finalize_dynamic_globals()
            self._finalized = True

        def get_pointer_to_function(self, name: str) -> int:
            self._ensure_finalized()
            return 0

        @property
        def codegen(self) -> Any:
            return NoEnvironment

    class PartCompiler(Compiler):
        """The usual pipeline, into a `Part`."""

        def define_pipelines(self) -> Any:
            if self.state.library is None:
                self.state.library = Part(self.state.targetctx.codegen(), self.state.func_id.func_qualname)
                self.state.library.enable_object_caching()
            return super().define_pipelines()

    return PartCompiler


def by_reference(record: type, module: str) -> Any:
    """For kernels: a constructor of a struct with the fields of the NamedTuple class `record`, defined in `module`.

    A tuple of arrays is passed to a compiled function by value, a dozen machine words for each array: with tens of arrays
    that dominates compile time. This struct is one pointer, into the stack frame of the function that makes it: make it in
    an entry (or `inlined` there) and only hand it down. Nothing counts references to what it holds: counting took two thirds
    of the whole time. Without the compiler the NamedTuple itself serves.
    """
    if not is_compiled():
        return record
    constructor = type(f"{record.__name__}Ref", (), {"__module__": module})
    _references.append(functools.partial(_define_reference, record, module, constructor))
    return constructor


_references: list[Callable[[], None]] = []  # of which numba does not know yet


def _define_references() -> None:
    """Teach numba the references that modules have requested so far."""
    while _references:
        _references.pop()()


def _reference_type(record: type, module: str) -> Any:
    """The type of references to what has the fields of `record`."""
    from numba.core import types

    def __init__(self: Any, held: tuple[Any, ...]) -> None:
        self.held = held
        # In full it would hold those of all structs within, and stand in the name of every function: megabytes of names.
        digest = hashlib.sha256(str(held).encode()).hexdigest()[:16]
        types.Type.__init__(self, name=f"{record.__name__}({digest})")

    body = {"__module__": module, "__init__": __init__, "names": record._fields}  # type: ignore[attr-defined]
    struct = type(f"{record.__name__}Type", (types.Type,), body)
    # Numba pickles the type into its cache by name.
    setattr(sys.modules[module], struct.__name__, struct)
    return struct


def _define_reference(record: type, module: str, constructor: type) -> None:
    """Teach numba a type of references: how they are laid out, how `constructor` makes one, and how fields are read."""
    from llvmlite import ir
    from numba.core import cgutils, types
    from numba.core.imputils import impl_ret_borrowed, lower_builtin, lower_getattr_generic
    from numba.core.typing.templates import AttributeTemplate, infer_getattr
    from numba.extending import models, register_model, type_callable

    struct = _reference_type(record, module)

    @register_model(struct)
    class Pointer(models.PrimitiveModel):
        """A pointer to the fields, one after another."""

        def __init__(self, manager: Any, reference: Any) -> None:
            fields = ir.LiteralStructType([manager.lookup(field).get_value_type() for field in reference.held])
            super().__init__(manager, reference, fields.as_pointer())

    @type_callable(constructor)
    def type_constructor(_: Any) -> Any:
        def typer(*held: Any) -> Any:
            return struct(held)

        names = [inspect.Parameter(name, inspect.Parameter.POSITIONAL_OR_KEYWORD) for name in struct.names]
        typer.__signature__ = inspect.Signature(names)  # type: ignore[attr-defined]
        return typer

    @lower_builtin(constructor, types.VarArg(types.Any))
    def construct(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        pointer = cgutils.alloca_once(builder, context.get_value_type(signature.return_type).pointee)
        for i, value in enumerate(values):
            builder.store(value, cgutils.gep_inbounds(builder, pointer, 0, i))
        return pointer

    @infer_getattr
    class Fields(AttributeTemplate):
        key = struct

        def generic_resolve(self, reference: Any, name: str) -> Any:
            return reference.held[struct.names.index(name)] if name in struct.names else None

    @lower_getattr_generic(struct)
    def read(context: Any, builder: Any, reference: Any, pointer: Any, name: str) -> Any:
        i = struct.names.index(name)
        value = builder.load(cgutils.gep_inbounds(builder, pointer, 0, i))
        return impl_ret_borrowed(context, builder, reference.held[i], value)


def is_compiled() -> bool:
    """False when NUMBA_DISABLE_JIT asks for plain Python."""
    return os.environ.get("NUMBA_DISABLE_JIT", "0").strip() in ("", "0")


def is_cached(name: str = "") -> bool:
    """True when no compile is to be expected. `name` ("advance.run": file and function) asks about one kernel, "" about any."""
    if not is_compiled():
        return True
    folder = cache_folder()
    return folder is not None and any(folder.glob(f"*/{name}-*.nbi" if name else "*/*.nbi"))
