"""Read an equation or a condition that a user typed, without executing any of it.

The grammar is that of g(x) in derive.writing.grammar: numbers, names, + - * / **, functions, pairs
of a Piecewise, and conditions.  The names must be declared in the claims file.  In addition to the
functions of g(x), the following are available: elliptic integrals of the parameter m = k**2,
gamma_function, the formulas on the body's formula sheet, which remain calls until they are
substituted, and

    integral(f, s, low, high)     pv(f, s, low, high)     sum(f, k, low, high)
    diff(f, x)    diff(f, x, 2)   limit(f, x, end)

The variable of an integral, a sum or a limit need not be declared; it is then known only inside
that call.  Their ends may be `oo` or `-oo`.
"""

import operator
import re
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from sympy import (
    Derivative,
    Expr,
    Integral,
    Limit,
    Min,
    Mul,
    S,
    Sum,
    Symbol,
    degree,
    denom,
    oo,
    solve,
    together,
)
from sympy import Function as SymPyFunction
from sympy.logic.boolalg import Boolean
from sympy.printing.latex import LatexPrinter

from derive.errors import BadFormula, BadText
from derive.paper.claim import Relation
from derive.writing.grammar import Call, Name, Negative, Node, parse
from derive.writing.limits import fault
from derive.writing.meaning import Meaning, walk
from derive.writing.tokens import LONGEST
from derive.writing.vocabulary import FUNCTIONS, KEYWORDS, Words
from derive.writing.vocabulary import Function as Known

_DEEPEST = 40
_MOST_TERMS = 200
"""The largest number of terms in a finite sum."""

_FUNCTIONS = {
    **FUNCTIONS,
    "elliptic_k": Known("elliptic_k"),
    "elliptic_e": Known("elliptic_e"),
    "elliptic_pi": Known("elliptic_pi", 2, 2),
    "gamma_function": Known("gamma"),
}
_BOUND = {
    "integral": Known("", 4, 4),
    "pv": Known("", 4, 4),
    "sum": Known("", 4, 4),
    "diff": Known("", 3, 2),
    "limit": Known("", 3, 3),
}
"""Functions that act along a variable, which is their second argument."""
_OWN = frozenset(("integral", "pv", "sum", "limit"))
"""Functions of `_BOUND` whose variable need not be declared."""

_ROUNDED_FROM = 3
"""A decimal number with at least this many digits may be a rounded one."""
FROM_POLE = "_from_pole"
"""Suffix of the variable of a folded principal value, whose upper end must be positive."""
_RELATION = re.compile(r"<=|>=|==|=|<|>|~|[(),]")
_ALIASES = {"==": "="}


@dataclass(frozen=True)
class Names:
    """The names that a formula may hold.

    where    the file and the claim, for error messages
    symbols  the symbol or expression for every name
    calls    the names of the formulas on a sheet, each with its number of arguments
    """

    where: str
    symbols: Mapping[str, Expr]
    calls: Mapping[str, int]

    @cached_property
    def words(self) -> Words:
        """The functions that may be called."""
        calls = {name: Known("", count, count) for name, count in self.calls.items()}
        return Words({**_FUNCTIONS, **_BOUND, **calls}, of_parameters=False, deepest=_DEEPEST)


class UnknownName(BadFormula):
    """A formula that contains an unknown name."""


class NoPole(BadFormula):
    """A principal value whose integrand does not have exactly one recognisable pole."""


def equation(text: str, names: Names, rough: bool = False) -> tuple[Expr, Relation, Expr]:
    """Return the left side, the relation and the right side; raises BadFormula.

    rough: whether the relation may be ~.
    """
    relations, depth = list[re.Match[str]](), 0
    for each in _RELATION.finditer(text):
        depth += (each[0] == "(") - (each[0] == ")")
        if depth == 0 and each[0] not in "(),":
            relations.append(each)
    if len(relations) != 1:
        column = relations[1].start() if relations else len(text)
        why = "there are two relations here" if relations else "there is no relation here"
        raise BadFormula(names.where, text, column, why, "write exactly one, as in left = right")
    start, end = relations[0].span()
    if relations[0].group() == "~" and not rough:
        why = "~ cannot be checked without a limit"
        remedy = "add as = 'x -> 0' to the claim, or equate the leading terms with ="
        raise BadFormula(names.where, text, start, why, remedy)
    relation = Relation(_ALIASES.get(relations[0].group(), relations[0].group()))
    left = formula(text[:start], names)
    return left, relation, formula(" " * end + text[end:], names)


def unknown(text: str, names: Names) -> list[str]:
    """Return all unknown names in a text."""
    names_found = set[str]()
    for part in re.split(r"<=|>=|==|=|~", text):
        try:
            names_found |= _open_names(_tree(part, names), names)
        except BadText:
            continue
    return sorted(names_found)


