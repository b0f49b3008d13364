r"""Divide a display into statements, and tell conditions and remainders from equations.

a = b = c          a = b and a = c
a < b = c          a < b and b = c
u, v   u and v     u and v, if each has its own relation; a wide space or a row also divides them
\pm, \mp           the equation with the upper signs, then with the lower signs
u for v            u under the condition v; an inequality after an equation is also a condition
u < v, |x| < a     u < v under the condition |x| < a; other inequalities in a list are statements
u + O(s^2)         u without the remainder, which is of the order 2 as s -> 0

Nothing that is printed is dropped.  Words that are not understood remain in the statement, which
is then not read, unless they stand apart from it like a remark.
"""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from itertools import groupby

from derive.reading.lexer import (
    CONDITIONS,
    RELATIONS,
    Token,
    Unclear,
    plain,
    refusal,
    scan,
    tokens_of,
)

_MOST = 20_000
"""The largest number of characters in a display."""
_JOINTS = ("WHERE", "OR", "IMPLIES", "IFF")
"""Tokens that say how they join two entries of a display; others only divide them."""
_UNDECIDED = {
    "IFF": "equivalent statements may both be false",
    "OR": "of statements joined by `or` only one may hold",
}
"""Why statements are not read that are joined so."""


@dataclass
class Statement:
    """One statement of a display, or an entry that may still hold a chain of statements.

    tokens      left side, relation and right side
    conditions  what stands after "for", "as" or "if", and inequalities after an equation
    why         the reason why it cannot be compared; empty if it can
    order       the order of the remainder that is printed, such as 2 for O(s^2); 0 if there is none
    small       the LaTeX of the quantity in the remainder, such as s
    """

    tokens: list[Token]
    conditions: list[list[Token]] = field(default_factory=list)
    why: str = ""
    order: float = 0.0
    small: str = ""

    @property
    def relations(self) -> set[str]:
        """The relations outside all brackets."""
        return _relations(self.tokens)

    @property
    def is_rough(self) -> bool:
        """Whether it is an approximation."""
        return "ROUGH" in self.relations

    def require(self, condition: list[Token], joint: str) -> None:
        """Add a condition; those that are joined by "or" are one."""
        if self.conditions and (joint == "OR" or any(t.type == "OR" for t in self.conditions[-1])):
            link = Token(joint if joint == "OR" else "COMMA", ",", condition[0].at)
            self.conditions[-1] += [link, *condition]
        else:
            self.conditions.append(condition)


def statements(where: str, latex: str) -> list[Statement]:
    """Return all statements of a display; raise BadFormula if its brackets do not match."""
    try:
        if len(latex) > _MOST:
            raise Unclear(_MOST, f"the display has more than {_MOST} characters", "split it")
        tokens = tokens_of(latex)
    except Unclear as error:
        raise refusal(where, latex, error) from error
    chained = [each for entry in _entries(tokens) for each in _chain(entry)]
    return [signed for each in chained for signed in _signs(each)]


def remarks(latex: str) -> list[str]:
    """Return the words in a display that are neither conditions nor parts of formulas."""
    return [each.words for each in scan(latex[:_MOST]) if each.type == "TEXT"]


def _relations(tokens: Sequence[Token]) -> set[str]:
    return {each.type for each in tokens if not each.depth} & RELATIONS


def _alone(tokens: list[Token]) -> str:
    shown = plain(tokens) or "a condition"
    return f"{shown} stands without a relation, so it is unclear what it belongs to"


# ------------------------------------------------------------------ entries of a display


def _entries(tokens: Sequence[Token]) -> list[Statement]:
    """Return the entries of a display, with their conditions."""
    made = list[Statement]()
    for joint, piece in _pieces(tokens):
        last, kinds = made[-1] if made else Statement([]), _relations(piece)
        may_have = bool(last.conditions or last.relations - CONDITIONS)
        if last.relations == {"ORDER"} and _bounds_position(piece):
            may_have = not _bounds_position(last.tokens)
        if joint == "WHERE":
            made = made or [Statement([])]
            made[-1].require(piece, joint)
        elif may_have and kinds and kinds <= CONDITIONS and joint not in ("IMPLIES", "IFF"):
            last.require(piece, joint)
        elif made and not (kinds and last.relations):
            last.why = last.why or _alone(piece if last.relations else last.tokens)
            last.tokens = [*last.tokens, Token("COMMA", ",", piece[0].at), *piece]
        else:
            made.append(_with_condition(piece))
            if joint == "IMPLIES" and made[:-1] and not last.relations - CONDITIONS:
                made[-1].why = "it follows from a condition: write the condition in `require`"
            if joint in _UNDECIDED and made[:-1]:
                made[-1].why = last.why = f"{_UNDECIDED[joint]}: write, as text, the one that holds"
    return made


