"""Compilation of the kernels by numba, and their use without it.

A kernel solves one case, in plain Python with `math`.  This module compiles it and keeps the result
on disk next to its source.  Where numba is missing, or NUMBA_DISABLE_JIT is set, the source runs as
Python.  So does the copy in `derive`, because its commands call each function only a few times.

A body reaches the kernels as a `Law`, a few functions of fixed signature, so that the kernels are
compiled once for all bodies.  Python passes a law as the addresses of its functions, and the kernel
restores it with `opened`, because numba itself takes ten microseconds to unwrap each function.
"""

import sys
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

import numpy as np

from .elementary import where
from .shared import SHARED
from .words import COMPILING, SAID

COMPILED = __name__ != "derive.runtime.kernels"
if COMPILED:
    try:
        import numba
    except ImportError:
        COMPILED = False
    else:
        COMPILED = not numba.config.DISABLE_JIT

Kernel = TypeVar("Kernel", bound=Callable[..., Any])


class Law(NamedTuple):
    """The functions of a body that the kernels need, all for E* = 1; `own` holds its parameters.

    pressure  (x, a, c, own) -> p; zero outside the contact, infinite only at a corner
    state     (a, c, own) -> load, moment, tilt, K_N at the left and the right edge; NaN where
              [-a, c] is not a contact
    slope     (x, own) -> g'(x), g''(x); at a break those of the piece on its right
    series    (a, c, own) -> coefficients of s**(3/2) at the left and the right edge, and of
              s**(5/2); the latter are NaN where they are not available
    breaks    (own) -> points where the formula of the curve changes, from left to right
    """

    pressure: Any
    state: Any
    slope: Any
    series: Any
    breaks: Any


def _remove_stale_kernels() -> None:
    """Remove compiled kernels that are older than any source of the runtime.

    numba only checks the file of the kernel itself.  It would keep compiled code that includes
    functions from other files, even after those files have changed.
    """
    home = Path(__file__).parent
    newest = max(path.stat().st_mtime for path in home.rglob("*.py"))
    for folder in (home.parent, home, *home.glob("*/")):
        for path in folder.glob("__pycache__/*.nb[ic]"):
            with suppress(OSError):
                if path.stat().st_mtime < newest:
                    path.unlink()