def _open_names(tree: Node, names: Names) -> set[str]:
    """Return the unknown names of a tree; a bound variable is known only inside its call."""
    bound = set[int]()
    for node in walk(tree):
        if isinstance(node, Call) and node.function in _OWN:
            inside, along, *_ = node.arguments
            if isinstance(along, Name):
                held = [along, *(n for n in walk(inside) if isinstance(n, Name))]
                bound |= {id(each) for each in held if each.name == along.name}
    held_names = {n.name for n in walk(tree) if isinstance(n, Name) and id(n) not in bound}
    return held_names - names.symbols.keys() - {"oo"}


def formula(text: str, names: Names) -> Expr:
    """Read `text` as an expression; raises BadFormula."""
    return _read(text, names, lambda reader, tree: reader.value(tree))


def condition(text: str, names: Names) -> Boolean:
    """Read `text`, such as 0 < b and b < w, as a condition; raises BadFormula."""
    return _read(text, names, lambda reader, tree: reader.condition(tree))


def approach(text: str, names: Names) -> tuple[Expr, Expr]:
    """Read a limit such as "c - x -> 0" as an expression and its end; raises BadFormula."""
    parts = text.split("->")
    if len(parts) != 2:
        raise BadFormula(names.where, text, 0, "this is not a limit", "write one such as x -> 0")
    first = formula(parts[0], names)
    end = parts[1].strip()
    if end in ("oo", "-oo"):
        return first, oo if end == "oo" else -oo
    return first, formula(" " * (len(parts[0]) + 2) + parts[1], names)


def _tree(text: str, names: Names) -> Node:
    return parse(text, names.words)


def _read(text: str, names: Names, convert: Callable[["_Reader", Node], Any]) -> Any:
    if len(text) > LONGEST:
        why = f"the formula has {len(text)} characters, and at most {LONGEST} are read"
        remedy = "define parts of it as symbols"
        raise BadFormula(names.where, text[:LONGEST], LONGEST, why, remedy)
    try:
        return convert(_Reader(text, names), _tree(text, names))
    except BadText as error:
        raise BadFormula(names.where, text, error.column, error.why, error.remedy) from error


class _Reader(Meaning):
    """Read values and conditions in one text of a claims file."""

    def __init__(self, text: str, names: Names) -> None:
        super().__init__(text, names.symbols)
        if "x" not in names.symbols:
            del self.symbols["x"]
        self.names = names

    def named(self, node: Name) -> Expr:
        """Return the expression for a name; raises UnknownName."""
        if node.name not in self.symbols:
            known = ", ".join(sorted(self.names.symbols))
            why = f"the claims file does not define {node.name}"
            remedy = f"define it, or use one of the known names {known}"
            raise UnknownName(self.names.where, self.text, node.column, why, remedy)
        return self.symbols[node.name]

    def call(self, node: Call) -> Expr:
        """Return the value of a function; a formula of the sheet remains a call."""
        name = node.function
        if name in _BOUND:
            return self._bound(node)
        arguments = [self.value(argument) for argument in node.arguments]
        if name in self.names.calls:
            return SymPyFunction(name)(*arguments)
        return self.step(node.column, _FUNCTIONS[name].of_sympy, *arguments)

    def _bound(self, node: Call) -> Expr:
        over, along, *ends = node.arguments
        if not isinstance(along, Name):
            why = "the second argument is not a variable"
            raise self.refusal(node.column, why, f"write {node.function}(f, s, ...)")
        limits = [self._end(end, node.function) for end in ends]
        before = dict(self.symbols)
        if along.name not in self.symbols or node.function == "sum":
            if node.function not in _OWN:
                self.named(along)
            self.symbols[along.name] = Symbol(along.name, real=True)
        variable = self.named(along)
        inside = self.value(over)
        self.symbols = before
        if not isinstance(variable, Symbol):
            why = "the second argument is not a variable"
            raise self.refusal(node.column, why, f"write {node.function}(f, s, ...)")
        return self._made(node, inside, variable, limits)

    def _end(self, node: Node, function: str) -> Expr:
        """Return an end of an integral, a sum or a limit, which may be infinite."""
        inner = node.operand if isinstance(node, Negative) else node
        if isinstance(inner, Name) and inner.name == "oo" and function != "diff":
            if function == "pv":
                why = "an end of this principal value is infinite"
                raise self.refusal(node.column, why, "split off an integral without a pole")
            return -oo if isinstance(node, Negative) else oo
        return self.value(node)

    def _made(self, node: Call, inside: Expr, variable: Symbol, limits: list[Expr]) -> Expr:
        mirrored = inside.subs(variable, -variable) if -oo in limits else inside
        match node.function:
            case "integral" if limits[0] == oo or limits[1] == -oo:
                why = "the ends of this integral are in the wrong order"
                raise self.refusal(node.column, why, "write the smaller end first")
            case "integral" if limits == [-oo, oo]:
                return ToInfinity(mirrored, variable, S.Zero) + ToInfinity(inside, variable, S.Zero)
            case "integral" if limits[0] == -oo:
                return ToInfinity(mirrored, variable, -limits[1])
            case "integral" if limits[1] == oo:
                return ToInfinity(inside, variable, limits[0])
            case "integral":
                return Integral(inside, (variable, *limits))
            case "pv":
                return PrincipalValue(inside, variable, *limits)
            case "sum":
                return self._sum(node, inside, variable, *limits)
            case "limit":
                # a variable that is known only inside a limit at zero is a small positive one
                small = variable.is_positive or variable not in self.names.symbols.values()
                from_above = small and limits[0] == 0
                return Limit(inside, variable, *limits, dir="+" if from_above else "+-")
        times = limits[0] if limits else S.One
        if not (times.is_Integer and 0 < times < 5):
            why = "the order of this derivative is not allowed"
            raise self.refusal(node.column, why, "write a whole number from 1 to 4")
        return Derivative(inside, (variable, times))

    def _sum(self, node: Call, inside: Expr, along: Symbol, low: Expr, high: Expr) -> Expr:
        if not low.is_Integer or not (high.is_Integer or high == oo):
            why = "the ends of this sum are not whole numbers"
            raise self.refusal(node.column, why, "write whole numbers, or oo for the upper end")
        if high == oo:
            count = Symbol(along.name, integer=True)
            done = Sum(inside.xreplace({along: count}), (count, low, high)).doit()
            if done.has(Sum) or not isinstance(done, Expr) or fault(done):
                why = "no closed form of this infinite sum is known"
                raise self.refusal(node.column, why, "write its value, or finitely many terms")
            return done
        if high - low >= _MOST_TERMS:
            why = f"this sum has more than {_MOST_TERMS} terms"
            raise self.refusal(node.column, why, "write a shorter sum or its closed form")
        total: Expr = S.Zero
        for n in range(int(low), int(high) + 1):
            term = inside.xreplace({along: S(n)})
            total = self.step(node.column, operator.add, total, term)
        return total


