"""Splits a text into numbers, names and operators, one at a time."""

import re
import unicodedata
from collections.abc import Iterator
from dataclasses import dataclass

from derive.reading.words import refusal

LONGEST = 2000
"""The largest number of characters of a text."""

NUMBER, NAME, OPERATOR, END = "number", "name", "operator", "end"

_TOKEN = re.compile(
    r"(?P<number>(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?)"
    r"|(?P<name>[A-Za-z_][A-Za-z0-9_]*)"
    r"|(?P<operator>\*\*|<=|>=|[-+*/()<>,&|~])"
)

_MISTAKES = {
    "//": ("// rounds down", "write / for a quotient"),
    "==": ("== is not allowed in the condition of a profile", "write <, <=, > or >="),
    "!=": ("!= is not allowed in the condition of a profile", "write <, <=, > or >="),
    "<<": ("<< is not a comparison", "write <"),
    ">>": (">> is not a comparison", "write >"),
    ":=": ("a formula cannot contain an assignment", "write only the right-hand side of g(x)"),
    "->": ("an arrow has no meaning in a formula", "put a space between - and >, or leave it out"),
    "=": ("a formula cannot contain an assignment", "write only the right-hand side of g(x)"),
    "^": ("^ does not denote a power", "write ** for a power, such as x**2"),
    ".": ("a formula cannot contain attributes", "use a point only in decimal numbers"),
    "[": ("[ ] are not allowed in a formula", "write ( ) to group"),
    "]": ("[ ] are not allowed in a formula", "write ( ) to group"),
    "{": ("{ } are not allowed in a formula", "write ( ) to group"),
    "}": ("{ } are not allowed in a formula", "write ( ) to group"),
    "'": ("text in quotes is not allowed in a formula", "leave it out"),
    '"': ("text in quotes is not allowed in a formula", "leave it out"),
    "`": ("text in quotes is not allowed in a formula", "leave it out"),
    "!": ("! has no meaning in a formula", "leave it out"),
    "%": ("% has no meaning in a formula", "write a percentage as a number, such as 0.05"),
    "@": ("@ is not allowed, because a formula has no matrices", "write * for a product"),
    ";": ("; is not allowed, because only one formula can be given", "leave it out"),
    ":": (": has no meaning in a formula", "leave it out"),
    "\\": ("\\ has no meaning in a formula", "write g(x) as in Python, not as in LaTeX"),
    "$": ("$ has no meaning in a formula", "write g(x) as in Python, not as in LaTeX"),
    "#": ("a formula cannot contain a comment", "describe the profile with --title"),
}
"""The reason why an operator is refused, and what to do instead."""

_INSTEAD = {
    **dict.fromkeys("−–—‐‑‒﹣-", "write -"),
    **dict.fromkeys("×·⋅∙∗*", "write *"),
    **dict.fromkeys("÷∕⁄/", "write /"),
    **dict.fromkeys("≤⩽", "write <="),
    **dict.fromkeys("≥⩾", "write >="),
    **dict.fromkeys("⁰¹²³⁴⁵⁶⁷⁸⁹ⁿ", "write ** for a power, such as x**2"),
    **dict.fromkeys("πϖ𝜋", "write pi"),
    **dict.fromkeys("√∛", "write sqrt(...), or **(1/3) for a cube root"),
    **dict.fromkeys("½⅓⅔¼¾⅕⅛", "write the fraction, such as 1/2"),
    **dict.fromkeys("∞", "leave it out, because a profile is finite"),
}
"""What to write instead of a character that is not ASCII."""


@dataclass(frozen=True)
class Token:
    """One token of a formula and the column where it starts."""

    kind: str
    text: str
    column: int

    def among(self, *operators: str) -> bool:
        """Whether the token is one of these operators."""
        return self.kind in (OPERATOR, NAME) and self.text in operators


def tokens(text: str) -> Iterator[Token]:
    """The tokens of `text`, then END without limit; the text is read only as far as needed."""
    if len(text) > LONGEST:
        raise refusal(
            text,
            LONGEST,
            f"the text has {len(text)} characters, but at most {LONGEST} are allowed",
            "shorten it, or write a geometry file by hand",
        )
    column = _skip(text, 0)
    while column < len(text):
        mistake = text[column : column + 2] in _MISTAKES
        match = None if mistake else _TOKEN.match(text, column)
        if match is None:
            raise _unknown(text, column)
        yield Token(str(match.lastgroup), match.group(), column)
        column = _skip(text, match.end())
    while True:
        yield Token(END, "", column)


def _skip(text: str, column: int) -> int:
    """The next column that is not white space."""
    while column < len(text) and text[column] in " \t\r\n":
        column += 1
    return column


def _unknown(text: str, column: int) -> Exception:
    for length in (2, 1):
        if advice := _MISTAKES.get(text[column : column + length]):
            return refusal(text, column, *advice)
    character = text[column]
    called = unicodedata.name(character, "a character without a name")
    return refusal(
        text,
        column,
        f"{character!a} is {called} (U+{ord(character):04X})",
        _INSTEAD.get(character, "write ASCII letters, digits and operators only"),
    )
