"""Writes the tree of a formula as exact Python code for SymPy, with its terms in the same order."""

from dataclasses import dataclass, field

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
)
from derive.writing.meaning import MIRRORED, is_constant
from derive.writing.vocabulary import FUNCTIONS, TRUE

_COMPARISON, _OR, _AND, _SUM, _PRODUCT, _SIGN, _POWER, _ATOM = range(8)
"""The precedence levels of Python, in which & and | bind more tightly than a comparison."""


@dataclass(frozen=True)
class Code:
    """A piece of Python code.

    level: the precedence level of its outermost operator
    integer: whether its value is a Python int, whose quotients would be inexact
    """

    text: str
    level: int
    integer: bool = False

    def at(self, level: int) -> str:
        """The text, in parentheses unless it binds at least as tightly as `level`."""
        return self.text if self.level >= level else f"({self.text})"


@dataclass
class Python:
    """Writes formulas, and collects the names that they import from SymPy."""

    imports: set[str] = field(default_factory=set)

    def write(self, node: Node) -> Code:
        """The Python code of a node."""
        match node:
            case Number():
                return self._number(node)
            case Name():
                return Code(node.name, _ATOM)
            case Constant():
                return Code(node.name if node.name == TRUE else self._imported(node.name), _ATOM)
            case Negative():
                operand = self.write(node.operand)
                return Code(f"-{operand.at(_SIGN)}", _SIGN, operand.integer)
            case Negation():
                return Code(f"~{self.write(node.operand).at(_SIGN)}", _SIGN)
            case Sum():
                return self._left_to_right(node, _SUM)
            case Product():
                return self._left_to_right(node, _PRODUCT)
            case Power():
                return self._power(node)
            case Comparison():
                return self._comparison(node)
            case Conjunction():
                return self._joined(node, " & ", _AND)
            case Disjunction():
                return self._joined(node, " | ", _OR)
            case Pair():
                return Code(f"({self._list(node.value, node.condition)})", _ATOM)
            case Call():
                function = self._imported(FUNCTIONS[node.function].name)
                return Code(f"{function}({self._list(*node.arguments)})", _ATOM)
        raise AssertionError(f"no Python code is known for {type(node).__name__}")

    def _number(self, node: Number) -> Code:
        if node.value.denominator == 1:
            return Code(str(node.value), _ATOM, integer=True)
        return self._rational(str(node.value.numerator), str(node.value.denominator))

    def _rational(self, *parts: str) -> Code:
        return Code(f"{self._imported('Rational')}({', '.join(parts)})", _ATOM)

    def _imported(self, name: str) -> str:
        self.imports.add(name)
        return name

    def _list(self, *nodes: Node) -> str:
        return ", ".join(self.write(node).text for node in nodes)

    def _left_to_right(self, node: Chain, level: int) -> Code:
        done = self.write(node.operands[0])
        for sign, operand in zip(node.operators, node.operands[1:], strict=True):
            following = self.write(operand)
            integer = done.integer and following.integer
            if integer and sign.text == "/":
                done = self._rational(done.text, following.text)
            else:
                text = f"{done.at(level)} {sign.text} {following.at(level + 1)}"
                done = Code(text, level, integer)
        return done

    def _power(self, node: Power) -> Code:
        base, exponent = self.write(node.base), self.write(node.exponent)
        integer = base.integer and exponent.integer
        if integer and not isinstance(node.exponent, Number):
            base, integer = self._rational(base.text), False
        return Code(f"{base.at(_ATOM)}**{exponent.at(_SIGN)}", _POWER, integer)

    def _comparison(self, node: Comparison) -> Code:
        parts = []
        for sign, left, right in zip(
            node.operators, node.operands[:-1], node.operands[1:], strict=True
        ):
            order, sides = sign.text, (left, right)
            if is_constant(left):
                order, sides = MIRRORED[order], (right, left)
            first, second = (self.write(side).at(_SUM) for side in sides)
            parts.append(Code(f"{first} {order} {second}", _COMPARISON))
        return self._all(parts, " & ", _AND)

    def _joined(self, node: Chain, sign: str, level: int) -> Code:
        return self._all([self.write(part) for part in node.operands], sign, level)

    def _all(self, parts: list[Code], sign: str, level: int) -> Code:
        if len(parts) == 1:
            return parts[0]
        return Code(sign.join(part.at(level + 1) for part in parts), level)
