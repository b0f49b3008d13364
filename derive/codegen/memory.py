"""How many arrays a printed function holds at once, which tells how long arrays may be uncut.

Local variables are held until the function returns.  NumPy computes a sum, a difference, a product
or a quotient in the memory of an array that nothing else refers to.  Flags take an eighth of a
number and are not counted; nor are arguments, which the caller holds.
"""

import ast
from collections.abc import Iterable
from textwrap import dedent

LABORIOUS = 45
"""What solves or integrates is taken for so many,"""

PRESSURE_BY_PARTS, BY_PARTS = 40, 26
"""and so is what is added up part by part: cut and whole, it takes as long where so many leave the
heap.  At its peak it holds up to twice as many, where it is integrated three times.
"""

_HANDED_ON = ("only_where", "Contact", "Edges")
"""What returns the arrays that it is given."""


def arrays_held(code: Iterable[str], varying: Iterable[str]) -> int:
    """The most arrays that the lines of a function's body hold at once, its results included.

    varying: the arguments that are arrays.

    >>> arrays_held(["h = a + c", "return only_where(h > LEAST, np.sqrt(a * c))"], ["a", "c"])
    3
    """
    walk, kept, most = _Walk(set(varying)), 0, 0
    for line in ast.parse(dedent("\n".join(code))).body:
        match line:
            case ast.Assign(targets=[ast.Name(name)], value=value):
                walk.varying |= {name} if walk.varies(value) else set()
            case ast.Return(value=ast.expr() as value):
                pass
            case _:
                raise NotImplementedError(ast.unparse(line))
        during, new = walk.held(value)
        most, kept = max(most, kept + during), kept + new
    return most


class _Walk:
    """Through expressions, in the order in which Python evaluates them."""

    def __init__(self, varying: set[str]) -> None:
        self.varying = varying

    def varies(self, node: ast.expr) -> bool:
        """Whether it is an array, or a call that gives several."""
        names = (part.id for part in ast.walk(node) if isinstance(part, ast.Name))
        return any(name in self.varying for name in names)

    def held(self, node: ast.expr) -> tuple[int, int]:
        """New arrays that it holds at most while it is computed, and afterwards."""
        if not self.varies(node):
            return 0, 0
        match node:
            case ast.Name():
                return 0, 0
            case ast.Starred():
                return self.held(node.value)
            case ast.Compare():
                return self._in_turn([node.left, *node.comparators])[0], 0
            case ast.BinOp(op=ast.BitAnd() | ast.BitOr()):
                return self._in_turn([node.left, node.right])[0], 0
            case ast.UnaryOp():
                most, _ = self.held(node.operand)
                return max(most, 1), 1
            case ast.BinOp():
                return self._of_two(node)
            case ast.Call():
                return self._of_call(node)
        raise NotImplementedError(ast.unparse(node))

    def _in_turn(self, nodes: Iterable[ast.expr]) -> tuple[int, int]:
        """The same for several, of which all are held until the last is there."""
        most = kept = 0
        for node in nodes:
            during, new = self.held(node)
            most, kept = max(most, kept + during), kept + new
        return most, kept

    def _of_two(self, node: ast.BinOp) -> tuple[int, int]:
        """In the memory of one operand if it can be; of the second not beside a np.float64."""
        (most, first), (later, second) = self.held(node.left), self.held(node.right)
        beside = self.varies(node.left) or isinstance(node.left, ast.Constant)
        match node.op:
            case ast.Add() | ast.Mult():
                in_place = first or (second and beside)
            case ast.Sub() | ast.Div():
                in_place = first
            case _:
                in_place = 0
        return max(most, first + later, first + second + (not in_place)), 1

    def _of_call(self, node: ast.Call) -> tuple[int, int]:
        name, given = ast.unparse(node.func), node.args
        if name.endswith(".copy"):
            return 1, 1
        most, kept = self._in_turn(given)
        if name in ("maximum", "minimum", "fmax"):
            new = 1 + any(map(self._is_filled, given))
        elif name == "select":
            new = 2  # the mask, and where both differ
        elif name == "kink_logarithm":
            return max(most, kept + 2), kept  # it ends in the memory of its first argument
        elif name in ("scaled", "scaled_at_last"):
            new = int(self.varies(given[1]))
            return max(most, kept + new), new or kept
        elif name.startswith("np."):
            new = 1
        elif name in _HANDED_ON:
            return most, kept
        else:
            raise NotImplementedError(ast.unparse(node))
        return max(most, kept + new), 1

    def _is_filled(self, node: ast.expr) -> bool:
        """Whether an array is made of a number, which it is not of zero."""
        return not self.varies(node) and ast.unparse(node) != "0.0"
