"""Reads a text, g(x) or a formula of a claims file, into a tree without computing anything.

    or          ::= and (("or" | "|") and)*
    and         ::= not (("and" | "&") not)*
    not         ::= ("not" | "~")* comparison
    comparison  ::= sum (("<" | "<=" | ">" | ">=") sum)*
    sum         ::= product (("+" | "-") product)*
    product     ::= unary (("*" | "/") unary)*
    unary       ::= ("+" | "-")* power
    power       ::= primary ("**" unary)?
    primary     ::= number | name | "pi" | "True" | name "(" or ("," or)* ")"
                  | "(" or ")" | "(" or "," or ")"

The precedence is that of Python, except that &, | and ~ are the same as `and`, `or` and `not`.
"""

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from typing import TypeVar

from derive.errors import BadName, BadText
from derive.geometry import parameter
from derive.writing.tokens import END, NAME, NUMBER, Token, tokens
from derive.writing.vocabulary import (
    KEYWORDS,
    LOGICAL,
    MANY,
    OF_PROFILES,
    OF_THE_FILE,
    PI,
    TRUE,
    Words,
    refusal,
)

Result = TypeVar("Result")

_DIGITS = 40
_POWER_OF_TEN = 100


@dataclass(frozen=True)
class Node:
    """A part of a formula; a message points to its `column`."""

    column: int


@dataclass(frozen=True)
class Number(Node):
    """An exact number."""

    value: Fraction


@dataclass(frozen=True)
class Name(Node):
    """x or a parameter."""

    name: str


@dataclass(frozen=True)
class Constant(Node):
    """pi or True."""

    name: str


@dataclass(frozen=True)
class Negative(Node):
    """-operand."""

    operand: Node


@dataclass(frozen=True)
class Negation(Node):
    """not operand."""

    operand: Node


@dataclass(frozen=True)
class Power(Node):
    """base**exponent."""

    base: Node
    exponent: Node


@dataclass(frozen=True)
class Chain(Node):
    """Operands, with operators of the same precedence between them, from left to right."""

    operands: tuple[Node, ...]
    operators: tuple[Token, ...]


@dataclass(frozen=True)
class Sum(Chain):
    """a + b - c."""


@dataclass(frozen=True)
class Product(Chain):
    """a * b / c."""


@dataclass(frozen=True)
class Comparison(Chain):
    """a < b <= c."""


@dataclass(frozen=True)
class Conjunction(Chain):
    """a and b and c."""


@dataclass(frozen=True)
class Disjunction(Chain):
    """a or b or c."""


@dataclass(frozen=True)
class Call(Node):
    """function(arguments)."""

    function: str
    arguments: tuple[Node, ...]


@dataclass(frozen=True)
class Pair(Node):
    """(value, condition) in a Piecewise."""

    value: Node
    condition: Node


def parse(text: str, words: Words = OF_PROFILES) -> Node:
    """The tree of `text`, which may contain the names that `words` allows.

    Raises BadText for the first token that does not follow the grammar.
    """
    return _Parser(text, words).whole()


