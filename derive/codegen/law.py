"""Prints the law of a body: the scalar functions that a generated module passes to the kernels.

In:  a proven FormulaSheet.
Out: the text of `_pressure`, `_state`, `_slope`, `_series` and `_breaks`, and of `_BODY`.
"""

import re
from collections.abc import Iterable, Iterator

from sympy import Expr, Lt, Piecewise, S, count_ops, diff, expand, factor

from derive.codegen.function import example_of, local, printer_of, step_lines
from derive.codegen.parts import THIRD, parts_program, summed_steps
from derive.codegen.plan import Route, carried_by
from derive.codegen.printer import NumPyPrinter
from derive.codegen.program import Program
from derive.codegen.rewrite import demand_equal, stable_program
from derive.proof.points import Point, contacts, numeric
from derive.sheet import FormulaSheet
from derive.symbols import E_star, a, c, x
from derive.theory.edges import Edge, pressure_series
from derive.theory.slip import pressure_next

NAMES = ("pressure", "state", "slope", "series", "breaks")
"""The functions of a law, in the order of runtime/kernels.py."""

_OF_SEVERAL = ("_state", "_slope", "_series", "_curve")
"""Functions that return several numbers."""

PRESSURE = ("x, a, c", "Pressure at x for E* = 1.")
STATE = ("a, c", "Load, moment, tilt and K_N for E* = 1.")
"""Arguments of two functions, and what they return."""


class LawText:
    """The text of the law of one body."""

    def __init__(self, sheet: FormulaSheet, source: str) -> None:
        self.sheet, self.source = sheet, source
        self.names = [q.name for q in sheet.geometry.parameters]

    @property
    def text(self) -> str:
        """The whole text."""
        return "\n".join([*self._functions(), *self._body()])

    def _functions(self) -> Iterator[str]:
        """Code for all functions; they call the public functions with scalars."""
        yield from self._carried()
        yield from self._series()
        yield from self._slope()
        kinks = self.sheet.frame.slope.kinks
        places = [as_float(NumPyPrinter().doprint(kink.position)) for kink in kinks]
        array = f"np.array([{', '.join(places)}])" if places else "np.empty(0)"
        words = "Points at which the formula of the curve changes."
        yield from self.function("_breaks", "", words, [f"    return {array}"])

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

    def _carried(self) -> Iterator[str]:
        """Code for pressure and state."""
        own = ", ".join(f"own[{i}]" for i in range(len(self.names)))
        yield "_load, _moment, _tilt = by_position(load), by_position(moment), by_position(tilt)"
        yield "_p, _K_N, _L_N = by_position(pressure), by_position(K_N), by_position(L_N)"
        lines = [f"    return _p(x, a, c, 1.0, {own})"]
        yield from self.function("_pressure", *PRESSURE, lines)
        lines = [
            f"    left, right = _K_N(a, c, 1.0, {own})",
            f"    load, moment = _load(a, c, 1.0, {own}), _moment(a, c, 1.0, {own})",
            f"    return load, moment, _tilt(a, c, {own}), left, right",
        ]
        yield from self.function("_state", *STATE, lines)

    def _series(self) -> Iterator[str]:
        sheet, program = self.sheet, third_program(self.sheet)
        printer = printer_of(program, {a, c})
        steps = summed_steps if carried_by(sheet) is Route.PARTS else step_lines
        third = {
            local(sheet, f"third_{side}"): printer.doprint(value)
            for side, value in program.outputs.items()
        }
        lines = [
            f"    second = _L_N(a, c, 1.0, {', '.join(self.names)})",
            *steps(sheet, program, printer),
            *(f"    {name} = {value}" for name, value in third.items()),
            f"    return second.left, second.right, {', '.join(third)}",
        ]
        words = "L_N and the coefficients of s**(5/2) for E* = 1."
        yield from self.function("_series", "a, c", words, lines)

    def _slope(self) -> Iterator[str]:
        pieces = self.sheet.frame.slope.pieces
        printer, values = NumPyPrinter({x}), {}
        for name, order in (("slope", 0), ("curvature", 1)):
            cases = [(_shorter(diff(p.slope, x, order)), Lt(x, p.upper)) for p in pieces]
            cases[-1] = (cases[-1][0], S.true)
            values[local(self.sheet, name)] = as_float(printer.doprint(Piecewise(*cases)))
        lines = [f"    {name} = {value}" for name, value in values.items()]
        lines.append(f"    return {', '.join(values)}")
        yield from self.function("_slope", "x", "g'(x) and g''(x).", lines)

    def _body(self) -> Iterator[str]:
        yield "_BODY = Body("
        yield f"    dict({', '.join(f'{name}=_{name}' for name in NAMES)}),"
        yield f"    {self.source!r},"
        yield f"    Example{_example(self.sheet)},"
        yield "    *_OWN,"
        if demands := " and ".join(map(str, self.sheet.geometry.slope.demands)):
            yield f"    demands={demands!r},"
        yield ")"


def _shorter(polynomial: Expr) -> Expr:
    """A polynomial as factors, such as (x - b)/R, or as terms, such as x/R + x**3/L**3."""
    return min(factor(polynomial), expand(polynomial), key=count_ops)


def _example(sheet: FormulaSheet) -> tuple[object, ...]:
    """The arguments of `Example` in runtime/body.py: a contact in simple numbers."""
    point: Point = example_of(sheet, sheet["load"].conditions)
    names = ("load", "moment", "tilt", "K_N_left", "K_N_right")
    *carried, left, right = (float(numeric(sheet.flat(name))(point)) for name in names)
    constants = [E_star, *(q.symbol for q in sheet.geometry.parameters)]
    law = ", ".join(f"{s}={float(point[s])!r}" for s in constants)
    return law, (float(point[a]), float(point[c])), tuple(carried), (left, right)


def as_float(printed: str) -> str:
    """A printed number as a float: numba needs `1.0` instead of `1`."""
    return f"{printed}.0" if printed.isdigit() else printed


# ------------------------------------------------------------------ the third coefficient


def third_program(sheet: FormulaSheet) -> Program:
    """The program for the coefficients of s**(5/2) at both edges, with E* = 1.

    The series of the slip zones need them at order 3.

    Raises NotProven if the expanded pressure does not agree with L_N and K_N.
    """
    summed = carried_by(sheet) is Route.PARTS
    program = parts_program(sheet, THIRD) if summed else _expanded(sheet)
    return program.mapped(lambda expr: expr.xreplace({E_star: S.One}))


def _expanded(sheet: FormulaSheet) -> Program:
    """The program from the expanded pressure, compared with `_from_motion`."""
    series = {edge.name.lower(): pressure_series(sheet.frame, edge, 3)[2] for edge in Edge}
    program = stable_program(sheet, series, {})
    words = f"the third coefficient of {sheet.geometry.name!r}"
    demand_equal(words, program, _from_motion(sheet), contacts(sheet))
    return program


def _from_motion(sheet: FormulaSheet) -> dict[str, Expr]:
    """The coefficients by an independent route: the change of L_N as one edge moves."""
    coefficients = {}
    for side, edge in (("left", a), ("right", c)):
        K, L = (sheet.frame.flat(sheet[f"{name}_{side}"].expr) for name in ("K_N", "L_N"))
        coefficients[side] = sheet.frame.flat(pressure_next(L.diff(edge), 1, K))
    return coefficients
