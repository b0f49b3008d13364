"""The text of one generated function: signature, docstring with its equations and proofs, code.

In:  a proven FormulaSheet and a Function of the contract.
Out: Python source, not formatted yet.
"""

import textwrap
from collections.abc import Iterable, Iterator
from dataclasses import replace
from itertools import product

import mpmath
from mpmath import mpf
from sympy import Expr, Gt, Lt, Min, S, Symbol
from sympy.logic.boolalg import Boolean

from derive.codegen.contract import Function
from derive.codegen.printer import NumPyPrinter
from derive.codegen.program import LEAST, MOST, TINY, Program
from derive.codegen.rewrite import prove_equal, stable_program
from derive.errors import NotProven
from derive.notation import text_of
from derive.proof.points import Point, contacts, holds, loads, numeric
from derive.proof.verdict import Proof
from derive.runtime.body import sentence
from derive.sheet import FormulaSheet
from derive.symbols import E_star, M, P, a, alpha, c, dM, dP, dQ, dsigma, f, h, w, x
from derive.units import Dimension, dimension_of, parse_unit

LINE = 100

_width = Symbol("h")
"""Contact width by its name, where code is checked for it."""


def inside_quotes(text: str) -> str:
    """`text` as it stands between triple quotes, which it cannot close."""
    return text.replace("\\", "\\\\").replace('"""', r"\"\"\"")


