"""What numba is asked for, and what happens without it.

A kernel solves one case, in plain Python with `math`.  Here it is compiled, and kept on disk beside
its source.  Where numba is missing, or NUMBA_DISABLE_JIT is set, the same text runs as Python.

A body reaches the kernels as a `Law`, some functions of fixed signature; so the kernels are
compiled once for all bodies.  From Python a law is handed over as the addresses of its functions,
and `opened` inside, since numba takes ten microseconds to unwrap each function itself.
"""

import sys
from collections.abc import Callable
from contextlib import suppress
from functools import cache
from pathlib import Path
from threading import Timer
from typing import Any, NamedTuple, TypeVar

import numpy as np

from .elementary import where
from .shared import SHARED

try:
    import numba
except ImportError:
    COMPILED = False
else:
    COMPILED = not numba.config.DISABLE_JIT

PATIENCE = 0.7
"""Seconds that a kernel may take until a person is told; one from disk takes a hundredth."""

Kernel = TypeVar("Kernel", bound=Callable[..., Any])


class Law(NamedTuple):
    """What the kernels need of a body, all for E* = 1; `own` holds its parameters in their order.

    pressure  (x, a, c, own) -> p; zero outside the contact, infinite at a corner alone
    state     (a, c, own) -> load, moment, tilt, K_N at the left and the right edge; NaN where
              [-a, c] is no contact
    slope     (x, own) -> g'(x), g''(x); at a break of the piece on its right
    series    (a, c, own) -> coefficients of s**(3/2) at the left and the right edge, and of
              s**(5/2); the latter NaN where nothing gives them
    breaks    (own) -> places where the curve changes its formula, from left to right
    """

    pressure: Any
    state: Any
    slope: Any
    series: Any
    breaks: Any


def _forget_what_is_stale() -> None:
    """Remove compiled kernels that are older than any source of the runtime.

    numba looks at the file of a kernel alone, and would keep what it has compiled into it from
    others that have changed since.
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
    from numba.core import cgutils
    from numba.extending import intrinsic, overload, register_jitable

    _forget_what_is_stale()
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
        """The type of so many numbers."""
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
        compiled = numba.njit(
            signature, cache=True, nogil=True, error_model="numpy", no_cfunc_wrapper=True
        )

        def made(function: Kernel) -> Kernel:
            timer = Timer(PATIENCE, _tell)
            timer.start()
            try:
                return compiled(function)
            finally:
                timer.cancel()

        return made

    @overload(where)
    def _where(condition, first, second):  # type: ignore[no-untyped-def]
        """Between two numbers."""
        return lambda condition, first, second: first if condition else second

    @cache
    def _tell() -> None:
        """Say, once, what a person at a terminal is waiting for."""
        if not sys.stderr.isatty():
            return
        text = "compiling the solvers, once for this installation: some twenty seconds ..."
        print(text, file=sys.stderr, flush=True)

    def _holding(signature: Any, context: Any, builder: Any, address: Any) -> Any:
        """A function as a value, from where its code is."""
        made = cgutils.create_struct_proxy(function(signature))(context, builder)
        made.jit_addr = made.c_addr = address
        return made._getvalue()

    def _function_at(signature: Any) -> Any:
        """Turn the address of a compiled function into that function."""

        @intrinsic  # type: ignore[untyped-decorator]
        def at(_: Any, address: Any) -> Any:
            def code(context: Any, builder: Any, _: Any, given: Any) -> Any:
                pointer = builder.inttoptr(given[0], cgutils.voidptr_t)
                return _holding(signature, context, builder, pointer)

            return function(signature)(address), code

        return at

    def value_of(signature: Any) -> Any:
        """Turn a kernel into a value.  What uses numba's own such values is not kept on disk."""

        @intrinsic  # type: ignore[untyped-decorator]
        def value(_: Any, given: Any) -> Any:
            def code(context: Any, builder: Any, *_: Any) -> Any:
                compiled = given.dispatcher.get_compile_result(signature)
                context.active_code_library.add_linking_library(compiled.library)
                found = context.declare_function(builder.module, compiled.fndesc)
                pointer = builder.bitcast(found, cgutils.voidptr_t)
                return _holding(signature, context, builder, pointer)

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
        """A law as Python hands it to a kernel; compiled, where it is not yet."""
        found = []
        for function, signature in zip(law, SIGNATURES, strict=True):
            known = hasattr(function, "get_compile_result")
            compiled = function if known else kernel(signature)(function)
            made = compiled.get_compile_result(signature)
            found.append(made.library.get_pointer_to_function(made.fndesc.llvm_func_name))
        return np.array(found)

else:

    class _Type:
        """What stands for every type and signature without numba."""

        def __call__(self, *_: Any) -> Any:
            return self

    real = whole = truth = vector = matrix = nothing = function = record = _Type()
    PRESSURE = STATE = SLOPE = SERIES = BREAKS = LAW = LOOP = real
    SIGNATURES = Law(real, real, real, real, real)

    def results(count: int) -> Any:
        """The same for so many numbers."""
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
