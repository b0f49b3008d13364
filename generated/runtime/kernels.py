"""Compilation of the kernels by numba, and their use as plain Python without it.

A kernel solves one case, in plain Python with `math`.  A loop applies a kernel to all rows of a
table; only loops are called from Python.  Both are compiled when a loop is first called, and kept
on disk next to their source.  Where numba is missing, or NUMBA_DISABLE_JIT is set, as the command
line of `derive` does, the source runs as Python.

A body reaches the kernels as a `Law`, a few functions of fixed signature, so that the kernels are
compiled once for all bodies.  Python passes a law as one object, and the loop unpacks it with
`opened`.
"""

import hashlib
import os
import sys
from collections.abc import Callable
from contextlib import suppress
from functools import cache, update_wrapper, wraps
from pathlib import Path
from threading import RLock
from typing import Any, NamedTuple, TypeVar, cast

import numpy as np

COMPILED = os.environ.get("NUMBA_DISABLE_JIT", "0") in ("", "0")
"""Whether kernels are compiled."""

if COMPILED:
    try:
        import numba
    except ImportError:
        COMPILED = False

Function = TypeVar("Function", bound=Callable[..., Any])

COMPILING = "compiling the solver of this call, once per installation: up to half a minute ..."
"""What a user reads while kernels are compiled."""

DAMAGED = "a compiled solver on disk cannot be loaded; it is compiled anew"


class Law(NamedTuple):
    """The functions that the kernels need of a body, all for E* = 1; `own` holds its parameters.

    pressure  (x, a, c, own) -> p; zero outside the contact, infinite only at a corner
    state     (a, c, own) -> load, moment, tilt, K_N at the left and the right edge; NaN where
              [-a, c] is not a contact
    slope     (x, own) -> g'(x), g''(x); at a break those of the piece on its right
    series    (a, c, own) -> coefficients of s**(3/2) at the left and the right edge
    breaks    (own) -> points where the formula of the curve changes, from left to right
    solve     inverse.solve, which finds the contact under given loads
    """

    pressure: Any
    state: Any
    slope: Any
    series: Any
    breaks: Any
    solve: Any


