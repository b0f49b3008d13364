"""Convert the syntax tree of a formula to SymPy, in the order in which Python would evaluate it."""

import operator
from collections.abc import Callable, Mapping
from functools import reduce
from itertools import pairwise
from typing import Any

from sympy import Expr, Rational, Symbol, pi, true
from sympy.logic.boolalg import Boolean

from derive.errors import BadText
from derive.symbols import x
from derive.writing.grammar import (
    Call,
    Chain,
    Comparison,
    Conjunction,
    Constant,
    Disjunction,
    Name,
    Negation,
    Negative,
    Node,
    Number,
    Pair,
    Power,
    Product,
    Sum,
    parse,
)
from derive.writing.limits import STEEPEST, fault, reach
from derive.writing.vocabulary import FUNCTIONS, TRUE, refusal

_OPERATORS: dict[str, Callable[[Any, Any], Any]] = {
    "+": operator.add,
    "-": operator.sub,
    "*": operator.mul,
    "/": operator.truediv,
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
}

MIRRORED = {"<": ">", "<=": ">=", ">": "<", ">=": "<="}
"""The same comparisons with their sides exchanged."""


def read(text: str) -> Expr:
    """The SymPy expression of g(x) given as text, with a plain positive symbol for each parameter.

    Raises BadText.

    >>> read("abs(x)**1.5 / sqrt(R)")
    Abs(x)**(3/2)/sqrt(R)
    """
    tree = parse(text)
    return Meaning(text, {name: Symbol(name, positive=True) for name in names(tree)}).value(tree)


def names(tree: Node) -> dict[str, int]:
    """Every parameter of a formula, with the column of its first occurrence."""
    columns: dict[str, int] = {}
    for node in walk(tree):
        if isinstance(node, Name) and node.name != "x":
            columns.setdefault(node.name, node.column)
    return columns


def walk(tree: Node) -> "list[Node]":
    """Every node of a tree, in the order of the text."""
    nodes = [tree]
    for part in _parts(tree):
        nodes += walk(part)
    return nodes


def _parts(node: Node) -> tuple[Node, ...]:
    match node:
        case Negative() | Negation():
            return (node.operand,)
        case Power():
            return node.base, node.exponent
        case Chain():
            return node.operands
        case Call():
            return node.arguments
        case Pair():
            return node.value, node.condition
    return ()


def is_constant(tree: Node) -> bool:
    """Whether a formula contains neither x nor a parameter."""
    return not any(isinstance(node, Name) for node in walk(tree))


class Meaning:
    """The values and conditions of the nodes of one text.

    text: the text, for messages
    parameters: the symbol of each parameter, by name
    """

    def __init__(self, text: str, parameters: Mapping[str, Expr]) -> None:
        self.text = text
        self.symbols: dict[str, Expr] = {"x": x, **parameters}

    def value(self, node: Node) -> Expr:
        """The value of a node; raises BadText if the node is a condition."""
        match node:
            case Number():
                return Rational(node.value.numerator, node.value.denominator)
            case Name():
                return self.named(node)
            case Constant() if node.name != TRUE:
                return pi
            case Negative():
                return self.step(node.column, operator.neg, self.value(node.operand))
            case Sum() | Product():
                return self._chain(node)
            case Power():
                return self._power(node)
            case Call(function="Piecewise"):
                return self._piecewise(node)
            case Call():
                return self.call(node)
            case Pair():
                raise self._pair(node)
        raise self.refusal(
            node.column,
            "a condition cannot be used as a value",
            "write Piecewise((value, condition), ...) to choose a value by a condition",
        )

    def named(self, node: Name) -> Expr:
        """The symbol of a name."""
        return self.symbols[node.name]

    def call(self, node: Call) -> Expr:
        """The value of a function call."""
        function = FUNCTIONS[node.function].of_sympy
        return self.step(node.column, function, *map(self.value, node.arguments))

    def _chain(self, node: Chain) -> Expr:
        result = self.value(node.operands[0])
        for sign, operand in zip(node.operators, node.operands[1:], strict=True):
            compute = _OPERATORS[sign.text]
            result = self.step(sign.column, compute, result, self.value(operand))
        return result

    def _power(self, node: Power) -> Expr:
        base, exponent = self.value(node.base), self.value(node.exponent)
        if reach(exponent) > STEEPEST:
            raise self.refusal(
                node.column, "the exponent is too large", f"use exponents up to {STEEPEST}"
            )
        return self.step(node.column, operator.pow, base, exponent)

    def _piecewise(self, node: Call) -> Expr:
        pairs = []
        for pair in node.arguments:
            if not isinstance(pair, Pair):
                raise self.refusal(
                    pair.column,
                    "the arguments of Piecewise must be pairs",
                    "write (value, condition), ...",
                )
            pairs.append((self.value(pair.value), self.condition(pair.condition)))
        return self.step(node.column, FUNCTIONS["Piecewise"].of_sympy, *pairs)

    def condition(self, node: Node) -> Boolean:
        """The condition of a node; raises BadText if the node is a value."""
        match node:
            case Constant() if node.name == TRUE:
                return true
            case Negation():
                return self.step(node.column, operator.invert, self.condition(node.operand))
            case Conjunction():
                return self._joined(node, operator.and_)
            case Disjunction():
                return self._joined(node, operator.or_)
            case Comparison():
                return self._comparison(node)
            case Pair():
                raise self._pair(node)
        raise self.refusal(
            node.column,
            "a value cannot be used as a condition",
            "write a condition such as x < b, or True",
        )

    def _joined(self, node: Chain, join: Callable[[Any, Any], Any]) -> Boolean:
        parts = [self.condition(part) for part in node.operands]
        return self.step(node.column, lambda *all_: reduce(join, all_), *parts)

    def _comparison(self, node: Comparison) -> Boolean:
        comparisons = []
        for sign, (left, right) in zip(node.operators, pairwise(node.operands), strict=True):
            if is_constant(left) and is_constant(right):
                raise self.refusal(
                    sign.column, "this compares two constants", "compare x with a position"
                )
            compare, sides = _OPERATORS[sign.text], (left, right)
            if is_constant(left):
                compare, sides = _OPERATORS[MIRRORED[sign.text]], (right, left)
            comparisons.append(self.step(sign.column, compare, *map(self.value, sides)))
        return reduce(operator.and_, comparisons)

    def step(self, column: int, compute: Callable[..., Any], *operands: Any) -> Any:
        """The result of one operation; refused if it is not a finite formula of real numbers."""
        try:
            result = compute(*operands)
            why = fault(result) if isinstance(result, Expr) else ""
        except Exception as error:
            raise self.refusal(
                column, f"SymPy cannot evaluate this ({error})", "write it in another form"
            ) from error
        if why:
            raise self.refusal(column, f"the result {why}", "write another formula")
        return result

    def _pair(self, node: Pair) -> BadText:
        return self.refusal(
            node.column,
            "a pair is only allowed in a Piecewise",
            "write Piecewise((value, condition), ...), or use a point in decimal numbers",
        )

    def refusal(self, column: int, why: str, remedy: str) -> BadText:
        """The error for the mistake at a column."""
        return refusal(self.text, column, why, remedy)
