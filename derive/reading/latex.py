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

from derive.reading.lexer import GREEK, Token, Unclear, plain, refusal, scan, tokens_of
from derive.reading.typed import TYPED

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

    def read(self, kind: str, tokens: Sequence[Token]) -> str:
        r"""Return tokens of the text as typed text.

        Raises BadFormula if there is not exactly one reading.

        kind: `equation`, `conditions` such as -a < x < c and b > 0, or `approach`, which is a
        limit such as c-x \to 0
        """
        parser = _parser().parse_interactive(start=kind)
        try:
            if (count := len(plain(tokens))) > _LONGEST:
                why = f"this has {count} characters, and at most {_LONGEST} are read"
                raise Unclear(tokens[0].at, why, "split it, or shorten it with new symbols")
            for token in _joined(tokens, self.spellings):
                type_ = _literals().get(token.type, token.type)
                parser.feed_token(token._replace(type=type_))  # type: ignore[arg-type]
            return f"{parser.feed_eof()}"  # type: ignore[no-untyped-call]
        except UnexpectedToken as error:
            token = Token("$END", "", len(self.text))
            token = error.token if isinstance(error.token, Token) else token
            unclear = _unread(token, parser.parser_state.value_stack)
            raise refusal(self.where, self.text, unclear) from error
        except Unclear as error:
            raise refusal(self.where, self.text, error) from error


@cache
def _parser() -> Lark:
    grammar = (files("derive.reading") / "latex.lark").read_text(encoding="utf-8")
    starts = ["equation", "conditions", "approach"]
    return Lark(grammar, parser="lalr", lexer="basic", start=starts, transformer=TYPED)


@cache
def _literals() -> Mapping[str, str]:
    """The names of the terminals that stand in quotes in the grammar."""
    return {"{": "LBRACE", **{str(each.pattern.value): each.name for each in _parser().terminals}}


def _joined(tokens: Sequence[Token], spellings: Mapping[str, str]) -> Iterator[Token]:
    """Join the tokens of every symbol."""
    bound, texts, kinds = _bound(tokens), [t.text for t in tokens], [t.type for t in tokens]
    position, cuts = 0, {_cut(each): name for each, name in spellings.items()}
    while position < len(tokens):
        token = tokens[position]
        found = [cut for cut in cuts if tuple(texts[position : position + len(cut)]) == cut]
        cut = max(found, key=len, default=())
        if cut:
            if "TO" in kinds[:position] and {"+", "-"} & {*cut[-2:]}:
                why = "a limit from one side is not read"
                raise Unclear(token.at, why, "write the claim with `as`, or as text")
            if _bound(tokens, ("SUM",)) & {*cut[1:]}:
                why = (
                    f"{plain(tokens[position : position + len(cut)])} differs in each term of a sum"
                )
                raise Unclear(token.at, why, "write the terms out, or a formula for the symbol")
            token = token._replace(type="SYMBOL", text=cuts[cut], size=len(cut))
        elif token.text in bound:
            token = token._replace(type="SYMBOL")
        elif token.text == r"\Gamma" and texts[position + 1 : position + 2] == ["("]:
            token = token._replace(type="FUNC")
        position += token.size if token.type == "SYMBOL" else 1
        yield token


@cache
def _cut(spelling: str) -> tuple[str, ...]:
    """The texts of the tokens of a spelling."""
    try:
        return tuple(each.text for each in tokens_of(spelling))
    except Unclear:
        return tuple(each.text for each in scan(spelling))


def _bound(tokens: Sequence[Token], by: Sequence[str] = ("DIFF", "SUM", "LIM")) -> frozenset[str]:
    """Return the letters along which an integral, a sum or a limit is taken."""
    found, kinds = set[str](), [each.type for each in tokens]
    for n, kind in enumerate(kinds):
        if kind in by:
            after = n + (1 if kind == "DIFF" else 3)
            found.update(each.text for each in tokens[after : after + 1])
    return frozenset(t for t in found if (len(t) == 1 and t.isalpha()) or t in GREEK)


# ------------------------------------------------------------------ refusals

_FORMS = {
    "FRAC": r"\frac{a}{b}",
    "SQRT": r"\sqrt{a}",
    "POWER": "a^{b}",
    "INT": r"\int_{a}^{b} s \,\mathrm{d}s",
    "SUM": r"\sum_{k=1}^{n} k",
    "LIM": r"\lim_{x \to a} x",
    "BEGIN": r"\begin{cases} a & x < b \\ c & \text{otherwise} \end{cases}",
    **dict.fromkeys(("FUNC", "CIRCULAR"), r"\sin(a)"),
}
"""How what begins with a terminal is written."""
_REMAINDER = (
    "a remainder is only understood as the last term of an equation, as in + O(x^2)",
    "write the equation without it, with `as` and `order`",
)
_NEVER_READ = {
    "TEXT": (
        "the words {words!r} are not understood here",
        "write the claim as text, with numbers in the units of the file",
    ),
    **dict.fromkeys(("REST", "DOTS"), _REMAINDER),
    "UNDERSCORE": (
        "this index is not understood here",
        "declare the symbol with its index under [latex]",
    ),
    "VALUE": (
        "a value at a point, or between two, is not read",
        "write it as text, with a symbol for the value",
    ),
}
"""Terminals that no rule of the grammar takes: why not, and the remedy."""


def _unread(token: Token, stack: Sequence[Any]) -> Unclear:
    """Return the reason why a token does not fit after what is on the parser's stack."""
    known = {each.name for rule in _parser().rules for each in rule.expansion if each.is_term}
    if token.type in _NEVER_READ:
        why, remedy = _NEVER_READ[token.type]
        return Unclear(token.at, why.format(words=token.words), remedy)
    if token.type not in {"$END", *known}:
        why = f"{token.text} is neither a declared symbol nor a supported command"
        return Unclear(token.at, why, "declare it under [latex], or write the claim as text")
    why, opened = "the LaTeX cannot be read from here on", [getattr(t, "type", "") for t in stack]
    form = next((_FORMS[each] for each in reversed(opened) if each in _FORMS), "")
    remedy = f"complete it as in {form}" if form else r"put \cdot between factors"
    return Unclear(token.at, why, f"{remedy}, or write the claim as text")
