"""Convert the tree of a text to SymPy, in the order in which Python would evaluate it."""

import operator
from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from functools import reduce
from typing import Any

from lark import Token
from lark import Tree as Branch
from sympy import Expr, Piecewise, Rational, pi, true
from sympy.logic.boolalg import Boolean

from derive.command.errors import BadText
from derive.reading.limits import STEEPEST, fault
from derive.reading.relation import Relation
from derive.reading.text import Call, Node, Tree, column
from derive.reading.words import refusal

_OPERATORS: dict[str, Callable[[Any, Any], Any]] = {
    **{"+": operator.add, "-": operator.sub, "*": operator.mul, "/": operator.truediv},
    **{"**": operator.pow, "both": operator.and_, "either": operator.or_},
    **{"<": operator.lt, "<=": operator.le, ">": operator.gt, ">=": operator.ge},
}


def _is_steep(exponent: Expr) -> bool:
    """Whether an exponent holds a number that is too large."""
    return any(abs(number) > STEEPEST for number in exponent.atoms(Rational))


class Meaning:
    """The values and conditions of the nodes of one tree.

    symbols: the symbol or expression of each name
    """

    def __init__(self, tree: Tree, symbols: Mapping[str, Expr]) -> None:
        self.tree = tree
        self.symbols = dict(symbols)

    def value(self, node: Node) -> Expr:
        """The value of a node; raises BadText if the node is a condition."""
        match node:
            case Token(type="NUMBER"):
                return Rational(Fraction(str(node)))
            case Token(type="PI"):
                return pi
            case Token(type="NAME"):
                return self.named(node)
            case Branch("prefixed", ["-", inner]):
                return self.step(node, operator.neg, self.value(inner))
            case Branch("prefixed", ["+", inner]):
                return self.value(inner)
            case Branch("operation", [first, *others]):
                return self._operations(first, others)
            case Branch("call", ["Piecewise", *_]):
                return self._piecewise(node)
            case Branch("call", [name, *_]):
                return self.call(node, str(name))
        is_pair = isinstance(node, Branch) and node.data == "pair"
        why = f"{'a pair' if is_pair else 'a condition'} cannot be used as a value"
        raise self.refusal(node, why, "write Piecewise((value, condition), ...), or use a point")

    def named(self, node: Token) -> Expr:
        """The symbol of a name."""
        return self.symbols[node]

    def call(self, node: Call, name: str) -> Expr:
        """The value of a function call."""
        function = self.tree.words.functions[name].of_sympy
        return self.step(node, function, *map(self.value, node.children[1:]))

    def _operations(self, first: Node, others: Sequence[Node]) -> Expr:
        """The value of a chain of operations, from left to right."""
        result = self.value(first)
        for sign, operand in zip(others[::2], map(self.value, others[1::2]), strict=True):
            if sign == "**" and _is_steep(operand):
                why = "the exponent is too large"
                raise self.refusal(sign, why, f"use exponents up to {STEEPEST}")
            result = self.step(sign, _OPERATORS[str(sign)], result, operand)
        return result

    def _piecewise(self, node: Call) -> Expr:
        pairs = []
        for pair in node.children[1:]:
            match pair:
                case Branch("pair", [value, condition]):
                    pairs.append((self.value(value), self.condition(condition)))
                case _:
                    why = "the arguments of Piecewise must be pairs"
                    raise self.refusal(pair, why, "write (value, condition), ...")
        return self.step(node, Piecewise, *pairs)

    def condition(self, node: Node) -> Boolean:
        """The condition of a node; raises BadText if the node is a value."""
        match node:
            case Token(type="TRUE"):
                return true
            case Branch("negated", [_, inner]):
                return self.step(node, operator.invert, self.condition(inner))
            case Branch("both" | "either", parts):
                conditions = [self.condition(part) for part in parts[::2]]
                return self.step(node, reduce, _OPERATORS[node.data], conditions)
            case Branch("comparison", [first, *others]):
                return self._comparison(first, others)
        why = "a value cannot be used as a condition"
        raise self.refusal(node, why, "write a condition such as x < b, or True")

    def _comparison(self, first: Node, others: Sequence[Node]) -> Boolean:
        found = []
        for left, at, right in zip((first, *others[1::2]), others[::2], others[1::2], strict=False):
            order = str(at)
            if not self.tree.names(left):
                if not self.tree.names(right):
                    why = "this compares two constants"
                    raise self.refusal(at, why, "compare x with a position")
                order, left, right = Relation(order).turned, right, left
            found.append(self.step(at, _OPERATORS[order], self.value(left), self.value(right)))
        return reduce(operator.and_, found)

    def step(self, at: Node, compute: Callable[..., Any], *operands: Any) -> Any:
        """The result of the operation at a node.

        It is refused if it is not a finite formula of real numbers.
        """
        try:
            result = compute(*operands)
            why = fault(result) if isinstance(result, Expr) else ""
        except Exception as error:
            why = f"SymPy cannot evaluate this ({error})"
            raise self.refusal(at, why, "write it in another form") from error
        if why:
            raise self.refusal(at, f"the result {why}", "write another formula")
        return result

    def refusal(self, at: Node, why: str, remedy: str) -> BadText:
        """The error for the mistake at a node."""
        return refusal(self.tree.text, column(at), why, remedy)
