"""The formula sheet: all formulas derived for one body, in one object.

In:  a geometry.
Out: `FormulaSheet`, a mapping from names to `Formula`; it prints as text in a terminal and as LaTeX
     in Jupyter.  The dimensions of a formula are checked when it is added.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

from sympy import Expr, Gt, Integral, Or, Rational, Symbol, oo
from sympy.logic.boolalg import Boolean

from derive.body.geometry import Geometry
from derive.command.errors import NotProven
from derive.proof.verdict import Proof
from derive.reading.units import NUMBER, Dimension, check, dimension_of, parse_unit
from derive.sheet.notation import latex_of, text_of
from derive.symbols import QUANTITIES, P, Quantity, a, alpha, c, h
from derive.theory.frame import Frame
from derive.theory.parts import parts_of


@dataclass(frozen=True)
class Formula:
    """One derived formula, left = right, with all information needed to use and to trust it.

    name        its key on the sheet, e.g. "load"
    symbol      left-hand side, e.g. P
    arguments   the variables of which it is a function, e.g. (a, c)
    expr        right-hand side; may contain the frame's symbols theta_j, w_j, L_j
    meaning, unit, source
    conditions  assumptions under which it holds
    proof       the proof; None until there is one
    closes      name of the integral whose closed form this formula is; "" for all others
    computed    the form that is evaluated, if it differs: a sum over the parts of a contact
    """

    name: str
    symbol: Symbol
    arguments: tuple[Symbol, ...]
    expr: Expr
    meaning: str
    unit: str
    source: str
    conditions: tuple[Boolean, ...]
    proof: Proof | None = None
    closes: str = ""
    computed: Expr | None = None

    @property
    def head(self) -> str:
        """Left-hand side as text, e.g. P(a, c)."""
        return f"{self.symbol}({', '.join(str(argument) for argument in self.arguments)})"

    @property
    def assumptions(self) -> str:
        """The conditions as text."""
        return " and ".join(str(condition) for condition in self.conditions)

    @property
    def left(self) -> str:
        """Left-hand side in LaTeX, e.g. P(a, c)."""
        arguments = ", ".join(latex_of(argument) for argument in self.arguments)
        return rf"{latex_of(self.symbol)}({arguments})"

    def _repr_latex_(self) -> str:
        return rf"$\displaystyle {self.left} = {latex_of(self.expr)}$"


@dataclass(frozen=True, eq=False)
class FormulaSheet(Mapping[str, Formula]):
    """All formulas of one body, by name, in the order of their derivation.

    remark: the result of the search for closed forms, if formulas are integrals.
    """

    geometry: Geometry
    frame: Frame
    formulas: Mapping[str, Formula] = field(default_factory=dict)
    remark: str = ""

    def __getitem__(self, name: str) -> Formula:
        return self.formulas[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self.formulas)

    def __len__(self) -> int:
        return len(self.formulas)

    @cached_property
    def dimensions(self) -> dict[Symbol, Dimension]:
        """Dimension of every symbol that a formula may contain."""
        known = self.geometry.dimensions | {
            symbol: parse_unit(unit)
            for k in self.frame.kinks
            for symbol, unit in ((k.theta, "rad"), (k.w, "m"), (k.L, "-"))
        }
        for root in self.frame.roots:
            edge = dimension_of(root.quadratic, known) or NUMBER
            known |= {s: edge ** Rational(1, 2) for s in (root.left, root.right)}
            known |= {s: NUMBER for s in (root.m, root.n)}
        return known

    def plus(self, formula: Formula) -> "FormulaSheet":
        """Add a formula: a closed form directly below its integral, any other at the end.

        Raises DimensionMismatch if the formula does not have the dimension of its unit.
        """
        where = f"{formula.name} of {self.geometry.name!r}"
        check(formula.expr, formula.unit, where, self.dimensions)
        entries = list(self.formulas.items())
        place = list(self.formulas).index(formula.closes) + 1 if formula.closes else len(entries)
        entries.insert(place, (formula.name, formula))
        return replace(self, formulas=dict(entries))

    def demand_proven(self) -> "FormulaSheet":
        """Return the sheet itself.

        Raises NotProven if the proof of any formula is missing or insufficient.
        """
        for name, formula in self.items():
            if formula.proof is None or not formula.proof.holds:
                raise NotProven(f"{name} of {self.geometry.name!r}: {formula.proof}")
        return self

    def flat(self, name: str) -> Expr:
        """Right-hand side of a formula with every symbol of the frame written out."""
        return self.frame.flat(self[name].expr)

    def shown(self, name: str) -> Expr:
        """Right-hand side of a formula as printed: roots that are never clipped are written out."""
        roots = {k.w: k.root for k in self.frame.kinks if not k.clipped}
        return self[name].expr.xreplace(roots)

    @cached_property
    def definitions(self) -> dict[Symbol, Expr]:
        """Definitions of the frame's symbols that the formulas contain."""
        return self.defined_in(*self)

    def defined_in(self, *names: str) -> dict[Symbol, Expr]:
        """Definitions of the frame's symbols that the named formulas contain, as printed."""
        return self.frame.defined_in(*map(self.shown, names))

    def is_closed(self, name: str) -> bool:
        """Whether the sheet contains this formula and it is not an integral for quadrature."""
        return name in self and not self[name].expr.has(Integral)

    @cached_property
    def quantities(self) -> tuple[Quantity, ...]:
        """The body's own parameters and the theory's symbols that the formulas contain."""
        own = {p.symbol.name for p in self.geometry.parameters}
        held = {str(s) for f in self.values() for s in (*f.arguments, *f.expr.free_symbols)}
        theory = (q for name, q in QUANTITIES.items() if name in held and name not in own)
        return (*self.geometry.parameters, *theory)

    @property
    def latex(self) -> str:
        """All formulas as one LaTeX display."""
        rows = [rf"g(x) &= {latex_of(self.geometry.g)}"]
        for name, f in self.items():
            computed = "" if f.computed is None else f" = {latex_of(f.computed)}"
            rows.append(rf"{f.left} &= {latex_of(self.shown(name))}{computed}")
        rows += [
            rf"{latex_of(s)} &= {latex_of(definition)}"
            for s, definition in (self.definitions | self.computed_definitions).items()
        ]
        body = " \\\\\n".join(rows)
        return f"\\begin{{aligned}}\n{body}\n\\end{{aligned}}"

    def _repr_latex_(self) -> str:
        return f"$$\n{self.latex}\n$$"

    def equation(self, name: str) -> str:
        """A formula as a line of text."""
        return f"{self[name].head} = {text_of(self.shown(name))}"

    def computed_as(self, name: str) -> str:
        """The form that is evaluated, as a line of text; "" if it is the formula itself."""
        formula = self[name]
        return "" if formula.computed is None else f"{formula.head} = {text_of(formula.computed)}"

    @cached_property
    def computed_definitions(self) -> dict[Expr, Expr]:
        """Definitions of the symbols and functions in the evaluated forms."""
        forms = [f.computed for f in self.values() if f.computed is not None]
        return parts_of(self.frame).defined_in(forms) if forms else {}

    @property
    def title(self) -> str:
        """The body and its profile as a line of text."""
        return f"{self.geometry.name}: g(x) = {text_of(self.geometry.g)}"

    def __str__(self) -> str:
        """Every formula with its meaning, unit, assumptions, source and proof."""
        lines = [self.title, *([self.remark] if self.remark else []), ""]
        for name, formula in self.items():
            lines += [
                f"{name}: {formula.meaning} [{formula.unit}]",
                f"    {self.equation(name)}",
                *([f"    computed as {computed}"] if (computed := self.computed_as(name)) else []),
                f"    if {formula.assumptions}",
                f"    {formula.proof or 'not proven yet'}",
                f"    source: {formula.source}",
            ]
        lines += ["where"]
        defined = self.definitions | self.computed_definitions
        lines += [f"    {s} = {text_of(definition)}" for s, definition in defined.items()]
        lines += [f"    {q.name}: {q.meaning} [{q.unit}]" for q in self.quantities]
        return "\n".join(lines)


