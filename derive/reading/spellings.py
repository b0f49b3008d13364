r"""Find the symbols in LaTeX, and give a name to each.

A letter with all its indices and accents is one symbol: K_{N,c}, E^*, \Delta Q, q_1^{(asy)}(x).
A letter followed by a symbol, or a list of symbols, in parentheses is a function, which is one
symbol as well; p(x) and p(x, c) are two different symbols.  The draft lists every spelling, so
that the user can check it.
"""

import re
from collections.abc import Collection, Iterator, Mapping, Sequence

from derive.reading.formula import usable
from derive.reading.lexer import GREEK, Token

# Tokens are matched as text, with a space after each.
_GREEK = "|".join(re.escape(each) for each in sorted(GREEK))
_LETTER = rf"(?:[A-Za-z]|{_GREEK}) "
_ACCENTS = {
    **{rf"\{name}": name for name in ("bar", "hat", "tilde", "dot", "vec")},
    **{r"\overline": "bar", r"\widehat": "hat", r"\widetilde": "tilde"},
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
    rf"|(?:\( |{_LETTER}(?=[^}}]))(?:[A-Za-z] |{_COMMAND} |[(),] )+)\}} )"
)
_HUNG = rf"(?:' |{_INDEX}|{_RAISED})*"
_BODY = rf"(?:{_LETTER}|(?:{_ACCENT}) (?:{_LETTER}|\{{ {_LETTER}{_HUNG}\}} )){_HUNG}"
_WHOLE = rf"(?:\\Delta (?!\\Delta )|\\dd )?{_BODY}"
_CALL = ""
for _ in range(3):  # arguments may be functions
    _ARGUMENT = rf"(?:\d+ (?=[,;)]|$)|{_WHOLE}{_CALL})"
    _CALL = rf"(?:\( {_ARGUMENT}(?:[,;] {_ARGUMENT})*\) )?"
_SYMBOL = _WHOLE + _CALL
_TIMES = r"(?:\^ (?:\d |\{ \d \} ))?"
_DERIVATIVE = (
    rf"\\frac \{{ (?:\\dd |\\partial )({_TIMES})({_SYMBOL})\}} "
    rf"\{{ (?:\\dd |\\partial )({_SYMBOL})({_TIMES})\}} "
)
_SLASHED = rf"(?:d|\\dd) ({_LETTER})/ (?:d|\\dd) ({_LETTER})"
_FOUND = re.compile(rf"(?<!\S)(?:{_DERIVATIVE}|{_SLASHED}|(?!\\Gamma \(){_SYMBOL})")
_PIECES = re.compile(
    rf"(\\Delta |\\dd )??(?:({_LETTER})|({_ACCENT}) (?:({_LETTER})|\{{ ({_LETTER}{_HUNG})\}} ))"
    rf"({_HUNG})({_CALL})"
)


def symbols(tokens: Sequence[Token]) -> Iterator[tuple[int, int, str]]:
    """Yield the start, the end and a name for each symbol."""
    text = "".join(token.text.replace(" ", "~") + " " for token in tokens)
    integrates = any(each.type == "INT" for each in tokens)
    at = 0
    while match := _FOUND.search(text, at):
        start, at = match.start(), match.end()
        if integrates and match[0].startswith(r"\dd "):
            at = start + len(r"\dd ")
            continue
        yield text.count(" ", 0, start), text.count(" ", 0, at), _name(match)


def _name(match: re.Match[str]) -> str:
    times, over, under = match[1] or "", match[2] or match[5], match[3] or match[6]
    if over is None:
        return _symbol_name(match[0])
    order = re.sub(r"\D", "", times)
    return f"d{order}{_symbol_name(over)}_d{_symbol_name(under)}{order}"


def _symbol_name(text: str) -> str:
    pieces = _PIECES.fullmatch(text)
    assert pieces is not None
    before, letter, accent, accented, inner, hung, call = pieces.groups()
    own = (letter or accented or "").strip().removeprefix("\\")
    own = "lam" if own == "lambda" else own  # formulas may not hold lambda
    name = (_symbol_name(inner) if inner else own) + (f"_{_ACCENTS[accent]}" if accent else "")
    for each in re.findall(rf"' |{_INDEX}|{_RAISED}", hung):
        words = re.sub(r"[{}()\\]|\s", "", re.sub(r"^[_^] ", "", each))
        if each[0] == "^" and words not in _SIGNS:
            words = words.replace(",", "")
        name += "_" + "_".join(_SIGNS.get(word, word) for word in words.split(",") if word)
    if before:
        name = {"\\Delta ": "Delta_", "\\dd ": "d"}[before] + name
    if call:
        arguments = re.findall(_ARGUMENT, call[2:-2])
        name += "_at_" + "_".join(
            each.strip() if each[0].isdigit() else _symbol_name(each) for each in arguments
        )
    return name


def spellings(tokens: Sequence[Token]) -> dict[str, str]:
    """Return a name for the LaTeX of every symbol."""
    return {
        _spelled(tokens[start:end]): name for start, end, name in symbols(tokens) if usable(name)
    }


def _plain_ones(tokens: Sequence[Token]) -> Iterator[tuple[str, bool]]:
    """Yield the symbols printed without arguments, and whether a parenthesis follows."""
    for start, end, name in symbols(tokens):
        if "_at_" not in name:
            yield _spelled(tokens[start:end]), [t.text for t in tokens[end : end + 1]] == ["("]


def standing_alone(tokens: Sequence[Token]) -> set[str]:
    """Return the symbols that are printed without arguments and without following parentheses."""
    return {own for own, follows in _plain_ones(tokens) if not follows}


def unclear_call(
    tokens: Sequence[Token], spelled: Mapping[str, str], alone: Collection[str]
) -> str:
    """Return a symbol for which it is unclear whether the parentheses after it are its argument.

    Such a symbol is a function wherever else it occurs.  The result is empty if there is none.
    """
    functions = {own.partition("(")[0] for own, name in spelled.items() if "_at_" in name}
    unclear = functions - set(alone)
    return next((own for own, follows in _plain_ones(tokens) if follows and own in unclear), "")


def _spelled(tokens: Sequence[Token]) -> str:
    text = ""
    for token in tokens:
        text += " " if re.search(r"\\[A-Za-z]+$", text) and token.text[0].isalpha() else ""
        text += token.text
    return text
