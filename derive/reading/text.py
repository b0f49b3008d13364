"""Read a text, g(x) or a formula of a claims file, as a tree without computing anything.

The grammar is text.lark.  The first token that does not fit is refused at its column.
"""

import unicodedata
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache
from importlib.resources import files

from lark import Lark, Token, UnexpectedCharacters, UnexpectedToken
from lark import Tree as Branch

from derive.command.errors import BadText
from derive.reading.words import KEYWORDS, LOGICAL, PI, TRUE, Words, refusal

LONGEST = 2000
"""The largest number of characters of a text."""

_DIGITS = 40
_POWER_OF_TEN = 100

Call = Branch[Token]
Node = Call | Token
"""A part of a tree: a number, a name, or an operation with its parts."""

_MISTAKES = {
    "//": ("// rounds down", "write / for a quotient"),
    "==": ("== is not allowed in the condition of a profile", "write <, <=, > or >="),
    "=": ("a formula cannot contain an assignment", "write only the right-hand side of g(x)"),
    "^": ("^ does not denote a power", "write ** for a power, such as x**2"),
    ".": ("a formula cannot contain attributes", "use a point only in decimal numbers"),
    **dict.fromkeys("[]{}", ("{} is not allowed in a formula", "write ( ) to group")),
}
"""Why a sign is refused, and what to do instead."""
_NO_MEANING = ("{} has no meaning in a formula", "write it as in Python, with + - * / ** and ( )")
_INSTEAD = {
    **dict.fromkeys("−–—‐‑‒﹣-", "write -"),
    **dict.fromkeys("×·⋅∙∗*", "write *"),
    **dict.fromkeys("÷∕⁄/", "write /"),
    **dict.fromkeys("≤⩽", "write <="),
    **dict.fromkeys("≥⩾", "write >="),
    **dict.fromkeys("⁰¹²³⁴⁵⁶⁷⁸⁹ⁿ", "write ** for a power, such as x**2"),
    **dict.fromkeys("πϖ𝜋", "write pi"),
}
"""What to write instead of a character that is not ASCII."""
_EMPTY = ("the text is empty", "write a formula, such as x**2/(2*R)")
_EARLY = ("the text ends too early", "add a number, a name or (")
_PIECEWISE = ("{} is not allowed here", "write Piecewise((value, condition), (value, True))")
_MISPLACED = {
    "": ("a parenthesis is not closed", "add )"),
    ")": ("this ) has no matching (", "leave it out, or add ("),
    ",": (
        "a comma is only allowed between the arguments of a function",
        "use a point in decimal numbers, such as 2.5",
    ),
    **dict.fromkeys(("if", "else"), _PIECEWISE),
}
"""What is wrong with a token after an operand, and the remedy; the end of a text is empty."""
_NAMES = frozenset(("NAME", "PI", "TRUE"))
_OPERANDS = _NAMES | {"NUMBER", "RPAR"}
"""Terminals after which no operand may follow."""
_OPERANDS_BEGIN = _NAMES | {"NUMBER", "LPAR", "FUNCTION"}
_RELATIONS = frozenset(("ORDER", "EQUAL", "TILDE", "ARROW"))
"""Terminals that may stand between the two sides of an equation or a limit."""
_ONE = "write exactly one, as in left = right or x -> 0"
"""The remedy for a text with no relation, or with two."""
_AROUND = frozenset(("LPAR", "PREFIX", "NOT", "TILDE", "POWER"))
"""Terminals that nest what follows."""


@dataclass(frozen=True)
class Tree:
    """A text and its tree.

    words  the names that the text may contain
    """

    text: str
    words: Words
    whole: Branch[Token]

    @property
    def root(self) -> Node:
        """The value or condition that the text stands for."""
        return self.whole.children[0]

    def names(self, node: Node | None = None) -> dict[str, int]:
        """Every name that is not a function or constant, with the column where it first occurs."""
        columns: dict[str, int] = {}
        within = Branch("part", [self.whole if node is None else node])
        for token in within.scan_values(lambda each: getattr(each, "type", "") == "NAME"):
            columns.setdefault(str(token), column(token))
        return columns


def column(node: Node) -> int:
    """The column of the operator of an operation, or of the first token of another node."""
    if isinstance(node, Branch):
        has_operator = node.data in ("operation", "comparison", "both", "either")
        return column(node.children[1]) if has_operator else node.meta.start_pos
    return node.start_pos or 0


@cache
def _parser() -> Lark:
    grammar = (files("derive.reading") / "text.lark").read_text(encoding="utf-8")
    start = ["text", "relation"]
    return Lark(grammar, parser="lalr", lexer="basic", start=start, propagate_positions=True)