def _bounds_position(tokens: Sequence[Token]) -> bool:
    """Whether x or |x| is a side of an inequality, such as |x| < a or -a < x < c."""
    shown = " ".join("<" if each.type == "ORDER" else each.text for each in tokens)
    return "<" in shown and any(side.strip() in ("x", "| x |") for side in shown.split("<"))


_CODES = {
    **dict.fromkeys(("EQUAL", "ORDER", "ROUGH"), "="),
    **dict.fromkeys(("TO", "NE", "RELATED", "PROPTO"), ">"),
    **dict.fromkeys(("SIGN", "PM", "OPERATOR"), "+"),
    **dict.fromkeys((*_JOINTS, "COMMA", ";", "AND"), ","),
    **{"TEXT": "w", "LINE": "/", "ROW": "/", "GAP": " ", "&": " ", "COL": " "},
}
"""A character for each token outside brackets; it is x for all others."""
_BREAKS = [kind for kind, code in _CODES.items() if code in "/ "]
"""Rows, columns and wide spaces."""
_BEGINS = r" *[^ ,/w=>+][^,/w]*[=>]"
"""The codes of a formula with a left side of its own."""
_DIVIDES = re.compile(rf"/(?=[w ]*{_BEGINS})|(?<=[^=>+ ]) (?={_BEGINS})")
"""The code of a row or a wide space after which another statement begins."""


def begins(row: str) -> bool:
    """Whether a row of a display has its own left side and does not continue the row before it."""
    code = _code(scan(row))
    return "=" in code and re.match(rf"[w ]*{_BEGINS}", code) is not None


def _code(tokens: Sequence[Token]) -> str:
    return "".join("x" if each.depth else _CODES.get(each.type, "x") for each in tokens)


def _pieces(tokens: Sequence[Token]) -> Iterator[tuple[str, list[Token]]]:
    """Yield what stands between two tokens that divide a display, with how it is joined."""
    joint, code = "", _DIVIDES.sub(",", _code(tokens))
    for is_joint, part in groupby(zip(code, tokens, strict=True), lambda each: each[0] == ","):
        piece = [token for _, token in part]
        if is_joint:
            joint = next((each.type for each in piece if each.type in _JOINTS), "")
        else:
            yield from _without_remarks(joint, piece)


def _without_remarks(joint: str, piece: Sequence[Token]) -> Iterator[tuple[str, list[Token]]]:
    """Leave out words that stand apart; words between two formulas begin a condition."""
    kept = list[Token]()
    for n, token in enumerate(piece):
        if token.depth or token.type != "TEXT" or joint == "WHERE" or _belongs(piece, n, kept):
            kept += [token] if token.depth or token.type not in _BREAKS else []
        elif kept and any(each.type not in ("TEXT", ".", *_BREAKS) for each in piece[n + 1 :]):
            yield joint, kept
            joint, kept = "WHERE", [token]
    while kept and kept[-1].type == ".":
        kept.pop()
    if kept:
        yield joint, kept


def _belongs(piece: Sequence[Token], at: int, before: Sequence[Token]) -> bool:
    """Whether words may be a unit, or stand beside the formula without a wide space."""
    beside = [*piece[max(at - 1, 0) : at], *piece[at + 1 : at + 2]]
    is_apart = all(each.type in (*_BREAKS, "TEXT", ".") for each in beside)
    last, is_word = (*before[-1:], Token("", "", 0))[0], " " not in piece[at].words
    return not is_apart or last.type == "NUMBER" or (last.text == "}" and is_word)


def _with_condition(piece: Sequence[Token]) -> Statement:
    """Divide an entry from a condition in parentheses at its end."""
    tokens, conditions = [*piece], list[list[Token]]()
    start = max((n for n, t in enumerate(tokens) if t.text == "(" and not t.depth), default=0)
    inner = [each._replace(depth=each.depth - 1) for each in tokens[start + 1 : -1]]
    if start and tokens[-1].text == ")" and _relations(inner):
        tokens, conditions = tokens[:start], [inner]
    return Statement(tokens, conditions)


# ------------------------------------------------------------------ chains of relations


