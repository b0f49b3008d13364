"""Prints one generated function: its signature, its docstring with equations and proofs, its code.

The formula is a function of its own, of numbers or arrays, which kernels call, too.  The public
function beside it passes its arguments on, checked and broadcast.

In:  a proven FormulaSheet and a Function of the contract.
Out: Python source, not yet formatted.
"""

import textwrap
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property

import mpmath
from sympy import Expr, Gt, Lt, Min, Or, Piecewise, S, Symbol, Tuple
from sympy.logic.boolalg import Boolean

from derive.codegen.contract import Function
from derive.codegen.example import example_of
from derive.codegen.printer import NumPyPrinter
from derive.codegen.program import LEAST, MOST, Common, Program
from derive.codegen.rewrite import stable_program, summed_program
from derive.proof.points import numeric
from derive.proof.verdict import Proof, Verdict
from derive.reading.units import Dimension, dimension_of
from derive.sheet.formulas import FormulaSheet
from derive.sheet.notation import text_of
from derive.symbols import QUANTITIES, M, P, a, c, e, h, w, x
from derive.theory.parts import Definition
from derive.theory.segments import definitions_of

LINE = 100

_width = Symbol("h")
"""The contact width as a plain name, used in the conditions that the code checks."""


def inside_quotes(text: str) -> str:
    """`text` escaped so that it can be placed between triple quotes without closing them."""
    return text.replace("\\", "\\\\").replace('"""', r"\"\"\"")


def demands_of(sheet: FormulaSheet) -> str:
    """What the parameters must satisfy besides being positive; "" if nothing."""
    return " and ".join(map(str, sheet.geometry.slope.demands))


