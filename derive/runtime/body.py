"""One body as the runtime sees it: its law, its parameters, and its functions of a whole cycle.

A generated module creates one `Body` and binds the functions of cycle.py to it.  The body's
formulas are compiled, and the solvers loaded, when one of these functions is first called.
"""

import importlib
import math
import re
import threading
from collections.abc import Callable, Mapping
from functools import cache, cached_property
from inspect import Parameter as Argument
from inspect import signature
from typing import Any, NamedTuple

import numpy as np

from .arrays import Numbers, evaluated, is_foreign, positive_or_nan, real, shape_of
from .chunks import any_lazy, is_lazy, over_chunks
from .words import EXAMPLES, SAID, Parameter, documented

CASES = 65_536
"""Number of cases that are solved at once."""


class Example(NamedTuple):
    """A contact in plain numbers, for E* = 1, from which the examples in docstrings are made.

    law      E* and the parameters, as they are written in a call
    edges    a and c
    carried  load, moment and tilt
    K_N      at the left and the right edge
    """

    law: str
    edges: tuple[float, float]
    carried: tuple[float, float, float]
    K_N: tuple[float, float]

    @property
    def words(self) -> dict[str, str]:
        """The texts that fill the examples, by name; f = 1/2, so that dQ/(2 f) is dQ."""
        load, moment, tilt = self.carried
        dQ, h = float(f"{load / 8:.2g}"), sum(self.edges)
        numbers = dict(load=load, moment=moment, alpha=tilt, reduced=load - dQ)
        numbers |= dict(threshold=8 * dQ / (math.pi * h))
        texts = {name: f"{value:.6g}" for name, value in numbers.items()}
        slip = [f"{2 * dQ / (math.pi * math.sqrt(h) * k):.6g}" for k in self.K_N]
        edges = ", ".join(map(repr, self.edges))
        return texts | dict(law=self.law, edges=edges, dQ=repr(dQ), slip=str(slip))


class Body:
    """A body: functions of one contact for E* = 1, written for numbers, with their parameters.

    functions   pressure, state, slope, series and breaks, as `kernels.Law` describes them
    origin      the file that g(x) came from
    example     the contact from which the examples in docstrings are made
    parameters  of the geometry, in the order in which those functions receive them
    demands     conditions on the parameters, other than being positive, in words
    """

    def __init__(
        self,
        functions: Mapping[str, Callable[..., Any]],
        origin: str,
        example: Example,
        *parameters: Parameter,
        demands: str = "",
    ) -> None:
        self.functions, self.parameters = functions, parameters
        self.origin, self.example, self.demands = origin, example, demands
        self.names = tuple(p.name for p in parameters)
        self._names = frozenset(self.names)
        self._lock = threading.Lock()

    @cached_property
    def law(self) -> Any:
        """The body's compiled functions, in the form that the kernels take."""
        kernels = importlib.import_module(".kernels", __package__)
        with self._lock:
            return kernels.handed(kernels.Law(**self.functions))

    def bound(self, function: Callable[..., Any]) -> Callable[..., Any]:
        """A function of cycle.py for this body; the body's parameters become keyword-only."""

        def call(*args: Any, **kwargs: Any) -> Any:
            if not self._names <= kwargs.keys():
                call.__signature__.bind(*args, **kwargs)  # type: ignore[attr-defined]
            own = {name: kwargs.pop(name) for name in self.names}
            return function(Asked(self, call, own), *args, **kwargs)

        given = [*signature(function).parameters.values()][1:]
        own = [Argument(n, Argument.KEYWORD_ONLY, annotation=Any) for n in self.names]
        optional = [a for a in given if a.kind is a.KEYWORD_ONLY and a.default is not a.empty]
        others = [a for a in given if a not in optional]
        arguments = [*others, *own, *optional]
        call.__signature__ = signature(function).replace(parameters=arguments)  # type: ignore[attr-defined]
        call.__name__ = call.__qualname__ = function.__name__
        call.__module__ = self.functions["state"].__module__  # where Dask's workers find it
        call.__doc__ = function.__doc__
        text = documented(*self.parameters)(call).__doc__ or ""
        if self.demands:
            text = re.sub(r"(parameters\s+are positive)", rf"\1, {self.demands}", text)
        example = EXAMPLES[function.__name__].format_map(self.example.words)
        text += f"\nDerived from {self.origin}.\n\nExamples\n--------\n{example}"
        call.__doc__ = text
        return call