class _Parser:
    """A recursive-descent parser with one token of lookahead."""

    def __init__(self, text: str, words: Words) -> None:
        self.text, self.words = text, words
        self._tokens = tokens(text)
        self.here = next(self._tokens)
        self._depth = 0

    def whole(self) -> Node:
        if self.here.kind == END:
            raise self._refusal("the text is empty", "write a formula, such as x**2/(2*R)")
        node = self._or()
        if self.here.kind != END:
            raise self._left_over()
        return node

    def _or(self) -> Node:
        return self._chain(Disjunction, self._and, "or", "|")

    def _and(self) -> Node:
        return self._chain(Conjunction, self._not, "and", "&")

    def _not(self) -> Node:
        column, odd = self._prefixes("not", "~")
        operand = self._comparison()
        return Negation(column, operand) if odd else operand

    def _comparison(self) -> Node:
        return self._chain(Comparison, self._sum, "<", "<=", ">", ">=")

    def _sum(self) -> Node:
        return self._chain(Sum, self._product, "+", "-")

    def _product(self) -> Node:
        return self._chain(Product, self._unary, "*", "/")

    def _chain(self, kind: type[Chain], part: Callable[[], Node], *operators: str) -> Node:
        operands, between = [part()], []
        while self.here.among(*operators):
            between.append(self._take())
            operands.append(part())
        if not between:
            return operands[0]
        return kind(between[0].column, tuple(operands), tuple(between))

    def _unary(self) -> Node:
        column, odd = self._prefixes("-", "+")
        operand = self._power()
        return Negative(column, operand) if odd else operand

    def _prefixes(self, inverting: str, other: str) -> tuple[int, bool]:
        """The column of the first prefix, and whether the prefixes invert: `- -x` is x."""
        column, odd = self.here.column, False
        while self.here.among(inverting, other):
            odd ^= self._take().text in (inverting, LOGICAL.get(inverting))
        return column, odd

    def _power(self) -> Node:
        base = self._primary()
        if not self.here.among("**"):
            return base
        operator = self._take()
        return Power(operator.column, base, self._deeper(operator, self._unary))

    def _primary(self) -> Node:
        node = self._operand()
        self._demand_operator()
        return node

    def _operand(self) -> Node:
        token = self.here
        if token.kind == NUMBER:
            return Number(token.column, self._number())
        if token.kind == NAME:
            return self._named()
        if token.among("("):
            return self._deeper(token, self._parenthesised)
        raise self._missing()

    def _number(self) -> Fraction:
        """The exact value of the current token; a long number is refused before it is computed."""
        mantissa, _, power = self.here.text.lower().partition("e")
        if len(mantissa) > _DIGITS or len(power) > 4 or abs(int(power or 0)) > _POWER_OF_TEN:
            raise self._refusal(
                "the number is too long",
                f"write at most {_DIGITS} digits and powers of ten up to {_POWER_OF_TEN}",
            )
        return Fraction(self._take().text)

    def _named(self) -> Node:
        name, column = self.here.text, self.here.column
        if name in self.words.functions:
            self._take()
            return self._call(name, column)
        if name not in (PI, TRUE, "x"):
            self._demand_parameter(name)
        self._take()
        if self.here.among("("):
            raise self._refusal(
                f"{name} is not a function that may be used here",
                f"write {name}*(...) for a product, or use a function of the list below",
                column,
            )
        return Constant(column, name) if name in (PI, TRUE) else Name(column, name)

    def _demand_parameter(self, name: str) -> None:
        """Refuse a name that a parameter cannot have."""
        if name in KEYWORDS or name in LOGICAL:
            raise self._keyword(name)
        if not self.words.of_parameters:
            return
        try:
            if name in OF_THE_FILE:
                raise BadName("parameter", name, "is used by the geometry file itself")
            parameter(name, "")
        except BadName as error:
            raise self._refusal(f"parameter {name!r} {error.why}", _other(name)) from None

    def _call(self, name: str, column: int) -> Node:
        opening = self.here
        if not opening.among("("):
            raise self._refusal(f"{name} is a function", f"write {name}(...)", column)
        self._take()
        arguments = self._deeper(opening, self._arguments)
        known = self.words.functions[name]
        if not known.least <= len(arguments) <= known.most:
            number = "one argument" if known.most == 1 else f"{known.least} to {known.most}"
            if known.least == known.most > 1 or known.most == MANY:
                number = f"{'at most ' * (known.most == MANY)}{known.most} arguments"
            many = len(arguments) > known.most
            remedy = "leave out the others" if many else "add the missing ones"
            why = f"{name} takes {number}, but {len(arguments)} are given"
            raise self._refusal(why, remedy, column)
        return Call(column, name, arguments)

    def _arguments(self) -> tuple[Node, ...]:
        arguments = [self._or()]
        while self.here.among(","):
            self._take()
            arguments.append(self._or())
        self._close()
        return tuple(arguments)

    def _parenthesised(self) -> Node:
        opening = self._take()
        inside = self._or()
        if self.here.among(","):
            self._take()
            inside = Pair(opening.column, inside, self._or())
        self._close()
        return inside

    def _close(self) -> None:
        if self.here.kind == END:
            raise self._refusal("a parenthesis is not closed", "add )")
        if not self.here.among(")"):
            raise self._left_over()
        self._take()

    def _deeper(self, token: Token, part: Callable[[], Result]) -> Result:
        if self._depth == self.words.deepest:
            raise self._refusal(
                f"the formula is nested deeper than {self.words.deepest} levels here",
                "write it with fewer parentheses",
                token.column,
            )
        self._depth += 1
        result = part()
        self._depth -= 1
        return result

    def _take(self) -> Token:
        token, self.here = self.here, next(self._tokens)
        return token

    def _demand_operator(self) -> None:
        """Refuse two operands side by side."""
        if self.here.among("and", "or"):
            return
        if self.here.kind == NAME and self.here.text in KEYWORDS | {"not"}:
            raise self._keyword(self.here.text)
        if self.here.kind in (NUMBER, NAME) or self.here.among("("):
            raise self._refusal("an operator is missing here", "write * for a product, such as 2*x")

    def _missing(self) -> BadText:
        if self.here.kind == END:
            return self._refusal("the text ends too early", "add a number, a name or (")
        if self.here.among("|"):
            return self._refusal("|x| cannot be used for an absolute value", "write Abs(x)")
        return self._refusal(
            f"a number or a name is missing before {self.here.text}",
            f"add it, or leave out {self.here.text}",
        )

    def _left_over(self) -> BadText:
        if self.here.among(")"):
            return self._refusal("this ) has no matching (", "leave it out, or add (")
        if self.here.among(","):
            return self._refusal(
                "a comma is only allowed between the arguments of a function",
                "use a point in decimal numbers, such as 2.5",
            )
        return self._refusal(f"{self.here.text} is not allowed here", "leave it out")

    def _keyword(self, name: str) -> BadText:
        remedy = "leave it out"
        if name in ("if", "else"):
            remedy = "write Piecewise((value, condition), (value, True))"
        return self._refusal(f"{name} is not allowed here", remedy)

    def _refusal(self, why: str, remedy: str, column: int | None = None) -> BadText:
        return refusal(self.text, self.here.column if column is None else column, why, remedy)


def _other(name: str) -> str:
    """The advice to choose another name for a parameter, with an example if there is one."""
    other = f"{name.strip('_')}0"
    try:
        parameter(other, "")
    except BadName:
        return "choose another name of letters and digits"
    return f"choose another name, such as {other}"
