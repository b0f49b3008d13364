"""Read an equation or a condition that a user typed, without executing any of it.

The grammar is that of g(x) in derive.reading.text.  The names must be declared in the claims file.
In addition to the functions of derive.reading.words, the following are available: the formulas on
the body's formula sheet, which remain calls until they are substituted, and

    integral(f, s, low, high)     pv(f, s, low, high)     sum(f, k, low, high)
    diff(f, x)    diff(f, x, 2)   limit(f, x, end)

The variable of an integral, a sum or a limit need not be declared; it is then known only inside
that call.  Their ends may be `oo` or `-oo`.
"""

import operator
import re
from collections.abc import Callable, Collection, Mapping
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from lark import Token
from lark import Tree as Branch
from sympy import Derivative, Expr, Integral, Limit, S, Sum, Symbol, oo
from sympy import Function as SymPyFunction
from sympy.logic.boolalg import Boolean

from derive.command.errors import BadFormula, BadText
from derive.reading.improper import PrincipalValue, ToInfinity
from derive.reading.limits import fault
from derive.reading.relation import Relation
from derive.reading.text import LONGEST, Call, Node, Tree, column, parse
from derive.reading.value import Meaning
from derive.reading.words import FUNCTIONS, KEYWORDS, LOGICAL, PI, Function, Words

_DEEPEST = 40
_MOST_TERMS = 200
"""The largest number of terms in a finite sum."""

_ALONG = {
    "integral": Function(Integral, most=4, least=4),
    "pv": Function(PrincipalValue, most=4, least=4),
    "sum": Function(Sum, most=4, least=4),
    "diff": Function(Derivative, most=3, least=2),
    "limit": Function(Limit, most=3, least=3),
}
"""Functions that act along a variable, which is their second argument."""
_BINDING = _ALONG.keys() - {"diff"}
"""Functions whose variable need not be declared."""

_ROUNDED_FROM = 3
"""A decimal number with at least this many digits may be a rounded one."""


@dataclass(frozen=True)
class Names:
    """The names that a formula may hold.

    where    the file and the claim, for error messages
    symbols  the symbol or expression for every name
    calls    the names of the formulas on a sheet, each with its number of arguments
    meant    the names that have a meaning, which no integral, sum, limit or derivative runs over
    """

    where: str
    symbols: Mapping[str, Expr]
    calls: Mapping[str, int]
    meant: frozenset[str] = frozenset()

    @cached_property
    def words(self) -> Words:
        """The functions that may be called."""
        calls = {
            name: Function(SymPyFunction(name), most=count, least=count)
            for name, count in self.calls.items()
        }
        return Words({**FUNCTIONS, **_ALONG, **calls}, _DEEPEST)


class UnknownName(BadFormula):
    """A formula that contains an unknown name."""


def equation(text: str, names: Names, rough: bool = False) -> tuple[Expr, Relation, Expr]:
    """Return the left side, the relation and the right side; raises BadFormula.

    rough: whether the relation may be ~.
    """
    return _read(text, names, lambda reader: reader.equation(rough), "relation")


def sides(text: str, names: Names) -> tuple[str, str]:
    """Return the text of the left and of the right side; raises BadFormula."""
    sign = _read(text, names, lambda reader: reader.tree.whole.children[1], "relation")
    return text[: column(sign)].strip(), text[column(sign) + len(sign) :].strip()


def unknown(text: str, names: Names) -> list[str]:
    """Return all unknown names in a text; a bound variable is known only inside its call."""
    found = set[str]()
    for start in ("relation", "text"):
        with suppress(BadText):
            found |= _free(parse(text, names.words, start).whole)
    return sorted(found - names.symbols.keys() - {"oo"})


def _free(node: Node) -> set[str]:
    """Return the names in a node that none of its calls bind."""
    if isinstance(node, Token):
        return {str(node)} if node.type == "NAME" else set()
    first, *others = map(_free, node.children)
    if node.data == "call" and node.children[0] in _BINDING:
        over, along, *others = others
        first = over - along if isinstance(node.children[2], Token) else over | along
    return first.union(*others)


def formula(text: str, names: Names) -> Expr:
    """Read `text` as an expression; raises BadFormula."""
    return _read(text, names, lambda reader: reader.value(reader.tree.root))


def condition(text: str, names: Names) -> Boolean:
    """Read `text`, such as 0 < b and b < w, as a condition; raises BadFormula."""
    return _read(text, names, lambda reader: reader.condition(reader.tree.root))


def approach(text: str, names: Names) -> tuple[Expr, Expr]:
    """Read a limit such as "c - x -> 0" as an expression and its end; raises BadFormula."""
    return _read(text, names, lambda reader: reader.approach(), "relation")


def _read(text: str, names: Names, convert: Callable[["_Reader"], Any], start: str = "text") -> Any:
    try:
        return convert(_Reader(parse(text, names.words, start), names))
    except BadText as error:
        shown = error.given[: 2 * LONGEST]
        raise BadFormula(names.where, shown, error.column, error.why, error.remedy) from error


