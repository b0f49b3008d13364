"""Read a text, g(x) or a formula of a claims file, as a tree of Python without computing anything.

A formula is made of operands with an operator between each two, and its parentheses match:

    operand   prefixes, then a number, a name, pi, True, a formula in parentheses,
              (value, condition), or function(formula, ...)
    prefixes  - and +; where a condition may begin, not or ~ before them
    operator  + - * / **, < <= > >=, and & or |

The first token that does not fit is refused at its column.  What is left, Python's own parser reads
without a mistake: the precedence is that of Python, except that &, | and ~ are the same as `and`,
`or` and `not`.  The parser never sees any other text, and nothing is executed.
"""

import ast
import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from fractions import Fraction

from derive.command.errors import BadText
from derive.reading.tokens import END, NAME, NUMBER, OPERATOR, Token, tokens
from derive.reading.words import KEYWORDS, LOGICAL, PI, TRUE, Words, refusal

_DIGITS = 40
_POWER_OF_TEN = 100
_LEADING_ZEROS = re.compile(r"^0+(?=\d)")
_BINARY = ("+", "-", "*", "/", "**", "<", "<=", ">", ">=", "and", "&", "or", "|")
_FUNCTION, _CONSTANT = "function", "constant"
"""Kinds of names; x, parameters and symbols are of the kind NAME."""


@dataclass(frozen=True)
class Tree:
    """A text and its tree.

    words   the names that the text may contain
    tokens  those that Python has read; token number n is on its line n + 1
    """

    text: str
    words: Words
    tokens: tuple[Token, ...]
    root: ast.expr

    def names(self, node: ast.expr | None = None) -> dict[str, int]:
        """Every name that is not a function or constant, with the column where it first occurs."""
        columns: dict[str, int] = {}
        for token in self._tokens_of(node or self.root):
            if token.kind == NAME:
                columns.setdefault(token.text, token.column)
        return columns

    def number(self, node: ast.Constant) -> Fraction:
        """The exact value of a number."""
        return Fraction(self._tokens_of(node)[0].text)

    def column(self, node: ast.expr) -> int:
        """The column of the operator of an operation, or of the first token of another node."""
        match node:
            case ast.BinOp(left=left) | ast.Compare(left=left) | ast.BoolOp(values=[left, *_]):
                return self.after(left)
        return self._tokens_of(node)[0].column

    def after(self, node: ast.expr) -> int:
        """The column of the operator after a node."""
        following = self.tokens[node.end_lineno :]
        return next(token.column for token in following if token.text != ")")

    def _tokens_of(self, node: ast.expr) -> tuple[Token, ...]:
        return self.tokens[node.lineno - 1 : node.end_lineno]


def parse(text: str, words: Words) -> Tree:
    """The tree of `text`, which may contain the names that `words` allows.

    Raises BadText for the first token that does not fit.
    """
    kept = _Scan(text, words).whole()
    lines = "\n".join(_LEADING_ZEROS.sub("", token.text) for token in kept)
    root = ast.parse(f"({lines}\n)", mode="eval").body
    return Tree(text, words, tuple(kept), root)


@dataclass
class _Open:
    """An open parenthesis with the function before it, or a power whose exponent is being read."""

    function: Token | None = None
    commas: int = 0
    is_power: bool = False