class FunctionText:
    """The text of one function that has a formula."""

    note = ""
    """What the docstring says after the proofs."""

    def __init__(self, sheet: FormulaSheet, function: Function) -> None:
        self.sheet, self.function = sheet, function
        self.keywords = function.keywords(sheet)
        self.outputs, self.conditions = function.outputs(sheet), function.conditions(sheet)
        self.example = example_of(sheet, self.conditions, function.geometric)
        self.program = self._made()

    def _made(self) -> Program:
        """The program of the function."""
        if self.is_summed:
            return summed_program(self.sheet, self.function.fields)
        return stable_program(self.sheet, self.outputs, self.example)

    @property
    def is_summed(self) -> bool:
        """Whether sums over the parts of a contact are evaluated in place of the formulas."""
        return all(self.sheet[name].computed is not None for name in self.function.formulas)

    def text(self, common: Common) -> str:
        """The whole function, without what it has in common with others."""
        kind = f", {self.function.kind}" if self.function.kind else ""
        given, constants = (
            f"{{{', '.join(f'{str(symbol)!r}: {symbol}' for symbol in symbols)}}}"
            for symbols in (self.function.arguments, self.keywords)
        )
        call = f"    return evaluated(_{self.function.name}, {given}, {constants}{kind})"
        return "\n".join([*self._formula(common), "", "", self._head(common), call])

    def _head(self, common: Common) -> str:
        """The signature and the docstring."""
        function = self.function
        given = [f"{s}: Values{' = 0.0' * (s == function.optional)}" for s in function.arguments]
        given += ["*", *(f"{s}: Values" for s in self.keywords)] if self.keywords else []
        signature = f"def {function.name}({', '.join(given)}) -> {function.kind or 'Array'}:"
        return f"{signature}\n{textwrap.indent(self._docstring(common), ' ' * 4)}"

    # ------------------------------------------------------------------ code

    def _formula(self, common: Common) -> Iterator[str]:
        """The private function that evaluates the formula; NaN where no such state exists."""
        function, arguments = self.function, self.function.arguments
        given = ", ".join(f"{s}: Array" for s in (*arguments, *self.keywords))
        yield "@shared"
        yield f"def _{function.name}({given}) -> {function.kind or 'Array'}:"
        if x in arguments and _is_drawn_in(self.sheet):
            yield "    x = np.minimum(np.maximum(x, -a), c)  # p is zero beyond the edges [m]"
        if common.steps:
            yield f"    {', '.join(common.names)} = _parts({', '.join(common.arguments)})"
        printer = self.printer
        yield from self.step_lines(step for step in self.program.steps if step not in common.steps)
        names = {}
        for field, source in function.fields:
            symbol = self.sheet[source].symbol if isinstance(source, str) else source
            names[field] = local(self.sheet, str(symbol))
            value = printer.doprint(self.program.outputs[field])
            if value != names[field]:
                yield f"    {names[field]} = {value}"
        if "h" not in (str(step.symbol) for step in self.program.steps):
            yield "    h = a + c  # contact width [m]"
        checks = [check for check in self.checks if check not in common.checks]
        if checks:
            yield f"    exists = {' & '.join(['exists'] * bool(common.checks) + checks)}"
        results = ", ".join(f"where(exists, {name}, np.nan)" for name in names.values())
        yield f"    return {function.kind}({results})" if function.kind else f"    return {results}"

    @cached_property
    def printer(self) -> NumPyPrinter:
        """A printer that knows what varies along an array: x, or else what depends on the edges."""
        arguments = self.function.arguments
        varying = {x} if x in arguments else {*arguments}
        for step in self.program.steps:
            varying |= {step.symbol} if step.expr.free_symbols & varying else set()
        return NumPyPrinter(varying)

    def step_lines(self, steps: Iterable[Definition]) -> Iterator[str]:
        """Code for steps, each with its meaning and unit behind it, or before it if it is long."""
        known: dict[Symbol, Dimension] = dict(self.sheet.dimensions)
        for step in self.program.steps:
            known[step.symbol] = dimension_of(step.expr, known) or Dimension()
        for step in steps:
            unit = "-" if str(known[step.symbol]) == "1" else str(known[step.symbol])
            line = f"    {step.symbol} = {self.printer.doprint(step.expr)}"
            note = f"# {step.meaning} [{unit}]"
            if len(line + note) + 2 <= LINE:
                yield f"{line}  {note}"
            else:
                yield f"    {note}"
                yield line

    @cached_property
    def checks(self) -> list[str]:
        """Conditions under which the state exists; those on the constants are checked in arrays.py.

        Lengths are limited so that their products stay within the range of float64.  A contact that
        is returned must meet the same conditions as a contact that is passed in.
        """
        contact = self.sheet["tilt"].conditions if self.function.kind == "Contact" else ()
        checked = _shortened(dict.fromkeys((*self.conditions, *contact)))
        if {a > 0, c > 0} <= {*checked}:  # one comparison for both edges saves an array operation
            checked = [cond for cond in checked if cond not in (a > 0, c > 0)] + [Min(a, c) > LEAST]
        least = [Gt(_width, LEAST) if cond == (h > 0) else cond for cond in checked]
        printed = [NumPyPrinter().doprint(cond) for cond in (*least, Lt(_width, MOST))]
        # at a corner `fmax` replaces 0/0 by zero, and so a NaN in x, too
        if self.function.name == "pressure" and any(
            k.kink.is_corner for k in self.sheet.frame.kinks
        ):
            printed.append("x == x")
        # a formula with pieces uses the parameters of one
        own = [str(q.symbol) for q in self.sheet.geometry.parameters]
        if self.is_summed and len(own) > 1 and any(e.has(Piecewise) for e in self.program.exprs):
            printed.append(f"{' * '.join(own)} > 0")
        return [f"({check})" for check in printed]

    # ------------------------------------------------------------------ docstring

    def _docstring(self, common: Common) -> str:
        lines = [self.function.summary, ""]
        for equation in self._equations(common):
            lines += equation_lines(equation, LINE - 8)
        lines += ["", *textwrap.wrap(f"{self._proofs}{self.note}", LINE - 4)]
        lines += ["", "Parameters", "----------", *self._parameters]
        kind, fields = self._returns
        lines += ["", "Returns", "-------", kind, *_indented(f"{fields}; {self._existence}")]
        lines += ["", "Examples", "--------", *self._doctest]
        return f'"""{inside_quotes(chr(10).join(lines))}\n"""'

    @cached_property
    def defined(self) -> Mapping[Expr, Expr]:
        """Definitions of the symbols and functions in the equations."""
        if self.is_summed:
            steps: dict[Expr, Expr] = {step.symbol: step.expr for step in self.program.steps}
            return steps | definitions_of(self.program.exprs)
        defined = {**self.sheet.defined_in(*self.function.formulas)}
        shown = Tuple(*map(self.sheet.shown, self.function.formulas))
        if any(str(symbol) == "e" for symbol in shown.free_symbols):
            defined[e] = M / P
        return defined

    def _equations(self, common: Common) -> Iterator[str]:
        """The formulas with the definitions of their symbols: the sums, if these are evaluated."""
        sheet, names = self.sheet, self.function.formulas
        shown = self.program.outputs.values() if self.is_summed else map(sheet.shown, names)
        for name, expr in zip(names, shown, strict=True):
            yield f"{sheet[name].symbol} = {text_of(expr)}"
        yield from definition_lines(
            {k: v for k, v in self.defined.items() if k not in common.defined}
        )
        shared = [str(k).partition("(")[0] for k in self.defined if k in common.defined]
        if shared:
            yield f"{', '.join(shared)}: see the docstring of the module"

    @property
    def _parameters(self) -> Iterator[str]:
        """One line for each argument; the edges share one, as do the material and the body."""
        for symbol in self.function.arguments:
            if symbol == a:
                yield "a, c : edges of the contact, at x = -a and x = c [m]"
            elif symbol != c:
                yield from argument_lines(str(symbol), meaning_of(str(symbol)))
        if self.keywords:
            yield from constants_lines(self.sheet, [str(symbol) for symbol in self.keywords])

    @property
    def _returns(self) -> tuple[str, str]:
        """The type of the result, and its fields with their units."""
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
        return f"NaN unless {_in_words(_shortened(self.conditions))}."

    @property
    def _proofs(self) -> str:
        """How each formula was proven; formulas with the same proof are joined."""
        symbols: dict[Proof, list[str]] = {}
        digits: dict[Proof, int] = {}
        for formula in (self.sheet[name] for name in self.function.formulas):
            assert formula.proof is not None
            kind = replace(formula.proof, digits=0)
            symbols.setdefault(kind, []).append(str(formula.symbol))
            digits[kind] = min(formula.proof.digits, digits.get(kind, formula.proof.digits))
        said = {kind: _proof_in_words(replace(kind, digits=digits[kind])) for kind in symbols}
        if len(said) == 1:
            (words,) = said.values()
            return words[0].upper() + words[1:]
        return "  ".join(f"{' and '.join(symbols[kind])}: {said[kind]}" for kind in said)

    @property
    def _doctest(self) -> Iterator[str]:
        given = {s: float(number) for s, number in self.example.items()}
        call = ", ".join(
            [*(str(given[s]) for s in self.function.arguments)]
            + [f"{s}={given[s]}" for s in self.keywords]
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


def definition_lines(defined: Mapping[Expr, Expr]) -> Iterator[str]:
    """Definitions as equations."""
    for symbol, definition in defined.items():
        yield f"{symbol} = {text_of(definition)}"


def equation_lines(equation: str, width: int) -> list[str]:
    """An equation as a docstring prints it."""
    return textwrap.wrap(equation, width, initial_indent=" " * 4, subsequent_indent=" " * 8)


def meaning_of(name: str) -> str:
    """What an argument means, with its unit."""
    quantity = QUANTITIES[name]
    return f"{quantity.meaning} [{quantity.unit}]"


def argument_lines(names: str, meaning: str) -> list[str]:
    """The entry of one argument, or several, in a docstring."""
    return textwrap.wrap(f"{names} : {meaning}", LINE - 4, subsequent_indent="    ")


def constants_lines(sheet: FormulaSheet, names: list[str]) -> list[str]:
    """The entry of the constants of the material and the body, which the docstrings share."""
    brief = {name: replace(q, meaning=q.meaning.split(",")[0]) for name, q in QUANTITIES.items()}
    known = brief | {q.name: q for q in sheet.geometry.parameters}
    meanings = [f"{known[name].meaning} [{known[name].unit}]" for name in names]
    return argument_lines(", ".join(names), "; ".join(meanings))


def _in_words(conditions: Sequence[Boolean]) -> str:
    """Conditions in words.

    >>> _in_words([a > 0, (a > 1) | (c > 1)])
    'a > 0 and (a > 1 or c > 1)'
    """
    texts = [
        f"({' or '.join(sorted(map(str, each.args)))})" if isinstance(each, Or) else str(each)
        for each in conditions
    ]
    return " and ".join(texts)


def _proof_in_words(proof: Proof) -> str:
    """The kind of a proof, the digits to which the two sides agree, and the routes.

    >>> _proof_in_words(Proof(Verdict.NUMERICAL, "int p dx by quadrature", 24, 36))
    'checked numerically to 36 digits at 24 points.  Route: int p dx by quadrature.'
    """
    kinds = ["proven symbolically"] if proof.verdict is Verdict.PROVEN else []
    if proof.points or not kinds:
        kinds.append("checked numerically")
    digits = f" to {proof.digits} digits at {proof.points} points"
    routes = "Routes" if "; " in proof.route else "Route"
    return f"{' and '.join(kinds)}{digits if proof.points else ''}.  {routes}: {proof.route}."


def _indented(text: str) -> list[str]:
    return textwrap.wrap(text, LINE - 4, initial_indent="    ", subsequent_indent="    ")


def _is_drawn_in(sheet: FormulaSheet) -> bool:
    """Whether x must be clipped to the contact: it also occurs outside roots and logarithms."""
    return bool(sheet["pressure"].expr.xreplace({w: S.One}).has(x))


def local(sheet: FormulaSheet, name: str) -> str:
    """The name of a local variable, extended by underscores if a parameter has the same name."""
    while name in {q.name for q in sheet.geometry.parameters}:
        name += "_"
    return name


def _shortened(conditions: Iterable[Boolean]) -> list[Boolean]:
    """The conditions without h > 0 if a > 0 and c > 0 are among them, because these imply it."""
    needed = [*conditions]
    return [cond for cond in needed if cond != (h > 0) or not {a > 0, c > 0} <= {*needed}]
