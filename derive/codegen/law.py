"""Prints the law of a body: the scalar functions that a generated module passes to the kernels.

In:  a proven FormulaSheet.
Out: the text of `_pressure`, `_state`, `_slope`, `_series` and `_breaks`, and of `_BODY`.
"""

import re
from collections.abc import Iterable, Iterator

from derive.codegen.function import local
from derive.codegen.integrals import by_piece
from derive.codegen.printer import NumPyPrinter
from derive.sheet.formulas import FormulaSheet
from derive.symbols import x

NAMES = ("pressure", "state", "slope", "series", "breaks")
"""The functions of a law, in the order of runtime/kernels.py."""

_OF_SEVERAL = ("_law_state", "_law_slope", "_law_series", "_curve")
"""Functions that return several numbers."""

PRESSURE = ("x, a, c", "Pressure at x for E* = 1.")
STATE = ("a, c", "Load, moment, tilt and K_N for E* = 1.")
SERIES = ("a, c", "L_N for E* = 1.")
BREAKS = ("", "Points at which the formula of the curve changes.")
"""Arguments of functions, and what they return."""


class LawText:
    """The text of the law of one body."""

    def __init__(self, sheet: FormulaSheet) -> None:
        self.sheet = sheet
        self.names = [q.name for q in sheet.geometry.parameters]

    @property
    def text(self) -> str:
        """The whole text."""
        law = ", ".join(f"_law_{name}" for name in NAMES)
        typed = ", ".join(f"{name}: Values" for name in self.names)
        named = ", ".join(f"{name!r}: {name}" for name in self.names)
        lines = [
            f"_BODY = Body(__name__, {law})",
            "",
            f"def _of({typed}) -> tuple[Body, dict[str, Values]]:",
            '    """The body, and its parameters by name."""',
            f"    return _BODY, {{{named}}}",
        ]
        return "\n".join([*self._functions(), *lines])

    def _functions(self) -> Iterator[str]:
        """Code for all functions; they call the public functions with scalars."""
        own = ", ".join(f"own[{i}]" for i in range(len(self.names)))
        call = f"_pressure(x, a, c, 1.0, {own})"
        yield from self.function("_law_pressure", *PRESSURE, [f"    return {call}"])
        lines = [
            f"    left, right = _K_N(a, c, 1.0, {own})",
            f"    load, moment = _load(a, c, 1.0, {own}), _moment(a, c, 1.0, {own})",
            f"    return load, moment, _tilt(a, c, {own}), left, right",
        ]
        yield from self.function("_law_state", *STATE, lines)
        lines = [f"    left, right = _L_N(a, c, 1.0, {own})", "    return left, right"]
        yield from self.function("_law_series", *SERIES, lines)
        yield from self._slope()
        kinks = self.sheet.frame.slope.kinks
        places = [as_float(NumPyPrinter().doprint(kink.position)) for kink in kinks]
        array = f"np.array([{', '.join(places)}])" if places else "np.empty(0)"
        yield from self.function("_law_breaks", *BREAKS, [f"    return {array}"])

    def function(
        self, name: str, arguments: str, words: str, lines: Iterable[str]
    ) -> Iterator[str]:
        """One function of scalars, which takes from `own` the parameters that it uses."""
        given = [*filter(None, arguments.split(", ")), "own"]
        typed = ", ".join(f"{argument}: Array" for argument in given)
        result = "tuple[Array, ...]" if name in _OF_SEVERAL else "Array"
        yield f"def {name}({typed}) -> {result}:"
        yield f'    """{words}"""'
        lines = list(lines)
        inside = set(re.findall(r"\w+", " ".join(lines)))
        used = {name: f"own[{i}]" for i, name in enumerate(self.names) if name in inside}
        if used:
            yield f"    {', '.join(used)} = {', '.join(used.values())}"
        yield from lines

    def _slope(self) -> Iterator[str]:
        pieces = self.sheet.frame.slope.pieces
        printer, values = NumPyPrinter({x}), {}
        for name in ("slope", "curvature"):
            value = by_piece([getattr(piece, name) for piece in pieces], pieces)
            values[local(self.sheet, name)] = as_float(printer.doprint(value))
        lines = [f"    {name} = {value}" for name, value in values.items()]
        lines.append(f"    return {', '.join(values)}")
        yield from self.function("_law_slope", "x", "g'(x) and g''(x).", lines)


def as_float(printed: str) -> str:
    """A printed number as a float: numba needs `1.0` instead of `1`."""
    return f"{printed}.0" if printed.isdigit() else printed