class FunctionText:
    """The text of one function of one body."""

    def __init__(self, sheet: FormulaSheet, function: Function, source: str) -> None:
        self.sheet, self.function, self.source = sheet, function, source
        self.keywords = function.keywords(sheet)
        self.outputs = self._expressions()
        self.conditions = self._conditions()
        self.example = example_of(sheet, self.conditions)
        self.program = self._made()
        self._demand_equal()

    def _expressions(self) -> dict[str, Expr]:
        return self.function.outputs(self.sheet)

    def _conditions(self) -> tuple[Boolean, ...]:
        return self.function.conditions(self.sheet)

    def _made(self) -> Program:
        return stable_program(self.sheet, self.outputs, self.example)

    def _demand_equal(self) -> None:
        source = {name: self.sheet.frame.flat(expr) for name, expr in self.outputs.items()}
        proof = prove_equal(self.program, source, self._points())
        if not proof.holds:
            raise NotProven(f"{self.function.name} of {self.sheet.geometry.name!r}: {proof}")

    def _points(self) -> Iterator[Point]:
        if P not in self.function.arguments:
            yield from contacts(self.sheet)
        else:
            yield from loads(self.sheet, self.sheet[self.function.formulas[0]])

    @property
    def text(self) -> str:
        """The whole function."""
        return "\n".join(
            [
                *self._decorators,
                self._signature,
                textwrap.indent(self._docstring, " " * 4),
                *self._code,
            ]
        )

    @property
    def _decorators(self) -> Iterator[str]:
        yield "@elementwise"

    @property
    def _signature(self) -> str:
        defaults = dict(self.function.defaults)
        arguments = [
            f"{s}: Array" + (f" = {defaults[s]}" if s in defaults else "")
            for s in self.function.arguments
        ]
        if self.keywords:
            arguments += ["*", *(f"{s}: Array" for s in self.keywords)]
        return (
            f"def {self.function.name}({', '.join(arguments)}) -> {self.function.kind or 'Array'}:"
        )

    # ------------------------------------------------------------------ code

    @property
    def _code(self) -> Iterator[str]:
        arguments = self.function.arguments
        if x in arguments and _is_drawn_in(self.sheet):
            yield "    x = np.minimum(np.maximum(x, -a), c)  # beyond the edges all is zero [m]"
        printer = printer_of(self.program, {x} if x in arguments else {*arguments})
        yield from self._steps(printer)
        yield from self._ending({n: printer.doprint(e) for n, e in self.program.outputs.items()})

    def _steps(self, printer: NumPyPrinter) -> Iterator[str]:
        yield from step_lines(self.sheet, self.program, printer)

    def _ending(self, values: dict[str, str]) -> Iterator[str]:
        """The results by their names, where the state exists, and NaN elsewhere."""
        names = {}
        for field, source in self.function.fields:
            symbol = self.sheet[source].symbol if isinstance(source, str) else source
            names[field] = local(self.sheet, str(symbol))
            if values[field] != names[field]:
                yield f"    {names[field]} = {values[field]}"
        yield from self._existing()
        found = ", ".join(f"where(exists, {name}, np.nan)" for name in names.values())
        kind = self.function.kind
        yield f"    return {kind}({found})" if kind else f"    return {found}"

    def _existing(self) -> Iterator[str]:
        """Whether the state exists; a contact that is returned is held to what one given is."""
        if "h" not in (str(step.symbol) for step in self.program.steps):
            yield "    h = a + c  # contact width [m]"
        contact = self.sheet["tilt"].conditions if self.function.kind == "Contact" else ()
        checks = [*checks_of((*self.conditions, *contact)), *self._further_checks]
        yield f"    exists = {' & '.join(f'({check})' for check in checks)}"

    @property
    def _further_checks(self) -> Iterator[str]:
        """Where zero is taken for 0/0, as beside a corner at an edge, x itself must be a number."""
        corners = (k for k in self.sheet.frame.kinks if k.clipped and k.kink.is_corner)
        if self.function.name == "pressure" and any(corners):
            yield "x == x"

    # ------------------------------------------------------------------ docstring

    @property
    def _docstring(self) -> str:
        lines = [self.function.summary, ""]
        for equation in self._equations:
            lines += textwrap.wrap(
                equation, LINE - 8, initial_indent="    ", subsequent_indent=" " * 8
            )
        lines += ["", *_section("Parameters")]
        optional = {symbol.name for symbol, _ in self.function.defaults}
        for name, meaning in self._given.items():
            kind = "array_like, optional" if name in optional else "array_like"
            lines += [f"{name} : {kind}", *_indented(meaning)]
        kind, fields = self._returns
        lines += ["", *_section("Returns"), kind, *_indented(f"{fields}; {self._existence}")]
        lines += ["", *_section("Notes"), *textwrap.wrap(self._proofs, LINE - 4)]
        lines += ["", *_section("Examples"), *self._doctest]
        return f'"""{inside_quotes(chr(10).join(lines))}\n"""'

    @property
    def _given(self) -> dict[str, str]:
        """What the arguments mean, both edges at once, and all that is material or geometry."""
        found = {}
        quantities = self.sheet.geometry.quantities
        for symbol in self.function.arguments:
            q = quantities[str(symbol)]
            if symbol == a:
                found["a, c"] = f"Edges of the contact at x = -a and x = c [{q.unit}]."
            elif symbol != c:
                found[q.name] = sentence(f"{q.meaning} [{q.unit}]")
        if self.keywords:
            law = [quantities[str(symbol)] for symbol in self.keywords]
            meanings = "; ".join(f"{q.meaning} [{q.unit}]" for q in law)
            found[", ".join(q.name for q in law)] = sentence(meanings)
        return found

    @property
    def _equations(self) -> Iterator[str]:
        held: set[Symbol] = set()
        for name in self.function.formulas:
            formula, shown = self.sheet[name], self.sheet.shown(name)
            held |= shown.free_symbols
            yield f"{formula.symbol} = {text_of(shown)}"
        for symbol, definition in self.sheet.defined_in(*self.function.formulas).items():
            yield f"{symbol} = {text_of(definition)}"
        if any(str(symbol) == "e" for symbol in held):
            yield "e = M/P"

    @property
    def _returns(self) -> tuple[str, str]:
        """What comes out, and of which units."""
        fields = []
        for field, source in self.function.fields:
            if isinstance(source, str):
                unit = f"[{self.sheet[source].unit}]"
                fields.append(f"{field} {unit}" if field else unit)
            else:
                fields.append(f"{field} as given")
        (_, first), *_ = self.function.fields
        symbol = self.sheet[first].symbol if isinstance(first, str) else first
        return self.function.kind or f"{symbol} : ndarray", ", ".join(fields)

    @property
    def _existence(self) -> str:
        needed = map(str, _without_constants(self.conditions))
        return f"NaN unless {' and '.join(needed)}."

    @property
    def _proofs(self) -> str:
        """How each formula was proven, those of one proof together, and where it came from."""
        told: dict[Proof, list[str]] = {}
        digits: dict[Proof, int] = {}
        for formula in (self.sheet[name] for name in self.function.formulas):
            assert formula.proof is not None
            kind = replace(formula.proof, digits=0)
            told.setdefault(kind, []).append(str(formula.symbol))
            digits[kind] = min(formula.proof.digits, digits.get(kind, formula.proof.digits))
        proofs = (f"{' and '.join(s)} {replace(k, digits=digits[k])}." for k, s in told.items())
        return f"{'  '.join(proofs)}  {self._origin}"

    @property
    def _origin(self) -> str:
        return f"Derived from {self.source}."

    @property
    def _doctest(self) -> Iterator[str]:
        call = ", ".join(
            [_number(self.example[s]) for s in self.function.arguments]
            + [f"{s}={_number(self.example[s])}" for s in self.keywords]
        )
        values = [
            mpmath.nstr(numeric(self.sheet.frame.flat(expr))(self.example), 17)
            for expr in self.outputs.values()
        ]
        shown = [f"{float(value):.6g}" for value in values]
        if self.function.kind:
            yield f'>>> [f"{{v:.6g}}" for v in {self.function.name}({call})]'
            yield str(shown)
        else:
            yield f'>>> f"{{{self.function.name}({call}):.6g}}"'
            yield repr(shown[0])


