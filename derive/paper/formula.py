"""Reads an equation that a user typed; nothing of it is executed.

    equation  ::= sum ("=" | "==" | "<" | "<=" | ">" | ">=") sum
    sum       ::= product (("+" | "-") product)*
    product   ::= unary (("*" | "/") unary)*
    unary     ::= ("+" | "-")* power
    power     ::= primary ("**" unary)?
    primary   ::= number | name | name "(" sum ("," sum)* ")" | "(" sum ")"

Names are those that the claims file declares; functions are those below, `integral(f, s, low,
high)`, and the formulas of the body's sheet, which stay calls until they are put in.  Numbers are
exact.  Every step is held against the limits of derive.writing.
"""

import operator
import re
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from sympy import (
    Expr,
    Function,
    Integral,
    Rational,
    Symbol,
    elliptic_e,
    elliptic_k,
    elliptic_pi,
    pi,
)

from derive.errors import BadFormula, BadText
from derive.paper.claim import Relation
from derive.writing.limits import STEEPEST, fault, reach
from derive.writing.tokens import END, LONGEST, NAME, NUMBER, Token, tokens
from derive.writing.vocabulary import FUNCTIONS

_DEEPEST = 40
_DIGITS = 40
_INTEGRAL = "integral"

_OF_SYMPY: dict[str, tuple[Callable[..., Expr], int]] = {
    **{name: (known.of_sympy, 1) for name, known in FUNCTIONS.items() if known.most == 1},
    "elliptic_k": (elliptic_k, 1),
    "elliptic_e": (elliptic_e, 1),
    "elliptic_pi": (elliptic_pi, 2),
}
"""Functions and how many arguments they take; elliptic integrals take the parameter m = k**2."""

_RELATION = re.compile(r"<=|>=|==|=|<|>|~")
_MEANT = {"==": "="}


@dataclass(frozen=True)
class Names:
    """What a formula may hold.

    where    for messages: the file and the claim
    symbols  a symbol, or an expression, for every name
    calls    names of the formulas of a sheet, with how many arguments each takes
    """

    where: str
    symbols: Mapping[str, Expr]
    calls: Mapping[str, int]


class UnknownName(BadFormula):
    """A formula that holds a name of which nothing is known yet."""


def equation(text: str, names: Names) -> tuple[Expr, Relation, Expr]:
    """Both sides, and what stands between them; raises BadFormula."""
    found = list(_RELATION.finditer(text))
    if len(found) != 1:
        column = found[1].start() if found else len(text)
        why = "there are two relations here" if found else "there is no relation here"
        raise BadFormula(names.where, text, column, why, "write left = right, once")
    start, end = found[0].span()
    if found[0].group() == "~":
        why = "~ says nothing that could be wrong"
        raise BadFormula(names.where, text, start, why, "write the leading terms with =")
    relation = Relation(_MEANT.get(found[0].group(), found[0].group()))
    left = formula(text[:start], names)
    return left, relation, formula(" " * end + text[end:], names)


def unknown(text: str, names: Names) -> list[str]:
    """All names of a text of which nothing is known."""
    known = {"pi", _INTEGRAL, *_OF_SYMPY, *names.symbols, *names.calls}
    found = re.findall(r"(?<![0-9.A-Za-z_])[A-Za-z_][A-Za-z0-9_]*", text)
    return sorted(set(found) - known)


def formula(text: str, names: Names) -> Expr:
    """The expression that `text` is; raises BadFormula."""
    if len(text) > LONGEST:
        why = f"the formula has {len(text)} characters, {LONGEST} are the most"
        raise BadFormula(names.where, text[:LONGEST], LONGEST, why, "name parts of it as symbols")
    try:
        return _Reader(text, names).whole()
    except BadText as error:
        raise BadFormula(names.where, text, error.column, error.why, error.remedy) from error


