"""Cuts a text of g(x) into numbers, names and operators, one at a time."""

import re
import unicodedata
from collections.abc import Iterator
from dataclasses import dataclass

from derive.writing.vocabulary import refusal

LONGEST = 2000
"""Characters that a text may have."""

NUMBER, NAME, OPERATOR, END = "number", "name", "operator", "end"

_TOKEN = re.compile(
    r"(?P<number>(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?)"
    r"|(?P<name>[A-Za-z_][A-Za-z0-9_]*)"
    r"|(?P<operator>\*\*|<=|>=|[-+*/()<>,&|~])"
)

_MISTAKES = {
    "//": ("// rounds down", "write / for a quotient"),
    "==": ("== is no condition of a profile", "write <, <=, > or >="),
    "!=": ("!= is no condition of a profile", "write <, <=, > or >="),
    "<<": ("<< is no condition", "write <"),
    ">>": (">> is no condition", "write >"),
    ":=": ("nothing is assigned in a formula", "write the right-hand side of g(x) alone"),
    "->": ("an arrow stands for nothing here", "write - and > apart, or leave it out"),
    "=": ("nothing is assigned in a formula", "write the right-hand side of g(x) alone"),
    "^": ("^ is no power here", "write ** for a power, such as x**2"),
    ".": ("nothing has attributes here", "write a decimal point between digits only"),
    "[": ("[ ] take out elements, of which there are none", "write ( ) to group"),
    "]": ("[ ] take out elements, of which there are none", "write ( ) to group"),
    "{": ("{ } hold sets, of which there are none", "write ( ) to group"),
    "}": ("{ } hold sets, of which there are none", "write ( ) to group"),
    "'": ("text in quotes is no part of a formula", "leave it out"),
    '"': ("text in quotes is no part of a formula", "leave it out"),
    "`": ("text in quotes is no part of a formula", "leave it out"),
    "!": ("! stands for nothing here", "leave it out"),
    "%": ("% stands for nothing here", "write a fraction as a number, such as 0.05"),
    "@": ("@ multiplies matrices, of which there are none", "write * for a product"),
    ";": ("; ends a formula, and one is enough", "leave it out"),
    ":": (": stands for nothing here", "leave it out"),
    "\\": ("\\ stands for nothing here", "write g(x) as in Python, not as in LaTeX"),
    "$": ("$ stands for nothing here", "write g(x) as in Python, not as in LaTeX"),
    "#": ("a formula has no comments", "say it by --title"),
}

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
    **dict.fromkeys("∞", "leave it out: a profile is finite"),
}


@dataclass(frozen=True)
class Token:
    """One word of a formula and the column where it starts."""

    kind: str
    text: str
    column: int

    def among(self, *operators: str) -> bool:
        """Whether it is one of these operators."""
        return self.kind in (OPERATOR, NAME) and self.text in operators


def tokens(text: str) -> Iterator[Token]:
    """The tokens of `text`, and END for ever; a character is looked at when it is asked for."""
    if len(text) > LONGEST:
        raise refusal(
            text,
            LONGEST,
            f"the text has {len(text)} characters, {LONGEST} are the most",
            "shorten it, or write a geometry file by hand",
        )
    column = _skip(text, 0)
    while column < len(text):
        mistake = text[column : column + 2] in _MISTAKES
        found = None if mistake else _TOKEN.match(text, column)
        if found is None:
            raise _unknown(text, column)
        yield Token(str(found.lastgroup), found.group(), column)
        column = _skip(text, found.end())
    while True:
        yield Token(END, "", column)


def _skip(text: str, column: int) -> int:
    """The next column without a blank."""
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