def _section(name: str) -> list[str]:
    return [name, "-" * len(name)]


def _indented(text: str) -> list[str]:
    return textwrap.wrap(text, LINE - 4, initial_indent="    ", subsequent_indent="    ")


def printer_of(program: Program, arguments: set[Symbol]) -> NumPyPrinter:
    """A printer that knows what varies along an array: the arguments, and what holds them."""
    varying = {*arguments}
    for step in program.steps:
        if step.expr.free_symbols & varying:
            varying.add(step.symbol)
    return NumPyPrinter(varying)


def step_lines(
    sheet: FormulaSheet, program: Program, printer: NumPyPrinter, given: int = 0
) -> Iterator[str]:
    """The code of a program's steps, each with its meaning and unit.

    given: how many of the first are there already.
    """
    known: dict[Symbol, Dimension] = {**sheet.dimensions, TINY: parse_unit("m")}
    for number, step in enumerate(program.steps):
        found = dimension_of(step.expr, known) or Dimension()
        known[step.symbol] = found
        unit = "-" if str(found) == "1" else str(found)
        note = f"  # {step.meaning} [{unit}]" if step.meaning else ""
        if number >= given:
            yield from _noted(f"    {step.symbol} = {printer.doprint(step.expr)}", note)


def _is_drawn_in(sheet: FormulaSheet) -> bool:
    """Whether x is drawn in to the nearest edge, as it stands outside roots and logarithms, too."""
    return bool(sheet["pressure"].expr.xreplace({w: S.One}).has(x))


def local(sheet: FormulaSheet, name: str) -> str:
    """The name of a local variable, which gives way to a parameter of the same name."""
    while name in {q.name for q in sheet.geometry.parameters}:
        name += "_"
    return name


def checks_of(conditions: Iterable[Boolean]) -> list[str]:
    """The conditions that code checks; `elementwise` checks the constants.

    Lengths end where their products would leave float64.
    """
    held = _without_constants(conditions)
    if {a > 0, c > 0} <= {*held}:  # both edges against LEAST at once: one operation less on arrays
        held = [cond for cond in held if cond not in (a > 0, c > 0)] + [Min(a, c) > LEAST]
    least = [Gt(_width, LEAST) if cond == (h > 0) else cond for cond in held]
    return [NumPyPrinter().doprint(cond) for cond in (*least, Lt(_width, MOST))]


def _without_constants(conditions: Iterable[Boolean]) -> list[Boolean]:
    """The conditions that are not of one constant alone; a > 0 and c > 0 say that h > 0."""
    held = [cond for cond in dict.fromkeys(conditions) if not _is_of_a_constant(cond)]
    spanning = {a > 0, c > 0} <= {*held}
    return [cond for cond in held if not (spanning and cond == (h > 0))]