if COMPILED:
    from numba import types
    from numba.core import cgutils, event
    from numba.extending import intrinsic, overload, register_jitable

    _remove_stale_kernels()
    real: Any = types.float64
    whole: Any = types.int64
    truth: Any = types.boolean
    vector: Any = types.Array(real, 1, "C")
    matrix: Any = types.Array(real, 2, "C")
    PRESSURE: Any = real(real, real, real, vector)
    STATE: Any = types.UniTuple(real, 5)(real, real, vector)
    SLOPE: Any = types.UniTuple(real, 2)(real, vector)
    SERIES: Any = types.UniTuple(real, 4)(real, real, vector)
    BREAKS: Any = vector(vector)
    SIGNATURES = Law(PRESSURE, STATE, SLOPE, SERIES, BREAKS)
    nothing: Any = types.void
    ADDRESSES = types.Array(types.int64, 1, "C")
    LOOP: Any = nothing(ADDRESSES, matrix, matrix, matrix)

    function = types.FunctionType

    def results(count: int) -> Any:
        """The type of a tuple of `count` real numbers."""
        return types.UniTuple(real, count)

    def record(kind: Any, *fields: Any) -> Any:
        """The type of a named tuple."""
        if len(set(fields)) == 1:
            return types.NamedUniTuple(fields[0], len(fields), kind)
        return types.NamedTuple(fields, kind)

    LAW: Any = record(Law, *map(function, SIGNATURES))

    def kernel(signature: Any) -> Callable[[Kernel], Kernel]:
        """Compile a function for one signature, and keep it on disk."""
        while SHARED:
            register_jitable(SHARED.pop())
        # Python calls only kernels whose arguments are addresses, numbers and arrays; the others
        # need no wrapper
        inside = any(isinstance(t, types.BaseNamedTuple) for t in signature.args)
        compiled = numba.njit(
            signature,
            cache=True,
            nogil=True,
            error_model="numpy",
            no_cfunc_wrapper=True,
            no_cpython_wrapper=inside,
        )

        def made(function: Kernel) -> Kernel:
            with event.install_listener("numba:compile", _ANNOUNCEMENT):
                return compiled(function)

        return made

    @overload(where)
    def _where(condition, first, second):  # type: ignore[no-untyped-def]
        """`where` for two numbers."""
        return lambda condition, first, second: first if condition else second

    class _Announcement(event.Listener):
        """One line on standard error when numba compiles, not when it loads a kernel from disk."""

        def on_start(self, _: Any) -> None:
            if sys.stderr is not None and not SAID:
                SAID.append(COMPILING)
                print(COMPILING, file=sys.stderr, flush=True)

        def on_end(self, _: Any) -> None:
            """Say nothing more."""

    _ANNOUNCEMENT = _Announcement()

    def _function_value(signature: Any, context: Any, builder: Any, address: Any) -> Any:
        """A function as a value, from the address of its code."""
        made = cgutils.create_struct_proxy(function(signature))(context, builder)
        made.jit_addr = made.c_addr = address
        return made._getvalue()

    def _function_at(signature: Any) -> Any:
        """Turn the address of a compiled function into that function."""

        @intrinsic  # type: ignore[untyped-decorator]
        def at(_: Any, address: Any) -> Any:
            def code(context: Any, builder: Any, _: Any, given: Any) -> Any:
                pointer = builder.inttoptr(given[0], cgutils.voidptr_t)
                return _function_value(signature, context, builder, pointer)

            return function(signature)(address), code

        return at

    def value_of(signature: Any) -> Any:
        """Turn a kernel into a value.  Code that holds numba's own values is not kept on disk."""

        @intrinsic  # type: ignore[untyped-decorator]
        def value(_: Any, given: Any) -> Any:
            def code(context: Any, builder: Any, *_: Any) -> Any:
                compiled = given.dispatcher.get_compile_result(signature)
                context.active_code_library.add_linking_library(compiled.library)
                found = context.declare_function(builder.module, compiled.fndesc)
                pointer = builder.bitcast(found, cgutils.voidptr_t)
                return _function_value(signature, context, builder, pointer)

            return function(signature)(given), code

        return value

    _pressure_at, _state_at, _slope_at, _series_at, _breaks_at = map(_function_at, SIGNATURES)

    @kernel(LAW(ADDRESSES))
    def opened(law: Any) -> Law:
        """The law behind its addresses."""
        return Law(
            _pressure_at(law[0]),
            _state_at(law[1]),
            _slope_at(law[2]),
            _series_at(law[3]),
            _breaks_at(law[4]),
        )

    def handed(law: Law) -> Any:
        """A law in the form in which Python passes it to a kernel; compiled if necessary."""
        found = []
        for function, signature in zip(law, SIGNATURES, strict=True):
            known = hasattr(function, "get_compile_result")
            compiled = function if known else kernel(signature)(function)
            made = compiled.get_compile_result(signature)
            found.append(made.library.get_pointer_to_function(made.fndesc.llvm_func_name))
        return np.array(found)

else:

    class _Type:
        """Substitute for every type and signature without numba."""

        def __call__(self, *_: Any) -> Any:
            return self

    real = whole = truth = vector = matrix = nothing = function = _Type()
    PRESSURE = STATE = SLOPE = SERIES = BREAKS = LAW = LOOP = real
    SIGNATURES = Law(real, real, real, real, real)

    def results(count: int) -> Any:
        """Substitute for the type of a tuple of numbers."""
        return real

    def record(kind: Any, *fields: Any) -> Any:
        """Substitute for the type of a named tuple."""
        return real

    def value_of(signature: Any) -> Any:
        """The function itself."""
        return lambda given: given

    def kernel(signature: Any) -> Callable[[Kernel], Kernel]:
        """Leave a function as it is."""
        return lambda function: function

    def opened(law: Any) -> Law:
        """The law itself."""
        return law

    def handed(law: Law) -> Any:
        """The law itself."""
        return law