if COMPILED:
    from numba import types
    from numba.core import cgutils, event
    from numba.core.caching import FunctionCache
    from numba.experimental import structref
    from numba.extending import intrinsic, overload, register_jitable

    real: Any = types.float64
    whole: Any = types.int64
    vector: Any = types.Array(real, 1, "C")
    matrix: Any = types.Array(real, 2, "C")
    function = types.FunctionType

    def results(count: int) -> Any:
        """The type of a tuple of `count` real numbers."""
        return types.UniTuple(real, count)

    _CURVE = results(5)(real, real, vector), results(2)(real, vector), vector(vector)
    SIGNATURES = Law(
        pressure=real(real, real, real, vector),
        state=_CURVE[0],
        slope=_CURVE[1],
        series=results(2)(real, real, vector),
        breaks=_CURVE[2],
        solve=results(3)(*map(function, _CURVE), vector, real, real, types.boolean),
    )

    # Compiled code is kept on disk only next to files, not in an archive.
    _KEPT = Path(__file__).is_file()
    _SOURCES = hashlib.sha256()
    for _path in sorted(Path(__file__).parent.rglob("*.py")):
        _SOURCES.update(_path.read_bytes())

    @cache
    def _digest(path: str) -> str:
        """The digest of all sources of this package, and of the file at the path."""
        found = _SOURCES.copy()
        found.update(Path(path).read_bytes())
        return found.hexdigest()

    class _Cache(FunctionCache):
        """Compiled code on disk, unless it is damaged or comes from other sources.

        numba itself looks only at the file of the kernel, and not at those of the kernels that it
        calls.
        """

        def __init__(self, function: Callable[..., Any]) -> None:
            super().__init__(function)
            self._function = function
            self._cache_file._source_stamp = _digest(function.__code__.co_filename)

        def load_overload(self, signature: Any, context: Any) -> Any:
            """The compiled code; None if there is none."""
            try:
                found = super().load_overload(signature, context)
                if found is None or self._is_of_this_function(found.fndesc):
                    return found
            except Exception:  # whatever reading a damaged or an old file raises
                pass
            _SAID.say(DAMAGED)
            with suppress(OSError):  # nothing can be written there
                self.flush()
            return None

        def _is_of_this_function(self, found: Any) -> bool:
            known = self._function.__module__, self._function.__qualname__
            return (found.modname, found.qualname) == known

    def _made(function: Callable[..., Any], called: bool = False, value: bool = False) -> Any:
        """The function for numba.

        called: whether Python calls it; value: whether it is passed to another function.
        """
        made = numba.njit(
            nogil=True,
            error_model="numpy",
            no_cpython_wrapper=not called,
            no_cfunc_wrapper=not value,
        )(function)
        if _KEPT:
            with suppress(OSError, RuntimeError):  # not in a file, or nothing can be written
                made._cache = _Cache(function)
        return made

    def shared(function: Function) -> Function:
        """Let kernels call a function that is written with NumPy or `math`, and Python, too."""
        made: Function = register_jitable(function)
        return made

    def kernel(function: Function) -> Function:
        """Compile a function that only kernels and loops call, for the types that they pass."""
        made: Function = _made(function)
        return made

    class _Said(event.Listener):
        """Lines on standard error, each once: numba compiles, or what it loads is damaged."""

        def __init__(self) -> None:
            self.lines: set[str] = set()

        def say(self, line: str) -> None:
            """Print a line if it has not been printed."""
            if sys.stderr is not None and line not in self.lines:
                self.lines.add(line)
                print(line, file=sys.stderr, flush=True)

        def on_start(self, _: Any) -> None:
            """Say that numba compiles."""
            self.say(COMPILING if _KEPT else COMPILING.replace("installation", "process"))

        def on_end(self, _: Any) -> None:
            """Say nothing more."""

    _SAID = _Said()

    _ONE_THREAD = RLock()

    def _compiled(made: Any, signature: Any) -> Any:
        """The function with one signature, compiled or loaded by the first thread that calls it."""
        with _ONE_THREAD, event.install_listener("numba:compile", _SAID):
            if not made.signatures:
                made.compile(signature)
                made.disable_compile()
        return made

    class _Loop:
        """A loop over cases, compiled when it is first called."""

        def __init__(self, function: Callable[..., Any]) -> None:
            update_wrapper(self, function)
            self._call = _made(function, called=True)
            self._ready = False

        def __call__(self, *given: Any) -> None:
            """Fill the last table, one row per case; the law of a body, if needed, comes first."""
            if not self._ready:
                kinds = [matrix if isinstance(v, np.ndarray) else _HELD for v in given]
                self._call, self._ready = _compiled(self._call, types.void(*kinds)), True
            self._call(*given)

        def __reduce__(self) -> str:
            return self.__name__  # type: ignore[attr-defined]

    def loop(function: Function) -> Function:
        """Compile a function that Python calls, when it is first called."""
        return cast(Function, _Loop(function))

    @structref.register
    class _HeldType(types.StructRef):
        """The type of a law that Python holds."""

    class _Held(structref.StructRefProxy):
        """A law that Python holds; numba unpacks it far faster than a tuple of functions."""

    structref.define_proxy(_Held, _HeldType, [*Law._fields])
    _FUNCTIONS = tuple(map(function, SIGNATURES))
    _HELD = _HeldType(tuple(zip(Law._fields, _FUNCTIONS, strict=True)))

    @kernel
    def opened(law: Any) -> Law:
        """The law that Python holds, as kernels take it."""
        return Law(law.pressure, law.state, law.slope, law.series, law.breaks, law.solve)

    def _hold(pressure: Any, state: Any, slope: Any, series: Any, breaks: Any, solve: Any) -> Any:
        return _Held(pressure, state, slope, series, breaks, solve)

    _HOLD = _made(_hold, called=True)

    @cache
    def _value(function: Callable[..., Any], signature: Any) -> Any:
        """A function that is passed to another one, compiled if necessary."""
        return _compiled(_made(function, value=True), signature)

    def handed(law: Law) -> Any:
        """A law in the form in which Python passes it to a loop; compiled if necessary."""
        functions = map(_value, law, SIGNATURES)
        if not _HOLD.signatures:
            _compiled(_HOLD, _HELD(*_FUNCTIONS))
        return _HOLD(*functions)

    def value_of(signature: Any) -> Any:
        """Turn a kernel into a value.  Code that holds numba's own values is not kept on disk."""

        @intrinsic  # type: ignore[untyped-decorator]
        def value(_: Any, given: Any) -> Any:
            def code(context: Any, builder: Any, *_: Any) -> Any:
                compiled = given.dispatcher.get_compile_result(signature)
                context.active_code_library.add_linking_library(compiled.library)
                found = context.declare_function(builder.module, compiled.fndesc)
                made = cgutils.create_struct_proxy(function(signature))(context, builder)
                made.jit_addr = made.c_addr = builder.bitcast(found, cgutils.voidptr_t)
                return made._getvalue()

            return function(signature)(given), code

        return value

else:

    class _Type:
        """Substitute for every type and signature without numba."""

        def __call__(self, *_: Any) -> Any:
            return self

    real = whole = vector = matrix = function = _Type()

    def results(count: int) -> Any:
        """Substitute for the type of a tuple of numbers."""
        return real

    def kernel(function: Function) -> Function:
        """Leave a function as it is."""
        return function

    def shared(function: Function) -> Function:
        """Leave a function as it is."""
        return function

    def loop(function: Function) -> Function:
        """Run a function without floating-point warnings, as compiled code does."""

        @wraps(function)
        def quiet(*tables: Any) -> None:
            with np.errstate(all="ignore"):
                function(*tables)

        return cast(Function, quiet)

    def value_of(signature: Any) -> Any:
        """The function itself."""
        return lambda given: given

    def opened(law: Any) -> Law:
        """The law itself."""
        return law

    def handed(law: Law) -> Any:
        """The law itself."""
        return law


def where(condition: Any, first: Any, second: Any) -> Any:
    """`first` where the condition holds, else `second`; numbers or arrays.

    >>> float(where(1 < 2, 3.0, 4.0))
    3.0
    """
    return np.where(condition, first, second)[()]


if COMPILED:

    @overload(where)
    def _where(condition, first, second):  # type: ignore[no-untyped-def]
        """`where` for two numbers; numba's own np.where would return arrays."""
        return lambda condition, first, second: first if condition else second