POSITIVE_LOAD = Gt(P, 0, evaluate=False)
"""The bodies are pressed together."""


def contact_conditions(frame: Frame) -> tuple[Boolean, ...]:
    """Conditions for a contact [-a, c]: it has a width and extends beyond any straight piece.

    A body that is straight over the whole contact would carry no load.
    """
    conditions = []
    for piece in frame.slope.straight_pieces:
        left, right = a > -piece.lower, c > piece.upper
        if piece.lower == -oo:
            conditions.append(right)
        elif piece.upper == oo:
            conditions.append(left)
        else:
            conditions.append(Or(left, right))
    low, high = frame.slope.domain
    conditions += [a < -low] * low.is_finite + [c < high] * high.is_finite
    conditions += frame.slope.demands
    spans = {str(condition): condition for condition in conditions}
    return (h > 0, *(spans[name] for name in sorted(spans)))


def load_conditions(frame: Frame) -> tuple[Boolean, ...]:
    """The load must be positive; any moment that the flanks can carry is allowed."""
    return (POSITIVE_LOAD, *frame.slope.demands)


def tilt_conditions(frame: Frame) -> tuple[Boolean, ...]:
    """The tilted body must have slopes of both signs at its ends, or the contact cannot close."""
    low, high = frame.slope.limits
    bounds = []
    if high != oo:
        bounds.append(alpha > -high)
    if low != -oo:
        bounds.append(alpha < -low)
    return (POSITIVE_LOAD, *bounds, *frame.slope.demands)


def inside_contact(frame: Frame, place: Symbol) -> tuple[Boolean, ...]:
    """Conditions under which `place` lies inside the contact."""
    return (*contact_conditions(frame), place > -a, place < c)