class _Reader(Meaning):
    """Read values and conditions in one text of a claims file."""

    def __init__(self, tree: Tree, names: Names) -> None:
        super().__init__(tree, names.symbols)
        self.names = names

    def equation(self, rough: bool) -> tuple[Expr, Relation, Expr]:
        """Return the sides and the relation of an equation."""
        left, sign, right = self.tree.whole.children
        if sign == "->":
            raise self.refusal(sign, "a limit is not an equation", "write it in `as`")
        if sign == "~" and not rough:
            remedy = "add as = 'x -> 0' to the claim, or equate the leading terms with ="
            raise self.refusal(sign, "~ cannot be checked without a limit", remedy)
        return self.value(left), Relation(str(sign).replace("==", "=")), self.value(right)

    def approach(self) -> tuple[Expr, Expr]:
        """Return an expression and its end, which may be infinite."""
        left, sign, right = self.tree.whole.children
        if sign != "->":
            raise self.refusal(sign, "this is not a limit", "write one such as x -> 0")
        return self.value(left), self._end(right, "limit")

    def named(self, node: Token) -> Expr:
        """Return the expression for a name; raises UnknownName."""
        if node not in self.symbols:
            known = ", ".join(sorted(self.names.symbols))
            why = f"the claims file does not define {node}"
            remedy = f"define it, or use one of the known names {known}"
            raise UnknownName(self.names.where, self.tree.text, column(node), why, remedy)
        return self.symbols[node]

    def call(self, node: Call, name: str) -> Expr:
        """Return the value of a function; a formula of the sheet remains a call."""
        if name in _ALONG:
            return self._along(node, name, *node.children[1:])
        return super().call(node, name)

    def _along(self, node: Call, name: str, over: Node, along: Node, *ends: Node) -> Expr:
        """Return an integral, a sum, a limit or a derivative."""
        why, remedy = "the second argument is not a variable", f"write {name}(f, s, ...)"
        if not isinstance(along, Token) or along.type != "NAME":
            raise self.refusal(node, why, remedy)
        if along in self.names.meant:
            why = f"{along} has a meaning, so that {name} cannot run over it"
            raise self.refusal(along, why, "use a variable, or a name that is not defined")
        limits, outside = [self._end(end, name) for end in ends], self.symbols
        if name in _BINDING and (along not in outside or name == "sum"):
            self.symbols = {**outside, along: Symbol(str(along), real=True)}
        variable, inside = self.named(along), self.value(over)
        self.symbols = outside
        if not isinstance(variable, Symbol):
            raise self.refusal(node, why, remedy)
        match name:
            case "integral":
                return self._integral(node, inside, variable, *limits)
            case "pv":
                return PrincipalValue(inside, variable, *limits)
            case "sum":
                hidden = {each.name for each in inside.free_symbols} & self.names.meant
                if hidden and along in outside and outside[along].is_real:
                    why = f"{min(hidden)} has a meaning that may depend on the variable {along}"
                    raise self.refusal(along, why, "sum over a name that the file does not declare")
                return self._sum(node, inside, variable, *limits)
            case "limit":
                # a variable that is known only inside a limit at zero is a small positive one
                small = variable.is_positive or variable not in self.names.symbols.values()
                from_above = small and limits[0] == 0
                return Limit(inside, variable, *limits, dir="+" if from_above else "+-")
        times = limits[0] if limits else S.One
        if not (times.is_Integer and 0 < times < 5):
            why = "the order of this derivative is not allowed"
            raise self.refusal(node, why, "write a whole number from 1 to 4")
        return Derivative(inside, (variable, times))

    def _end(self, node: Node, name: str) -> Expr:
        """Return an end of an integral, a sum or a limit, which may be infinite."""
        sign, inner = (
            node.children if isinstance(node, Branch) and len(node.children) == 2 else ("+", node)
        )
        if name == "diff" or inner != "oo":
            return self.value(node)
        if name == "pv":
            why = "an end of this principal value is infinite"
            raise self.refusal(node, why, "split off an integral without a pole")
        return -oo if sign == "-" else oo

    def _integral(self, node: Call, inside: Expr, along: Symbol, low: Expr, high: Expr) -> Expr:
        if low == oo or high == -oo:
            why = "the ends of this integral are in the wrong order"
            raise self.refusal(node, why, "write the smaller end first")
        if low == -oo:
            mirrored = inside.subs(along, -along)
            if high == oo:
                return ToInfinity(mirrored, along, S.Zero) + ToInfinity(inside, along, S.Zero)
            return ToInfinity(mirrored, along, -high)
        if high == oo:
            return ToInfinity(inside, along, low)
        return Integral(inside, (along, low, high))

    def _sum(self, node: Call, inside: Expr, along: Symbol, low: Expr, high: Expr) -> Expr:
        if not low.is_Integer or not (high.is_Integer or high == oo):
            why = "the ends of this sum are not whole numbers"
            raise self.refusal(node, why, "write whole numbers, or oo for the upper end")
        if high == oo:
            count = Symbol(along.name, integer=True)
            done = Sum(inside.xreplace({along: count}), (count, low, high)).doit()
            if done.has(Sum) or not isinstance(done, Expr) or fault(done):
                why = "no closed form of this infinite sum is known"
                raise self.refusal(node, why, "write its value, or finitely many terms")
            return done
        if high - low >= _MOST_TERMS:
            why = f"this sum has more than {_MOST_TERMS} terms"
            raise self.refusal(node, why, "write a shorter sum or its closed form")
        total: Expr = S.Zero
        for n in range(int(low), int(high) + 1):
            total = self.step(node, operator.add, total, inside.xreplace({along: S(n)}))
        return total


def rounded_in(text: str) -> list[re.Match[str]]:
    """Find the decimal numbers that have enough digits to be rounded values."""
    decimals = re.finditer(r"(?<![\w.])\d*\.\d+(?![\w.])", text)
    return [n for n in decimals if len(n[0].replace(".", "").lstrip("0")) >= _ROUNDED_FROM]


def usable(name: str, taken: Collection[str] = ()) -> bool:
    """Whether a name may be declared in a claims file."""
    plain = re.fullmatch(r"[A-Za-z][A-Za-z0-9_]*", name) is not None
    reserved = {PI, "oo", *LOGICAL, *KEYWORDS, *FUNCTIONS, *_ALONG, *taken}
    return plain and name not in reserved