def _is_of_a_constant(condition: Boolean) -> bool:
    """Whether a condition says that a constant is positive."""
    if not isinstance(condition, Gt):
        return False
    symbol, least = condition.args
    return bool(symbol.is_Symbol and symbol.is_positive and symbol != P and least == 0)


def _noted(line: str, note: str) -> Iterator[str]:
    """A line with its note behind it, or above it where it would be too long."""
    if len(line + note) <= LINE:
        yield line + note
    else:
        yield "    " + note.strip()
        yield line


def _number(value: mpf) -> str:
    return repr(float(value))


def _off_all_kinks(sheet: FormulaSheet, point: Point) -> bool:
    """Whether no kink lies at x or at an edge, where some formulas have no value."""
    places = [numeric(kink.position)(point) for kink in sheet.geometry.slope.kinks]
    return not {*places} & {point[x], -point[a], point[c]}


_SIZES = (1, 2, 4, 8, mpf("0.5"), mpf("0.25"), mpf("0.125"))
_PLACES = tuple(map(mpf, ("0.5", "0.375", "-0.25", "0.75", "0.1875")))
"""Sizes of the contact, and places in it, that an example may have."""


_LONGER = mpf("1.5")
"""The left arm of an example, in its sizes; the right one is a size long."""


def example_of(sheet: FormulaSheet, conditions: Iterable[Boolean]) -> Point:
    """Plain numbers that meet the function's assumptions, for its docstring."""
    needed = tuple(conditions)
    given = [_plain_parameters(sheet, lengths) for lengths in (1, 2)]
    tried = [(plain, place, size) for plain, place, size in product(given, _PLACES, _SIZES)]
    tried += [(p, place, size) for p in given for size in _within(sheet, p) for place in _PLACES]
    for (plain, place, size), lean in product(tried, (1, -1, 0)):
        point: Point = {
            **plain,
            E_star: mpf(1),
            x: place,
            a: _LONGER * size,
            c: mpf(1) * size,
            P: mpf(size),
            M: mpf("0.25") * size * lean,
            alpha: mpf("0.03125") * lean or _middle_tilt(sheet, plain),
            dQ: mpf("0.25"),
            dsigma: mpf("0.125"),
            dP: mpf("0.5"),
            dM: mpf("0.25"),
            f: mpf("0.5"),
        }
        if holds(needed, point) and _off_all_kinks(sheet, point):
            return point
    raise NotProven(f"no example found for {sheet.geometry.name!r}")


def _within(sheet: FormulaSheet, plain: Point) -> list[mpf]:
    """Sizes at which the longer arm ends between the outermost kink and the body's end."""
    ends = [abs(numeric(end)(plain)) for end in sheet.geometry.slope.domain]
    kinks = [abs(numeric(kink.position)(plain)) for kink in sheet.geometry.slope.kinks]
    start, end = max(kinks, default=mpf(0)), min(ends)
    if not start < end < mpmath.inf:
        return []
    step = mpf(2) ** mpmath.floor(mpmath.log((end - start) / 16, 2))
    shares = map(mpf, ("0.75", "0.5", "0.25"))
    return [step * mpmath.floor((start + s * (end - start)) / _LONGER / step) for s in shares]


def _middle_tilt(sheet: FormulaSheet, plain: Point) -> mpf:
    """The tilt in the middle of those at which a body closes; zero if they have no end."""
    low, high = (numeric(limit)(plain) for limit in sheet.geometry.slope.limits)
    return -(low + high) / 2 if mpmath.isfinite(high - low) else mpf(0)


def _plain_parameters(sheet: FormulaSheet, lengths: int) -> Point:
    """Parameters above what is demanded of them: lengths one or more apart, slopes an eighth."""
    slope, found = sheet.geometry.slope, {}
    for number, q in enumerate(sheet.geometry.parameters):
        plain = mpf("0.125") if q.unit == "rad" else mpf(lengths) ** number
        value = slope.typical.get(q.symbol)
        found[q.symbol] = (mpf(value.p) / value.q if value else plain) + mpf(
            slope.least.get(q.symbol, 0)
        )
    return found