class _Reader:
    """Recursive descent with one token ahead."""

    def __init__(self, text: str, names: Names) -> None:
        self.text, self.names = text, names
        self._tokens = tokens(text)
        self.here = next(self._tokens)
        self._depth = 0

    def whole(self) -> Expr:
        value = self._sum()
        if self.here.kind != END:
            raise self._refusal("this is left over", "write an operator before it")
        return value

    def _sum(self) -> Expr:
        return self._chain(self._product, {"+": operator.add, "-": operator.sub})

    def _product(self) -> Expr:
        return self._chain(self._unary, {"*": operator.mul, "/": operator.truediv})

    def _chain(self, part: Callable[[], Expr], known: Mapping[str, Callable[..., Any]]) -> Expr:
        value = part()
        while self.here.among(*known):
            sign = self._take()
            value = self._step(sign, known[sign.text], value, part())
        return value

    def _unary(self) -> Expr:
        negative = False
        while self.here.among("-", "+"):
            negative ^= self._take().text == "-"
        value = self._power()
        return -value if negative else value

    def _power(self) -> Expr:
        base = self._primary()
        if not self.here.among("**"):
            return base
        sign = self._take()
        exponent = self._deeper(sign, self._unary)
        if reach(exponent) > STEEPEST:
            raise self._refusal("the exponent is too large", f"stay below {STEEPEST}", sign)
        return self._step(sign, operator.pow, base, exponent)

    def _primary(self) -> Expr:
        token = self.here
        if token.kind == NUMBER:
            return self._number()
        if token.kind == NAME:
            return self._named()
        if token.among("("):
            self._take()
            value = self._deeper(token, self._sum)
            self._close()
            return value
        raise self._refusal("a number, a name or ( is missing here", "complete the formula")

    def _number(self) -> Expr:
        mantissa, _, power = self.here.text.lower().partition("e")
        if len(mantissa) > _DIGITS or len(power) > 3:
            raise self._refusal("the number is too long", f"write at most {_DIGITS} digits")
        value = Fraction(self._take().text)
        return Rational(value.numerator, value.denominator)

    def _named(self) -> Expr:
        token = self._take()
        if self.here.among("("):
            return self._call(token)
        if token.text == "pi":
            return pi
        if token.text not in self.names.symbols:
            known = ", ".join(sorted(self.names.symbols))
            why, remedy = f"nothing says what {token.text} is", f"known are {known}"
            raise UnknownName(self.names.where, self.text, token.column, why, remedy)
        return self.names.symbols[token.text]

    def _call(self, name: Token) -> Expr:
        wanted = self._arity(name)
        self._take()
        arguments = [self._deeper(name, self._sum)]
        while self.here.among(","):
            self._take()
            arguments.append(self._deeper(name, self._sum))
        self._close()
        if len(arguments) != wanted:
            given = f"{name.text} takes {wanted} arguments, here are {len(arguments)}"
            raise self._refusal(given, "write all of them and no more", name)
        if name.text == _INTEGRAL:
            return self._integral(name, *arguments)
        if name.text in self.names.calls:
            return Function(name.text)(*arguments)
        return self._step(name, _OF_SYMPY[name.text][0], *arguments)

    def _arity(self, name: Token) -> int:
        if name.text == _INTEGRAL:
            return 4
        if name.text in self.names.calls:
            return self.names.calls[name.text]
        if name.text in _OF_SYMPY:
            return _OF_SYMPY[name.text][1]
        known = ", ".join([*sorted(_OF_SYMPY), _INTEGRAL, *sorted(self.names.calls)])
        why = f"{name.text} is no function"
        raise self._refusal(why, f"write {name.text}*(...) for a product; known are {known}", name)

    def _integral(self, name: Token, over: Expr, along: Expr, low: Expr, high: Expr) -> Expr:
        if not isinstance(along, Symbol):
            why = "the second argument is no variable"
            raise self._refusal(why, "write integral(f, s, low, high)", name)
        if any(part.has(Integral) for part in (over, low, high)):
            why = "an integral inside an integral is not computed"
            raise self._refusal(why, "do one of them by hand", name)
        return Integral(over, (along, low, high))

    def _close(self) -> None:
        if not self.here.among(")"):
            raise self._refusal("a parenthesis is not closed here", "add ) or an operator")
        self._take()

    def _step(self, token: Token, compute: Callable[..., Any], *operands: Expr) -> Expr:
        """One step, refused where it leads to no formula of real numbers."""
        try:
            value = compute(*operands)
            why = fault(value)
        except (ArithmeticError, TypeError, ValueError) as error:
            why = f"this cannot be computed ({error})"
            raise self._refusal(why, "write it anew", token) from error
        if why:
            raise self._refusal(f"the result {why}", "write another formula", token)
        return value

    def _deeper(self, token: Token, part: Callable[[], Expr]) -> Expr:
        if self._depth == _DEEPEST:
            raise self._refusal("this is nested too deep", "use fewer parentheses", token)
        self._depth += 1
        value = part()
        self._depth -= 1
        return value

    def _take(self) -> Token:
        token, self.here = self.here, next(self._tokens)
        return token

    def _refusal(self, why: str, remedy: str, token: Token | None = None) -> BadFormula:
        column = (token or self.here).column
        return BadFormula(self.names.where, self.text, column, why, remedy)


def usable(name: str, taken: Collection[str] = ()) -> bool:
    """Whether a name may be declared in a claims file."""
    plain = re.fullmatch(r"[A-Za-z][A-Za-z0-9_]*", name) is not None
    return plain and name not in {"pi", _INTEGRAL, *_OF_SYMPY, *taken}
