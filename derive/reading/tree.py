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
from dataclasses import dataclass
from fractions import Fraction

from derive.command.errors import BadText
from derive.reading.tokens import END, NAME, NUMBER, OPERATOR, Token, tokens
from derive.reading.words import KEYWORDS, LOGICAL, PI, TRUE, Words, refusal

_DIGITS = 40
_POWER_OF_TEN = 100
_LEADING_ZEROS = re.compile(r"^0+(?=\d)")
_BINARY = ("+", "-", "*", "/", "<", "<=", ">", ">=", "and", "&", "or", "|")
_FUNCTION, _CONSTANT, _PREFIX = "function", "constant", "prefix"
"""Further kinds of tokens; x, parameters and symbols are of the kind NAME."""
_BEFORE_NOT = {(OPERATOR, sign) for sign in ("(", ",", "and", "or")} | {(_PREFIX, "not")}
_EMPTY = ("the text is empty", "write a formula, such as x**2/(2*R)")
_EARLY = ("the text ends too early", "add a number, a name or (")
_NO_OPERAND = KEYWORDS | {"", "not"}
_MISPLACED = {
    "": ("a parenthesis is not closed", "add )"),
    ")": ("this ) has no matching (", "leave it out, or add ("),
    ",": (
        "a comma is only allowed between the arguments of a function",
        "use a point in decimal numbers, such as 2.5",
    ),
    **dict.fromkeys(
        ("if", "else"),
        ("{} is not allowed here", "write Piecewise((value, condition), (value, True))"),
    ),
}
"""What is wrong with a token after an operand, and the remedy; the end of a text is empty."""


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
    tree = Tree(text, words, tuple(kept), root)
    for call in ast.walk(root):
        if isinstance(call, ast.Call):
            known, count = words.functions[ast.unparse(call.func)], len(call.args)
            if not known.least <= count <= known.most:
                remedy = "leave out the others" if count > known.most else "add the missing ones"
                why = f"{ast.unparse(call.func)} takes {known.number}, but {count} are given"
                raise refusal(text, tree.column(call), why, remedy)
    return tree


class _Scan:
    """Check the tokens of a text one after another, and keep them for Python.

    levels: the number of powers and prefixes around the next operand, within each open parenthesis
    """

    def __init__(self, text: str, words: Words) -> None:
        self.text, self.words = text, words
        self.kept: list[Token] = []
        self.levels = [0]

    def whole(self) -> list[Token]:
        """Return the tokens for Python; raises BadText."""
        for here in tokens(self.text):
            last = self.kept[-1] if self.kept else Token(OPERATOR, "(", 0)
            if last.kind == _FUNCTION and not here.among("("):
                raise self._refusal(last, f"{last.text} is a function", f"write {last.text}(...)")
            if last.kind in (NUMBER, NAME, _CONSTANT) or last.among(")"):
                if here.kind == END and len(self.levels) == 1:
                    break
                self._after_operand(here, last)
            else:
                self._operand(here, last)
        return self.kept

    def _operand(self, here: Token, last: Token) -> None:
        """Keep a token where an operand must begin: a prefix, or the operand's first token."""
        is_not = here.among("not", "~") and (last.kind, last.text) in _BEFORE_NOT
        if here.among("-", "+") or is_not:
            self.levels[-1] += 1
            self._keep(here, _PREFIX, "" if here.text == "+" else None)
        elif here.among("("):
            self.levels.append(0)
            self._keep(here, OPERATOR)
        elif here.kind == NUMBER:
            self._demand_short(here)
            self._keep(here, NUMBER)
        elif here.kind == NAME:
            self._keep(here, self._kind_of_name(here))
        elif here.kind == END:
            raise self._refusal(here, *(_EARLY if self.kept else _EMPTY))
        elif here.among("|"):
            why = "|x| cannot be used for an absolute value"
            raise self._refusal(here, why, "write Abs(x)")
        else:
            why = f"a number or a name is missing before {here.text}"
            raise self._refusal(here, why, f"add it, or leave out {here.text}")

    def _after_operand(self, here: Token, last: Token) -> None:
        """Keep a token that follows an operand."""
        is_inside = len(self.levels) > 1
        if here.among("**"):
            self.levels[-1] += 1
        elif here.among(*_BINARY) or (here.among(",") and is_inside):
            self.levels[-1] = 0
        elif here.among(")") and is_inside:
            self.levels.pop()
        elif here.among("(") and last.kind in (NAME, _CONSTANT):
            why = f"{last.text} is not a function that may be used here"
            remedy = f"write {last.text}*(...) for a product, or use a function of the list below"
            raise self._refusal(last, why, remedy)
        elif here.text not in _NO_OPERAND and (here.kind != OPERATOR or here.among("(")):
            remedy = "write * for a product, such as 2*x"
            raise self._refusal(here, "an operator is missing here", remedy)
        else:
            raise self._misplaced(here)
        self._keep(here, OPERATOR)

    def _kind_of_name(self, here: Token) -> str:
        if here.text in self.words.functions:
            return _FUNCTION
        if here.text in KEYWORDS or here.text in LOGICAL.values():
            raise self._misplaced(here)
        if here.text in (PI, TRUE):
            return _CONSTANT
        if mistake := self.words.mistake(here.text):
            raise self._refusal(here, *mistake)
        return NAME

    def _demand_short(self, here: Token) -> None:
        """Refuse a long number before it is computed."""
        mantissa, _, power = here.text.lower().partition("e")
        if len(mantissa) > _DIGITS or len(power) > 4 or abs(int(power or 0)) > _POWER_OF_TEN:
            remedy = f"write at most {_DIGITS} digits and powers of ten up to {_POWER_OF_TEN}"
            raise self._refusal(here, "the number is too long", remedy)

    def _keep(self, here: Token, kind: str, text: str | None = None) -> None:
        """Keep a token under its kind; raise BadText if it is nested too deeply."""
        if len(self.levels) - 1 + sum(self.levels) > self.words.deepest:
            why = f"the formula is nested deeper than {self.words.deepest} levels here"
            raise self._refusal(here, why, "write it with fewer parentheses")
        text = LOGICAL.get(here.text, here.text) if text is None else text
        self.kept.append(Token(kind, text, here.column))

    def _misplaced(self, here: Token) -> BadText:
        why, remedy = _MISPLACED.get(here.text, ("{} is not allowed here", "leave it out"))
        return self._refusal(here, why.format(here.text), remedy)

    def _refusal(self, at: Token, why: str, remedy: str) -> BadText:
        return refusal(self.text, at.column, why, remedy)
