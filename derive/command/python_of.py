"""Write the tree of g(x) as exact Python code for SymPy, with its terms in the same order."""

import ast
from collections.abc import Sequence
from functools import reduce
from itertools import pairwise

from derive.reading.tree import Tree
from derive.reading.value import MIRRORED
from derive.reading.words import FUNCTIONS, PI


def code_of(tree: Tree) -> tuple[str, set[str]]:
    """The Python code of g(x), and the names that it imports from SymPy.

    Raises RecursionError if the formula has too many terms.
    """
    exact = _Exact(tree)
    return ast.unparse(exact.visit(tree.root)), exact.imports


class _Exact(ast.NodeTransformer):
    """Replace quotients of integers and decimal numbers by exact ones, and `and` by &.

    integers: the nodes whose value is a Python int, whose quotients would be inexact
    """

    def __init__(self, tree: Tree) -> None:
        self.tree = tree
        self.imports = set[str]()
        self.integers = set[ast.expr]()

    def visit_Constant(self, node: ast.Constant) -> ast.expr:
        """A number as an int or a Rational."""
        if node.value is True:
            return node
        value = self.tree.number(node)
        if value.denominator == 1:
            return self._integer(ast.Constant(value.numerator))
        return self._rational(ast.Constant(value.numerator), ast.Constant(value.denominator))

    def visit_Name(self, node: ast.Name) -> ast.Name:
        """A name; pi is imported."""
        return self._imported(PI) if node.id == PI else node

    def visit_Call(self, node: ast.Call) -> ast.Call:
        """A function of SymPy."""
        name = FUNCTIONS[ast.unparse(node.func)].of_sympy.__name__
        return ast.Call(self._imported(name), [self.visit(each) for each in node.args], [])

    def visit_UnaryOp(self, node: ast.UnaryOp) -> ast.expr:
        """A sign, or ~ for `not`."""
        operand = self.visit(node.operand)
        if isinstance(node.op, ast.Not):
            return ast.UnaryOp(ast.Invert(), operand)
        negative = ast.UnaryOp(node.op, operand)
        return self._integer(negative) if operand in self.integers else negative

    def visit_BinOp(self, node: ast.BinOp) -> ast.expr:
        """An operation; a quotient or power of integers is a Rational."""
        left, right = self.visit(node.left), self.visit(node.right)
        integer = {left, right} <= self.integers
        if integer and isinstance(node.op, ast.Div):
            return self._rational(left, right)
        if integer and isinstance(node.op, ast.Pow) and not isinstance(right, ast.Constant):
            left, integer = self._rational(left), False
        done = ast.BinOp(left, node.op, right)
        return self._integer(done) if integer else done

    def visit_Compare(self, node: ast.Compare) -> ast.expr:
        """Comparisons joined by &, with x or a parameter on the left."""
        parts = []
        sides = pairwise((node.left, *node.comparators))
        for order, (left, right) in zip(node.ops, sides, strict=True):
            if not self.tree.names(left):
                order, left, right = MIRRORED[type(order)](), right, left
            parts.append(ast.Compare(self.visit(left), [order], [self.visit(right)]))
        return _joined(ast.BitAnd(), parts)

    def visit_BoolOp(self, node: ast.BoolOp) -> ast.expr:
        """Conditions joined by & or |."""
        sign = ast.BitAnd() if isinstance(node.op, ast.And) else ast.BitOr()
        return _joined(sign, [self.visit(part) for part in node.values])

    def _integer(self, node: ast.expr) -> ast.expr:
        self.integers.add(node)
        return node

    def _rational(self, *parts: ast.expr) -> ast.Call:
        return ast.Call(self._imported("Rational"), [*parts], [])

    def _imported(self, name: str) -> ast.Name:
        self.imports.add(name)
        return ast.Name(name)


def _joined(sign: ast.operator, parts: Sequence[ast.expr]) -> ast.expr:
    return reduce(lambda left, right: ast.BinOp(left, sign, right), parts)