def _chain(entry: Statement) -> Iterator[Statement]:
    """Yield the statements of a chain of relations; equal sides are compared with the first."""
    cuts = [n for n, t in enumerate(entry.tokens) if not t.depth and t.type in RELATIONS]
    conditions = [one for each in entry.conditions for one in _one_sided(each)]
    if entry.why or not cuts:
        yield Statement(entry.tokens, conditions, entry.why or _alone(entry.tokens))
        return
    between = [entry.tokens[n] for n in cuts]
    ends = zip([-1, *cuts], [*cuts, len(entry.tokens)], strict=True)
    sides = [entry.tokens[start + 1 : end] for start, end in ends]
    words, first = [each for each in entry.tokens if each.type == "TEXT" and not each.depth], 0
    for n, relation in enumerate(between):
        if n and not (relation.type == "EQUAL" == between[n - 1].type):
            first = n
        left, (right, order, small) = sides[first], _without_remainder(sides[n + 1])
        is_near = {each.type for each in between[: n + 1]} <= {"EQUAL", "ROUGH"}
        if first and is_near and _without_remainder(left)[0] != left:
            left, relation = sides[0], relation._replace(type="ROUGH", text=r"\sim")
        elif relation.type == "EQUAL" and right != sides[n + 1] and not order:
            relation = relation._replace(type="ROUGH", text=r"\sim")
        elif relation.type == "ORDER":
            right, order, small = sides[n + 1], 0.0, ""
        kinds = {each.type for each in right}
        if "TEXT" not in kinds and ("LETTER" not in kinds or words != entry.tokens[-1:]):
            right = [*right, *words]  # such as the unit of a number
        why = ""
        if relation.type not in ("EQUAL", "ROUGH", "ORDER"):
            why = f"{relation.text} does not form an equation: write it as a condition or limit"
            why += " of the other claims, or the equation with = or \\sim"
        yield Statement([*left, relation, *right], conditions, why, order, small)


def _one_sided(condition: list[Token]) -> list[list[Token]]:
    r"""Write s \to 0^+ as s \to 0, s > 0."""
    kinds, text = [each.type for each in condition], " ".join(each.text for each in condition)
    end = re.search(r" [_^] (?:\{ ([+-]) \}|([+-]))$", text)
    if "TO" not in kinds or not end:
        return [condition]
    at, cut = kinds.index("TO"), len(condition) - len(end[0].split())
    sign = Token("ORDER", ">" if "+" in end[0] else "<", condition[at].at)
    return [condition[:cut], [*condition[:at], sign, *condition[at + 1 : cut]]]


_REMAINDER = re.compile(
    r"[+-] \\mathcal\{O\} \( ((?:\\[A-Za-z]+|[A-Za-z])(?: _ (?:\w|\\[A-Za-z]+|\{ [^{}]*\}))?)"
    r"(?: \^ (?:([1-9])|\{ (\d+(?:\.\d+)?)(?: / ([1-9]\d*))? \}))? \)$"
)
"""The order of a symbol, or of a power of it, as the last term."""


def _without_remainder(side: list[Token]) -> tuple[list[Token], float, str]:
    """Remove dots and O(...) for terms of higher order; return also the order and the quantity."""
    kept = list[Token]()
    for n, each in enumerate(side):
        following = side[n + 1].text if n + 1 < len(side) else ")"
        if each.type == "DOTS" and kept and kept[-1].type == "SIGN" and following in ")}]":
            kept.pop()
        else:
            kept.append(each)
    if not (found := _REMAINDER.search(" ".join(each.text for each in kept))):
        return kept, 0.0, ""
    order = float(found[2] or found[3] or 1) / float(found[4] or 1)
    return kept[: -len(found[0].split())], order, found[1].replace(" ", "")


# ------------------------------------------------------------------ two signs


def _signs(statement: Statement) -> list[Statement]:
    r"""Return both readings of \pm and \mp."""
    parts = [statement.tokens, *statement.conditions]
    if all(each.type != "PM" for part in parts for each in part):
        return [statement]
    both = ([_signed(each, plus) for each in parts] for plus in (r"\pm", r"\mp"))
    return [replace(statement, tokens=first, conditions=others) for first, *others in both]


def _signed(tokens: Sequence[Token], plus: str) -> list[Token]:
    r"""Read \pm or \mp as plus, and the other as minus; x_{1,2} is x_1 with the upper signs."""
    made = list[Token]()
    for each in tokens:
        sign = each._replace(type="SIGN", text="+" if each.text == plus else "-")
        made.append(sign if each.type == "PM" else each)
        if " ".join(t.type for t in made[-6:]) == "_ { NUMBER COMMA NUMBER }":
            made[-4:-1] = [made[-4 if plus == r"\pm" else -2]]
    return made
