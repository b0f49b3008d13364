r"""Find the symbols in LaTeX, and give a name to each.

A letter with all its indices and accents is one symbol: K_{N,c}, E^*, \Delta Q, q_1^{(asy)}(x).
A letter followed by a symbol, or a list of symbols, in parentheses is a function, which is one
symbol as well; p(x) and p(x, c) are two different symbols.  The draft lists every spelling, so that
the user can check it.
"""

import re
from collections.abc import Collection, Iterable, Iterator, Sequence

from derive.reading.formula import usable
from derive.reading.lexer import GREEK, Token

# Tokens are matched as text, with a space after each.
_GREEK = "|".join(re.escape(each) for each in sorted(GREEK))
_LETTER = rf"(?:[A-Za-z]|{_GREEK}) "
_ACCENTS = {
    **{rf"\{name}": name for name in ("bar", "hat", "tilde", "dot", "ddot", "vec", "check")},
    **{r"\overline": "bar", r"\widehat": "hat", r"\widetilde": "tilde", r"\underline": "under"},
    **{r"\mathcal": "cal", r"\mathscr": "scr", r"\mathfrak": "frak"},
}
_SIGNS = {"+": "plus", "-": "minus", "*": "star", "'": "prime"}
_ACCENT = "|".join(map(re.escape, _ACCENTS))
_COMMAND = rf"(?:{_GREEK}|\\(?:pi|infty|min|max|perp|parallel|circ))"
_PART = rf"(?:[A-Za-z]|\d+|{_COMMAND}) "
_INDEX = (
    rf"_ (?:{_PART}|[*+-] "
    rf"|\{{ (?:[*+-] |(?:{_PART}|[(),] )*{_PART}(?:[()] )*(?:, [+-] )?)\}} )"
)
_RAISED = (
    r"\^ (?:[*'+-] |\{ (?:[*'+-] "
    rf"|\( \d+ \) |(?:\( |{_LETTER}(?=[^}}]))(?:[A-Za-z] |{_COMMAND} |[(),] )+)\}} )"
)
_HUNG = rf"(?:' |{_INDEX}|{_RAISED})*"
_BODY = rf"(?:{_LETTER}|(?:{_ACCENT}) (?:{_LETTER}|\{{ {_LETTER}{_HUNG}\}} )){_HUNG}"
_WHOLE = rf"(?:\\Delta (?!\\Delta )|\\dd )?{_BODY}"
_CALL = ""
for _ in range(3):  # arguments may be functions
    _ARGUMENT = rf"(?:\d+ (?=[,;)]|$)|{_WHOLE}{_CALL})"
    _CALL = rf"(?:\( (?:{_ARGUMENT}(?:[,;] (?!\))|(?=\))))+\) )?"
_SYMBOL = _WHOLE + _CALL
_TIMES = r"(?:\^ (?:\d |\{ \d \} ))?"
_DERIVATIVE = (
    rf"\\frac \{{ (?:\\dd |\\partial )({_TIMES})({_SYMBOL})\}} "
    rf"\{{ (?:\\dd |\\partial )({_SYMBOL})({_TIMES})\}} "
)
_SLASHED = rf"(?:d|\\dd) ({_LETTER})/ (?:d|\\dd) ({_LETTER})"
_FOUND = re.compile(rf"(?<!\S)(?:{_DERIVATIVE}|{_SLASHED}|(?!\\Gamma \(){_SYMBOL})")
_ACCENTED = re.compile(rf"({_ACCENT}) (?:({_LETTER})|\{{ ({_LETTER}{_HUNG})\}} )")
_NAMED = {
    r"\\Delta (?=\\?[A-Za-z])": "Delta_",
    **{r"\\dd ": "d", r"\\lambda ": "lam", r"\( ": "_at_", "[,;] ": "_", r"[)\\ ]": ""},
}
"""What stands in a name for parts of a symbol; formulas may not hold lambda."""


def symbols(tokens: Sequence[Token]) -> Iterator[tuple[int, int, str]]:
    """Yield the start, the end and a name for each symbol."""
    text = "".join(token.text.replace(" ", "~") + " " for token in tokens)
    for match in _FOUND.finditer(text):
        yield text.count(" ", 0, match.start()), text.count(" ", 0, match.end()), _name(match)


def _name(match: re.Match[str]) -> str:
    times, over, under = match[1] or "", match[2] or match[5], match[3] or match[6]
    if over is None:
        return _symbol_name(match[0])
    order = re.sub(r"\D", "", times)
    return f"d{order}{_symbol_name(over)}_d{_symbol_name(under)}{order}"


def _symbol_name(text: str) -> str:
    text = _ACCENTED.sub(lambda match: f"{match[2] or match[3]}_{_ACCENTS[match[1]]} ", text)
    text = re.sub(rf"' |{_INDEX}|{_RAISED}", _hung_name, text)
    for part, name in _NAMED.items():
        text = re.sub(part, name, text)
    return text


def _hung_name(match: re.Match[str]) -> str:
    """Return what an index, an exponent or a prime adds to a name."""
    words = re.sub(r"[{}()\\ ]", "", match[0].removeprefix("_ ").removeprefix("^ "))
    words = re.sub("^,", "comma,", words)
    if match[0][0] == "^" and words not in _SIGNS:
        is_number = words.isdigit() or len(words) == 1
        words = ("upper" if is_number else "") + words.replace(",", "")
    return "_" + "_".join(_SIGNS.get(word, word) for word in words.split(",") if word)


def spellings(tokens: Sequence[Token]) -> dict[str, str]:
    """Return a name for the LaTeX of every symbol."""
    found = symbols(tokens)
    return {_spelled(tokens[start:end]): name for start, end, name in found if usable(name)}


def _plain_ones(tokens: Sequence[Token]) -> Iterator[tuple[str, bool]]:
    """Yield the symbols printed without arguments, and whether a parenthesis follows."""
    for start, end, name in symbols(tokens):
        if "_at_" not in name:
            yield _spelled(tokens[start:end]), [t.text for t in tokens[end : end + 1]] == ["("]


def functions_in(formulas: Iterable[Sequence[Token]]) -> set[str]:
    """Return the symbols that are printed as functions, and nowhere without parentheses."""
    found, alone = set[str](), set[str]()
    for tokens in formulas:
        names = spellings(tokens).items()
        found |= {own.partition("(")[0] for own, name in names if "_at_" in name}
        alone |= {own for own, follows in _plain_ones(tokens) if not follows}
    return found - alone


def unclear_call(formulas: Iterable[Sequence[Token]], functions: Collection[str]) -> str:
    """Return a function before parentheses that hold no list of symbols; empty if there is none."""
    found = (each for tokens in formulas for each in _plain_ones(tokens))
    return next((own for own, follows in found if follows and own in functions), "")


def _spelled(tokens: Sequence[Token]) -> str:
    text = ""
    for token in tokens:
        text += " " if re.search(r"\\[A-Za-z]+$", text) and token.text[0].isalpha() else ""
        text += token.text
    return text