class _Scan:
    """Check the tokens of a text with one token of lookahead."""

    def __init__(self, text: str, words: Words) -> None:
        self.text, self.words = text, words
        self._tokens: Iterator[Token] = tokens(text)
        self.here = next(self._tokens)
        self.kept: list[Token] = []
        self._open: list[_Open] = []

    def whole(self) -> list[Token]:
        """Return the tokens for Python; raises BadText."""
        if self.here.kind == END:
            raise self._refusal("the text is empty", "write a formula, such as x**2/(2*R)")
        while not self._operand() or self._operator():
            pass
        return self.kept

    def _operand(self) -> bool:
        """Read the prefixes and the next token of an operand; return whether it is complete."""
        if not self.kept or self.kept[-1].among("(", ",", "and", "or"):
            self._prefixes("not", "~")
        self._prefixes("-", "+")
        if self.here.among("("):
            self._nest(_Open())
            return False
        if self.here.kind == NUMBER:
            self._demand_short()
            self._keep(NUMBER)
            return True
        if self.here.kind != NAME:
            raise self._missing()
        if self.here.text in self.words.functions:
            name = self._keep(_FUNCTION)
            if not self.here.among("("):
                why, remedy = f"{name.text} is a function", f"write {name.text}(...)"
                raise self._refusal(why, remedy, name.column)
            self._nest(_Open(name))
            return False
        self._name()
        return True

    def _operator(self) -> bool:
        """Read what follows an operand; return whether another operand must follow."""
        while self.here.among(")", ",", *_BINARY):
            if self.here.among("**"):
                self._nest(_Open(is_power=True))
                return True
            while self._open and self._open[-1].is_power:
                self._open.pop()
            if self.here.among(*_BINARY):
                self._keep(OPERATOR, LOGICAL.get(self.here.text))
                return True
            if not self._open:
                raise self._left_over()
            if self.here.among(","):
                self._comma(self._open[-1])
                return True
            self._close(self._open.pop())
        if self.here.kind == END and all(each.is_power for each in self._open):
            return False
        raise self._left_over()

    def _prefixes(self, inverting: str, other: str) -> None:
        """Read prefixes, and keep one if their number inverts: `- -x` is x, `not ~x` is x."""
        first, inverts = self.here, False
        while self.here.among(inverting, other):
            inverts ^= self.here.text != "+"
            self._next()
        if inverts:
            self.kept.append(replace(first, kind=OPERATOR, text=inverting))

    def _name(self) -> None:
        """Read a name that is not followed by an argument."""
        name = self.here.text
        if name in KEYWORDS or name in LOGICAL.values():
            raise self._keyword()
        if name not in (PI, TRUE) and (mistake := self.words.mistake(name)):
            raise self._refusal(*mistake)
        token = self._keep(_CONSTANT if name in (PI, TRUE) else NAME)
        if self.here.among("("):
            raise self._refusal(
                f"{name} is not a function that may be used here",
                f"write {name}*(...) for a product, or use a function of the list below",
                token.column,
            )

    def _nest(self, inner: _Open) -> None:
        if len(self._open) == self.words.deepest:
            raise self._refusal(
                f"the formula is nested deeper than {self.words.deepest} levels here",
                "write it with fewer parentheses",
            )
        self._open.append(inner)
        self._keep(OPERATOR)

    def _comma(self, inside: _Open) -> None:
        """Read a comma: between arguments, or between the value and the condition of a pair."""
        if inside.function is None and inside.commas:
            raise self._left_over()
        inside.commas += 1
        self._keep(OPERATOR)

    def _close(self, inside: _Open) -> None:
        """Read a closing parenthesis; a function must have all its arguments."""
        self._keep(OPERATOR)
        if inside.function is None:
            return
        known, count = self.words.functions[inside.function.text], inside.commas + 1
        if not known.least <= count <= known.most:
            remedy = "leave out the others" if count > known.most else "add the missing ones"
            why = f"{inside.function.text} takes {known.number}, but {count} are given"
            raise self._refusal(why, remedy, inside.function.column)

    def _demand_short(self) -> None:
        """Refuse a long number before it is computed."""
        mantissa, _, power = self.here.text.lower().partition("e")
        if len(mantissa) > _DIGITS or len(power) > 4 or abs(int(power or 0)) > _POWER_OF_TEN:
            raise self._refusal(
                "the number is too long",
                f"write at most {_DIGITS} digits and powers of ten up to {_POWER_OF_TEN}",
            )

    def _keep(self, kind: str, text: str | None = None) -> Token:
        self.kept.append(replace(self.here, kind=kind, text=text or self.here.text))
        self._next()
        return self.kept[-1]

    def _next(self) -> None:
        self.here = next(self._tokens)

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
        """The error for a token that cannot follow an operand."""
        here = self.here
        if here.kind == END:
            return self._refusal("a parenthesis is not closed", "add )")
        if here.kind == NAME and here.text in KEYWORDS | {"not"}:
            return self._keyword()
        if here.kind in (NUMBER, NAME) or here.among("("):
            remedy = "write * for a product, such as 2*x"
            return self._refusal("an operator is missing here", remedy)
        if here.among(")"):
            return self._refusal("this ) has no matching (", "leave it out, or add (")
        if here.among(","):
            return self._refusal(
                "a comma is only allowed between the arguments of a function",
                "use a point in decimal numbers, such as 2.5",
            )
        return self._refusal(f"{here.text} is not allowed here", "leave it out")

    def _keyword(self) -> BadText:
        remedy = "leave it out"
        if self.here.text in ("if", "else"):
            remedy = "write Piecewise((value, condition), (value, True))"
        return self._refusal(f"{self.here.text} is not allowed here", remedy)

    def _refusal(self, why: str, remedy: str, column: int | None = None) -> BadText:
        return refusal(self.text, self.here.column if column is None else column, why, remedy)
