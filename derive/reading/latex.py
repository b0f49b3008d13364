r"""Read an equation given as LaTeX, provided that it can be read in only one way.

LaTeX is ambiguous as a formula: `f(x)` may be a call or a product, and a parser that never fails
has to guess.  Therefore only symbols that the claims file declares, numbers, and the commands of
derive.reading.lexer are read; anything else is refused, with its place.  A declared symbol is never
a function.  An implied product gets a multiplication sign, unless it could be part of a denominator
after a slash.  Invisible braces may hold at most one factor.  The end of the argument of a
function, of a sum or of an integral must be clear from what is printed.  The result is text for
derive.reading.formula, term by term in the printed order, so that a user can compare the two.
The claims file must accept this text.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Any

from lark import Lark, UnexpectedToken

from derive.command.errors import BadFormula
from derive.reading.lexer import GREEK, Token, Unclear, derivative, scan, tokens_of
from derive.reading.typed import EXPONENT, FRACTION, FUNCTION, ROOT, Limits, transformer, typed

_LONGEST = 2000
"""The largest number of characters in an equation."""


@dataclass(frozen=True)
class Latex:
    """LaTeX of a claim.

    where      the location of the claim, for error messages
    text       the LaTeX as in the source
    spellings  the LaTeX of each symbol -> its name in the claims file
    """

    where: str
    text: str
    spellings: Mapping[str, str]

    def understood(self) -> str:
        """Return an equation as text; raise BadFormula if there is not exactly one reading."""
        try:
            if len(self.text) > _LONGEST:
                why = f"the equation has {len(self.text)} characters, and at most {_LONGEST}"
                remedy = "split the equation, or shorten it with new symbols"
                raise Unclear(_LONGEST, f"{why} are read", remedy)
            return self.equation([each for each in tokens_of(self.text) if each.type != "GAP"])
        except Unclear as error:
            raise self._refusal(error) from error

    def equation(self, tokens: Sequence[Token]) -> str:
        """Return tokens of the text that form an equation as typed text; raises BadFormula."""
        kinds = ("EQUAL", "ORDER", "ROUGH")
        between = [n for n, t in enumerate(tokens) if t.type in kinds and not t.depth]
        if len(between) != 1:
            at = tokens[between[1]].at if between else len(self.text)
            why = "there are two relations here" if between else "there is no relation here"
            raise self._refusal(Unclear(at, why, "write one equation with exactly one relation"))
        relation = tokens[between[0]]
        left = self._read("side", tokens[: between[0]], relation.at)
        right = self._read("side", tokens[between[0] + 1 :])
        return f"{left} {typed(relation)} {right}"

    def condition(self, tokens: Sequence[Token]) -> str:
        """Return a condition such as -a < x < c and b > 0 as text; raises BadFormula."""
        return self._read("conditions", tokens)

    def approach(self, tokens: Sequence[Token]) -> str:
        r"""Return a limit as text, such as c - x -> 0 for c-x \to 0; raises BadFormula."""
        return self._read("approach", tokens)

    def _read(self, start: str, tokens: Sequence[Token], end: int | None = None) -> str:
        parser = _parser().parse_interactive(start=start)
        try:
            for token in _terminals(tokens, self.spellings):
                kind = _literals().get(token.type, token.type)
                parser.feed_token(token._replace(type=kind))  # type: ignore[arg-type]
            return str(parser.feed_eof())  # type: ignore[no-untyped-call]
        except UnexpectedToken as error:
            token = Token("$END", "", len(self.text) if end is None else end)
            token = error.token if isinstance(error.token, Token) else token
            raise self._refusal(_unread(token, parser.parser_state.value_stack)) from error
        except Unclear as error:
            raise self._refusal(error) from error

    def _refusal(self, error: Unclear) -> BadFormula:
        """Return the error for a place in the text."""
        start = self.text.rfind("\n", 0, error.at) + 1
        line = self.text[start:].partition("\n")[0]
        return BadFormula(self.where, line, error.at - start, error.why, error.remedy)


@cache
def _parser() -> Lark:
    grammar = (files("derive.reading") / "latex.lark").read_text(encoding="utf-8")
    starts = ["side", "conditions", "approach"]
    return Lark(grammar, parser="lalr", lexer="basic", start=starts, transformer=transformer())


@cache
def _literals() -> Mapping[str, str]:
    """The names of the terminals that stand in quotes in the grammar."""
    return {"{": "LBRACE", **{str(each.pattern.value): each.name for each in _parser().terminals}}


# ------------------------------------------------------------------ terminals


def _terminals(tokens: Sequence[Token], spellings: Mapping[str, str]) -> Iterator[Token]:
    """Join the tokens of every symbol, and tell opening bars from closing ones."""
    bound, texts = _bound(tokens), [each.text for each in tokens]
    cuts = {_cut(spelling): name for spelling, name in spellings.items()}
    bars, position, before = dict[int, Token](), 0, Token("", "", 0)
    while position < len(tokens):
        token = tokens[position]
        found = [cut for cut in cuts if tuple(texts[position : position + len(cut)]) == cut]
        cut = max(found, key=len, default=())
        if cut and not (token.type == "DIFF" and any(each.type == "INT" for each in tokens)):
            token = token._replace(type="SYMBOL", text=cuts[cut], size=len(cut))
        elif token.text in bound:
            token = token._replace(type="SYMBOL")
        elif token.text == r"\Gamma" and texts[position + 1 : position + 2] == ["("]:
            token = token._replace(type="FUNC")
        elif derivative(tokens, position) == position + 5:
            why = "d/dx before its operand is not supported"
            raise Unclear(token.at, why, "write it as text, diff(f, x)")
        position += token.size if token.type == "SYMBOL" else 1
        for opened in [each for depth, each in bars.items() if depth > token.depth]:
            raise Unclear(opened.at, *_BAR)
        if token.text == "|":
            token = token._replace(type="RBAR" if bars.pop(token.depth, None) else "LBAR")
            if token.type == "LBAR":
                bars[token.depth] = token
        if token.type == before.type == "NUMBER":
            why = "there are two numbers with no operator between them"
            raise Unclear(token.at, why, "put \\cdot between them")
        if before.type == "FRAC" and token.type == "NUMBER" and token.size > 2:
            raise Unclear(token.at, *FRACTION)
        if before.type == "FRAC" and token.type == "NUMBER" and token.size == 2:  # as in \frac12
            yield Token("NUMBER", token.text[0], token.at)
            token = Token("NUMBER", token.text[1], token.at + 1)
        before = token
        yield token
    for opened in bars.values():
        raise Unclear(opened.at, *_BAR)


_BAR = ("this | is not closed", "add |")


@cache
def _cut(spelling: str) -> tuple[str, ...]:
    """The texts of the tokens of a spelling."""
    try:
        return tuple(each.text for each in tokens_of(spelling))
    except Unclear:
        return tuple(each.text for each in scan(spelling))


def _bound(tokens: Sequence[Token]) -> frozenset[str]:
    """Return the letters along which an integral, a sum or a limit is taken."""
    found, kinds = set[str](), [each.type for each in tokens]
    for n, kind in enumerate(kinds):
        after = 1 if kind == "DIFF" and "INT" in kinds else 3 * (kind in ("SUM", "LIM"))
        found.update(each.text for each in tokens[n + after : n + after + 1] if after)
    return frozenset(t for t in found if (len(t) == 1 and t.isalpha()) or t in GREEK)


# ------------------------------------------------------------------ refusals

_UNFINISHED = {
    "POWER": (0, EXPONENT),
    "SQRT": (0, ROOT),
    "FRAC": (1, FRACTION),
    "INT": (3, ("this integral lacks a limit", "write both limits, as in \\int_{a}^{b}")),
    "SUM": (7, ("this sum lacks a limit", "write both limits, as in \\sum_{k=1}^{n}")),
    "LIM": (5, ("this limit is incomplete", "write it as \\lim_{x \\to a}")),
}
"""What is unclear if a token does not fit after one of these and at most so many others."""


def _unread(token: Token, stack: Sequence[Any]) -> Unclear:
    """Return the reason why a token does not fit after what is on the parser's stack."""
    known = {each.name for rule in _parser().rules for each in rule.expansion if each.is_term}
    if token.type == "TEXT":
        why = f"the words {token.words!r} are not understood here"
        remedy = "write the claim as text, with numbers in the units of the file"
        return Unclear(token.at, why, remedy)
    if token.type not in {"$END", *known}:
        why = f"{token.text} is neither a declared symbol nor a supported command"
        return Unclear(token.at, why, "declare it under [latex], or write the claim as text")
    is_end = token.type in ("$END", "RPAR", "RBRACE", "RSQB", "RBAR")
    top = stack[-1] if stack else None
    if isinstance(top, Token) and top.type in FUNCTION:
        if is_end:
            return Unclear(token.at, f"{top.text} has no argument", "add one")
        why = "this cannot be the argument of a function"
        return Unclear(token.at, why, "put the argument in parentheses")
    for n, each in reversed([(n, t) for n, t in enumerate(stack) if isinstance(t, Token)]):
        most, reason = _UNFINISHED.get(each.type, (-1, ("", "")))
        limited = any(isinstance(other, Limits) for other in stack[n : n + 2])
        if len(stack) - n - 1 <= most and not limited:
            is_there = each.type in ("POWER", "SQRT", "FRAC")
            return Unclear(token.at if is_there else each.at, *reason)
        if each.type == "INT" and is_end:
            why = "the end of this integral is unclear"
            return Unclear(each.at, why, "end it with a differential, as \\mathrm{d}s")
    if token.type in ("UNDERSCORE", "DIFF"):
        return Unclear(token.at, f"{token.text} is not allowed here", "remove it")
    why = "the LaTeX cannot be read from here on"
    return Unclear(token.at, why, "put \\cdot between factors, or write the claim as text")
