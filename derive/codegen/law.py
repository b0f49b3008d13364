"""What a generated module gives the kernels: the body's functions for numbers, and the body.

In:  a proven FormulaSheet.
Out: the text of `_pressure`, `_state`, `_slope`, `_series` and `_breaks`, and of `_BODY`.
"""

import re
from collections.abc import Iterable, Iterator

import mpmath
from mpmath import mpf
from sympy import Expr, Ge, Lt, Piecewise, S, diff, factor

from derive.codegen.function import example_of
from derive.codegen.printer import NumPyPrinter
from derive.proof.points import Point, numeric
from derive.sheet import FormulaSheet
from derive.symbols import E_star, a, c, x

NAMES = ("pressure", "state", "slope", "series", "breaks")
"""What a law consists of, in the order of runtime/kernels.py."""


class LawText:
    """The text of one body's law.

    third: whether the module has `_third`, the coefficients of s**(5/2).
    """

    def __init__(self, sheet: FormulaSheet, source: str, third: bool) -> None:
        self.sheet, self.source, self.third = sheet, source, third
        self.names = [q.name for q in sheet.geometry.parameters]

    @property
    def text(self) -> str:
        """All of it."""
        own = ", ".join(f"own[{i}]" for i in range(len(self.names)))
        return "\n".join([*self._formulas(own), *self._slope(), *self._breaks(), *self._body()])

    def _formulas(self, own: str) -> Iterator[str]:
        """Pressure, state and series by the formulas above, compiled for numbers."""
        yield "_load, _moment, _tilt = by_position(load), by_position(moment), by_position(tilt)"
        yield "_p, _K_N, _L_N = by_position(pressure), by_position(K_N), by_position(L_N)"
        if self.third:
            yield "_T_N = by_position(_third)"
        yield from function_head("_pressure", "x, a, c", "The pressure at x for E* = 1.")
        yield f"    return _p(x, a, c, 1.0, {own})"
        yield from function_head("_state", "a, c", "Load, moment, tilt and K_N for E* = 1.")
        yield f"    left, right = _K_N(a, c, 1.0, {own})"
        yield f"    load, moment = _load(a, c, 1.0, {own}), _moment(a, c, 1.0, {own})"
        yield f"    return load, moment, _tilt(a, c, {own}), left, right"
        yield from function_head(
            "_series", "a, c", "L_N and the coefficients of s**(5/2) for E* = 1."
        )
        yield f"    left, right = _L_N(a, c, 1.0, {own})"
        if self.third:
            yield f"    third_left, third_right = _T_N(a, c, 1.0, {own})"
            yield "    return left, right, third_left, third_right"
        else:
            yield "    return left, right, np.nan, np.nan"

    def _unpacked(self, text: Iterable[str]) -> Iterator[str]:
        """The parameters that some text holds, by their names; then the text."""
        lines = list(text)
        words = set(re.findall(r"\w+", " ".join(lines)))
        held = [(name, f"own[{i}]") for i, name in enumerate(self.names) if name in words]
        if held:
            names, places = zip(*held, strict=True)
            yield f"    {', '.join(names)} = {', '.join(places)}"
        yield from lines

    def _slope(self) -> Iterator[str]:
        slope = self.sheet.frame.slope
        total: Expr = slope.base
        for kink in slope.kinks:
            compare = Ge if kink.side > 0 else Lt
            beyond = compare(x, kink.position, evaluate=False)
            total += Piecewise((factor(kink.jump), beyond), (S.Zero, True))
        printer = NumPyPrinter({x})
        yield from function_head("_slope", "x", "g'(x) and g''(x).")
        values = map(printer.doprint, (total, diff(total, x)))
        yield from self._unpacked([f"    return {', '.join(map(as_float, values))}"])

    def _breaks(self) -> Iterator[str]:
        places = [kink.position for kink in self.sheet.frame.slope.kinks]
        yield from function_head("_breaks", "", "Where the curve changes its formula.")
        printed = ", ".join(as_float(NumPyPrinter().doprint(place)) for place in places)
        array = f"np.array([{printed}])" if places else "np.empty(0)"
        yield from self._unpacked([f"    return {array}"])

    def _body(self) -> Iterator[str]:
        functions = ", ".join(f"{name}=_{name}" for name in NAMES)
        parameters = "".join(
            f"Parameter({q.name!r}, {q.meaning!r}, {q.unit!r}), "
            for q in self.sheet.geometry.parameters
        )
        example = ", ".join(f"{k}={v!r}" for k, v in example_values(self.sheet).items())
        yield "_BODY = Body("
        yield f"    dict({functions}),"
        yield f"    ({parameters}),"
        yield f"    {self.source!r},"
        yield f"    dict({example}),"
        if demands := " and ".join(map(str, self.sheet.geometry.slope.demands)):
            yield f"    {demands!r},"
        yield ")"


def function_head(name: str, arguments: str, words: str) -> Iterator[str]:
    """The first lines of a function of numbers."""
    given = f"{arguments}, own" if arguments else "own"
    typed = ", ".join(f"{argument}: Array" for argument in given.split(", "))
    yield f"def {name}({typed}) -> Any:"
    yield f'    """{words}"""'


def example_values(sheet: FormulaSheet) -> dict[str, str]:
    """A contact in plain numbers for the docstrings; f = 1/2, so that dQ/(2 f) is dQ."""
    point: Point = example_of(sheet, sheet["load"].conditions)
    load, moment, tilt, *K = (
        numeric(sheet.flat(name))(point)
        for name in ("load", "moment", "tilt", "K_N_left", "K_N_right")
    )
    h = point[a] + point[c]
    dQ = mpf(f"{float(load / 8):.2g}")
    scale = mpmath.pi * mpmath.sqrt(h) / 2
    constants = [E_star, *(q.symbol for q in sheet.geometry.parameters)]
    return {
        "law": ", ".join(f"{s}={float(point[s])!r}" for s in constants),
        "edges": f"{float(point[a])!r}, {float(point[c])!r}",
        "load": f"{float(load):.6g}",
        "moment": f"{float(moment):.6g}",
        "alpha": f"{float(tilt):.6g}",
        "dQ": repr(float(dQ)),
        "reduced": f"{float(load - dQ):.6g}",
        "threshold": f"{float(8 * dQ / (mpmath.pi * h)):.6g}",
        "slip": str([f"{float(dQ / (scale * k)):.6g}" for k in K]),
    }


def as_float(printed: str) -> str:
    """Whole numbers as numbers of float64, which numba asks for."""
    return f"{printed}.0" if printed.isdigit() else printed