def parse(text: str, words: Words, start: str = "text") -> Tree:
    """The tree of `text`, which may contain the names that `words` allows.

    start: `text`, or `relation` for an equation or a limit, whose tree has two sides

    Raises BadText for the first token that does not fit.
    """
    longest = LONGEST if start == "text" else 2 * LONGEST
    if len(text) > longest:
        why = f"the text has {len(text)} characters, but at most {longest} are allowed"
        raise refusal(text, longest, why, "shorten it, or write it in several parts")
    parser, last = _parser().parse_interactive(text, start=start), Token("START", "")
    try:
        found = parser.lexer_thread.lex(parser.parser_state)  # type: ignore[no-untyped-call]
        for token in found:
            pair = text[column(token) :][:2]
            if pair in _MISTAKES and pair != token:
                raise _unknown(text, column(token))
            here = _typed(token, last, words)
            parser.feed_token(here)
            _demand_allowed(text, here, words, parser.parser_state.value_stack)
            last = here
        here = Token("$END", "", len(text))
        tree = Tree(text, words, parser.feed_token(here))
    except UnexpectedCharacters as error:
        raise _unknown(text, error.pos_in_stream or 0) from None
    except UnexpectedToken:
        if start == "text" and here in _MISTAKES:
            raise _unknown(text, column(here)) from None
        if not here and "EQUAL" in parser.accepts():  # type: ignore[no-untyped-call]
            raise refusal(text, len(text), "there is no relation here", _ONE) from None
        if start == "relation" and here.type in _RELATIONS and last.type in _OPERANDS:
            raise refusal(text, column(here), "there are two relations here", _ONE) from None
        raise _misplaced(text, here, last) from None
    for call in tree.whole.find_data("call"):
        name, *given = call.children
        known, count = words.functions[str(name)], len(given)
        if not known.least <= count <= known.most:
            remedy = "leave out the others" if count > known.most else "add the missing ones"
            number = f"{known.least} to " * (known.least < known.most) + str(known.most)
            why = f"{name} takes {number} argument{'s' * (known.most > 1)}, but {count} are given"
            raise refusal(text, column(call), why, remedy)
    return tree


def _typed(token: Token, last: Token, words: Words) -> Token:
    """Give a name its terminal, and a sign before an operand."""
    kind = token.type
    if token in words.functions:
        kind = "FUNCTION"
    elif token in KEYWORDS:
        kind = "KEYWORD"
    elif kind == "SIGN" and last.type not in _OPERANDS:
        kind = "PREFIX"
    elif kind == "NAME":
        kind = {PI: "PI", TRUE: "TRUE", **LOGICAL}.get(token, kind)
    return token.update(type=kind)


def _unknown(text: str, at: int) -> BadText:
    """The error for a sign or a character that no formula may contain."""
    sign = text[at : at + 2] if text[at : at + 2] in _MISTAKES else text[at]
    if sign.isascii() and sign.isprintable():
        why, remedy = _MISTAKES.get(sign, _NO_MEANING)
        return refusal(text, at, why.format(sign), remedy)
    called = unicodedata.name(text[at], "a character without a name")
    why = f"{text[at]!a} is {called} (U+{ord(text[at]):04X})"
    remedy = _INSTEAD.get(text[at], "write ASCII letters, digits and operators only")
    return refusal(text, at, why, remedy)


def _demand_allowed(text: str, here: Token, words: Words, stack: Iterable[object]) -> None:
    """Refuse a name or a long number, and what is nested too deeply, before it is computed."""
    if here.type == "NAME" and (mistake := words.mistake(str(here))):
        raise refusal(text, column(here), *mistake)
    if here.type == "NUMBER":
        mantissa, _, power = here.lower().partition("e")
        if len(mantissa) > _DIGITS or len(power) > 4 or abs(int(power or 0)) > _POWER_OF_TEN:
            remedy = f"write at most {_DIGITS} digits and powers of ten up to {_POWER_OF_TEN}"
            raise refusal(text, column(here), "the number is too long", remedy)
    if sum(getattr(each, "type", "") in _AROUND for each in stack) > words.deepest:
        why = f"the formula is nested deeper than {words.deepest} levels here"
        raise refusal(text, column(here), why, "write it with fewer parentheses")


def _misplaced(text: str, here: Token, last: Token) -> BadText:
    """The error for a token that cannot follow the last one."""
    misses_operand = last.type not in _OPERANDS
    why, remedy = _MISPLACED.get(here, ("{} is not allowed here", "leave it out"))
    if last.type == "FUNCTION":
        here, why, remedy = last, "{} is a function", f"write {last}(...)"
    elif misses_operand and not here:
        why, remedy = _EARLY if last else _EMPTY
    elif misses_operand and here == "|":
        why, remedy = "|x| cannot be used for an absolute value", "write Abs(x)"
    elif misses_operand and not here.isidentifier():
        why, remedy = "a number or a name is missing before {}", f"add it, or leave out {here}"
    elif here == "(" and last.type in _NAMES:
        here, why = last, "{} is not a function that may be used here"
        remedy = f"write {last}*(...) for a product, or use a function of the list below"
    elif here.type in _OPERANDS_BEGIN:
        why, remedy = "an operator is missing here", "write * for a product, such as 2*x"
    return refusal(text, column(here), why.format(here), remedy)