class Asked(NamedTuple):
    """A call of a public function: the body, the function itself, the body's parameters."""

    body: Body
    call: Callable[..., Any]
    own: dict[str, Any]

    def solved(
        self,
        loop: str,
        given: Mapping[str, Any],
        constants: Mapping[str, Any],
        row: tuple[str, ...],
        kind: Any = None,
        over_modulus: tuple[str, ...] = (),
        by_modulus: bool = False,
        options: Mapping[str, Any] | None = None,
    ) -> Any:
        """Run a loop kernel on all cases of the broadcast arguments.

        loop: the kernel, by its module and name.
        constants: E_star, and f where it is needed.
        row: names of the values that the kernel takes for each case; the options follow them.
        over_modulus: names of the values that are divided by E* before the kernel is called.
        by_modulus: whether the results are multiplied by E*.
        """
        options = options or {}
        numbers = numbers_of(given, {**constants, **self.own})
        if any_lazy(numbers.values()):
            shape_of(numbers)
            return over_chunks(with_options(self.call, options), numbers)
        kernel, law = kernel_of(loop), self.body.law
        count = 1 if kind is None else len(kind._fields)

        def rows(**part: Any) -> Any:
            shape = shape_of(part)
            values = [part[n] / part["E_star"] if n in over_modulus else part[n] for n in row]
            cases = _table([*values, *options.values()], shape)
            out = np.empty((len(cases), count))
            kernel(law, cases, _table([part[n] for n in self.own], shape), out)
            factor = part["E_star"] if by_modulus else 1.0
            if not shape:
                columns = [*(out[0] * factor)]
            else:
                columns = [column.reshape(shape) * factor for column in out.T]
            return columns if count > 1 else columns[0]

        return evaluated(rows, numbers, kind, CASES)


def _table(values: list[Any], shape: tuple[int, ...]) -> Any:
    """The values of all cases, one row per case."""
    if not shape:
        return np.array([values], dtype=np.float64)
    table = np.empty((*shape, len(values)))
    for i, value in enumerate(values):
        table[..., i] = value
    return table.reshape(math.prod(shape), len(values))


def numbers_of(given: Mapping[str, Any], constants: Mapping[str, Any]) -> Numbers:
    """All values as float64; constants become NaN unless positive and finite.

    Raises TypeError for anything that is not a real number, and for arrays of libraries other than
    NumPy and Dask.
    """
    numbers = {name: real(value, name) for name, value in given.items()}
    numbers |= {name: positive_or_nan(real(value, name)) for name, value in constants.items()}
    for name, value in numbers.items():
        if type(value) is not np.float64 and is_foreign(value) and not is_lazy(value):
            raise TypeError(
                "functions that solve or integrate accept only NumPy and Dask arrays, and "
                f"{name} is a {type(value).__module__}.{type(value).__name__}: convert it to NumPy"
            )
    return numbers


def with_options(call: Callable[..., Any], options: Mapping[str, Any]) -> Callable[..., Any]:
    """The function with its options; it keeps its name, which Dask uses to name its tasks."""

    def chosen(**given: Any) -> Any:
        return call(**given, **options)

    chosen.__name__ = call.__name__
    return chosen


@cache
def kernel_of(loop: str) -> Any:
    """A kernel by its module in this package and its name, such as "forward.each_contact"."""
    module, _, name = loop.rpartition(".")
    SAID.clear()
    return getattr(importlib.import_module(f".{module}", __package__), name)
