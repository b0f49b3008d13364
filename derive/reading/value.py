"""Convert the tree of a text to SymPy, in the order in which Python would evaluate it."""

import ast
import operator
from collections.abc import Callable, Mapping
from functools import reduce
from itertools import pairwise
from typing import Any

from sympy import Expr, Piecewise, Rational, pi, true
from sympy.logic.boolalg import Boolean

from derive.command.errors import BadText
from derive.reading.limits import STEEPEST, fault
from derive.reading.tree import Tree
from derive.reading.words import PI, refusal

_OPERATORS: dict[type[ast.operator | ast.cmpop | ast.boolop], Callable[[Any, Any], Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: operator.pow,
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
    ast.And: operator.and_,
    ast.Or: operator.or_,
}

MIRRORED: dict[type[ast.cmpop], type[ast.cmpop]] = {
    **{ast.Lt: ast.Gt, ast.LtE: ast.GtE},
    **{ast.Gt: ast.Lt, ast.GtE: ast.LtE},
}
"""The same comparisons with their sides exchanged."""


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

    def value(self, node: ast.expr) -> Expr:
        """The value of a node; raises BadText if the node is a condition."""
        match node:
            case ast.Constant() if node.value is not True:
                return Rational(self.tree.number(node))
            case ast.Name(id=name):
                return pi if name == PI else self.named(node)
            case ast.UnaryOp(op=ast.USub()):
                return self.step(node, operator.neg, self.value(node.operand))
            case ast.BinOp():
                return self._operations(node)
            case ast.Call(func=ast.Name(id="Piecewise")):
                return self._piecewise(node)
            case ast.Call(func=ast.Name(id=name)):
                return self.call(node, name)
        what = "a pair" if isinstance(node, ast.Tuple) else "a condition"
        why = f"{what} cannot be used as a value"
        raise self.refusal(node, why, "write Piecewise((value, condition), ...), or use a point")

    def named(self, node: ast.Name) -> Expr:
        """The symbol of a name."""
        return self.symbols[node.id]

    def call(self, node: ast.Call, name: str) -> Expr:
        """The value of a function call."""
        function = self.tree.words.functions[name].of_sympy
        return self.step(node, function, *map(self.value, node.args))

    def _operations(self, node: ast.expr) -> Expr:
        """The value of a chain of operations, from left to right."""
        chain = list[ast.BinOp]()
        while isinstance(node, ast.BinOp):
            chain.append(node)
            node = node.left
        result = self.value(node)
        for each in reversed(chain):
            operand, column = self.value(each.right), self.tree.after(each.left)
            if isinstance(each.op, ast.Pow) and _is_steep(operand):
                why = "the exponent is too large"
                raise self.refusal(column, why, f"use exponents up to {STEEPEST}")
            result = self.step(column, _OPERATORS[type(each.op)], result, operand)
        return result

    def _piecewise(self, node: ast.Call) -> Expr:
        pairs = []
        for pair in node.args:
            if not isinstance(pair, ast.Tuple) or len(pair.elts) != 2:
                why = "the arguments of Piecewise must be pairs"
                raise self.refusal(pair, why, "write (value, condition), ...")
            pairs.append((self.value(pair.elts[0]), self.condition(pair.elts[1])))
        return self.step(node, Piecewise, *pairs)

    def condition(self, node: ast.expr) -> Boolean:
        """The condition of a node; raises BadText if the node is a value."""
        match node:
            case ast.Constant(value=True):
                return true
            case ast.UnaryOp(op=ast.Not()):
                return self.step(node, operator.invert, self.condition(node.operand))
            case ast.BoolOp(op=joint, values=parts):
                conditions = [self.condition(part) for part in parts]
                return self.step(node, reduce, _OPERATORS[type(joint)], conditions)
            case ast.Compare():
                return self._comparison(node)
        why = "a value cannot be used as a condition"
        raise self.refusal(node, why, "write a condition such as x < b, or True")

    def _comparison(self, node: ast.Compare) -> Boolean:
        found = []
        sides = pairwise((node.left, *node.comparators))
        for order, (left, right) in zip(map(type, node.ops), sides, strict=True):
            column = self.tree.after(left)
            if not self.tree.names(left):
                if not self.tree.names(right):
                    why = "this compares two constants"
                    raise self.refusal(column, why, "compare x with a position")
                order, left, right = MIRRORED[order], right, left
            found.append(self.step(column, _OPERATORS[order], self.value(left), self.value(right)))
        return reduce(operator.and_, found)

    def step(self, at: ast.expr | int, compute: Callable[..., Any], *operands: Any) -> Any:
        """The result of the operation at a node or a column.

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

    def refusal(self, at: ast.expr | int, why: str, remedy: str) -> BadText:
        """The error for the mistake at a node or a column."""
        column = at if isinstance(at, int) else self.tree.column(at)
        return refusal(self.tree.text, column, why, remedy)