class PrincipalValue(SymPyFunction):
    """The principal value of an integral along a symbol between two ends; see `proper`."""

    nargs = 4
    integrates = True

    def _latex(self, printer: LatexPrinter) -> str:
        inside, *limits = self.args
        return rf"\mathrm{{PV}}\!{printer._print(Integral(inside, tuple(limits)))}"


class ToInfinity(SymPyFunction):
    """An integral along a symbol from a lower end to infinity."""

    nargs = 3
    integrates = True

    def _latex(self, printer: LatexPrinter) -> str:
        inside, *limits = self.args
        return str(printer._print(Integral(inside, (*limits, oo))))


IMPROPER = (PrincipalValue, ToInfinity)


def proper(expr: Any) -> Any:
    """Rewrite all integrals without poles and with finite ends; raises NoPole."""
    return expr.replace(lambda n: isinstance(n, IMPROPER), _proper)


def _proper(node: Expr) -> Expr:
    inside, along, low, *high = node.args
    if isinstance(node, ToInfinity):
        moved = low + along / (1 - along)
        return Integral(inside.subs(along, moved) / (1 - along) ** 2, (along, 0, 1))
    return _folded(inside, along, low, *high)


def _folded(inside: Expr, along: Symbol, low: Expr, high: Expr) -> Expr:
    """Write a principal value as the integrand folded about its pole, plus the remainder."""
    poles = set[Expr]()
    for factor in Mul.make_args(denom(together(inside))):
        if factor.is_polynomial(along) and factor.has(along) and degree(factor, along) == 1:
            poles |= set(solve(factor, along))
    if len(poles) != 1:
        why = "the integrand does not have exactly one recognisable pole"
        text = str(inside)
        remedy = "write its denominator with one factor such as s - x"
        raise NoPole("a principal value", text, 0, why, remedy)
    (pole,) = poles
    distance = Symbol(along.name + FROM_POLE, real=True)
    reach = Min(pole - low, high - pole)  # the nearer end
    both = inside.subs(along, pole + distance) + inside.subs(along, pole - distance)
    around = Integral(together(both), (distance, 0, reach))
    left = Integral(inside, (along, low, pole - reach))
    return around + left + Integral(inside, (along, pole + reach, high))


def rounded_in(text: str) -> list[re.Match[str]]:
    """Find the decimal numbers that have enough digits to be rounded values."""
    decimals = re.finditer(r"(?<![\w.])\d*\.\d+(?![\w.])", text)
    return [n for n in decimals if len(n[0].replace(".", "").lstrip("0")) >= _ROUNDED_FROM]


def may_be_rounded(text: str) -> bool:
    """Whether a formula contains a number that may be rounded."""
    return bool(rounded_in(text))


def usable(name: str, taken: Collection[str] = ()) -> bool:
    """Whether a name may be declared in a claims file."""
    plain = re.fullmatch(r"[A-Za-z][A-Za-z0-9_]*", name) is not None
    reserved = {"pi", "oo", "and", "or", "not", *KEYWORDS, *_FUNCTIONS, *_BOUND, *taken}
    return plain and name not in reserved
