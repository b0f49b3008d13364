r"""Divide a display into statements, and tell conditions and remainders from equations.

a = b = c          a = b and a = c
a < b = c          a < b and b = c
u, v   u and v     u and v, if each has its own relation; a wide space also divides them
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
from itertools import dropwhile, takewhile

from derive.reading.lexer import (
    CLAUSES,
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
_JOINING = RELATIONS | {"SIGN", "PM", "OPERATOR"}
"""Tokens after which, or before which, an expression continues."""
_CUTS = {
    **dict.fromkeys(("COMMA", ";", "AND"), "COMMA"),
    **dict.fromkeys(("WHERE", "ELSE"), "WHERE"),
    **{each: each for each in ("OR", "IMPLIES", "IFF")},
}
"""Tokens that stand between two entries of a display, and how they join them."""


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
            if joint == "IFF" and made[:-1]:
                why = "equivalent statements may both be false: write, as text, the one that holds"
                made[-1].why = last.why = why
    return made


def _bounds_position(tokens: Sequence[Token]) -> bool:
    """Whether x or |x| is a side of an inequality, such as |x| < a or -a < x < c."""
    shown = " ".join("<" if each.type == "ORDER" else each.text for each in tokens)
    return "<" in shown and any(side.strip() in ("x", "| x |") for side in shown.split("<"))


def _pieces(tokens: Sequence[Token]) -> Iterator[tuple[str, list[Token]]]:
    """Yield what stands between two tokens that divide a display, with how it is joined."""
    joint, piece = "COMMA", list[Token]()
    for n, token in enumerate(tokens):
        cut, kept = _place(token, joint, piece, tokens[n - 1 : n], tokens[n + 1 :])
        if cut and piece:
            yield joint, piece
            joint, piece = "COMMA", []
        if cut and joint == "COMMA":
            joint = cut
        if kept:
            piece = [*piece, token]
    if piece:
        yield joint, piece


def _place(
    token: Token,
    joint: str,
    piece: Sequence[Token],
    before: Sequence[Token],
    rest: Sequence[Token],
) -> tuple[str, bool]:
    """Return how a token joins the pieces that it divides, if it does, and whether it is kept."""
    kind = token.type
    if kind == "GAP":
        is_whole = bool(_relations(piece)) and piece[-1].type not in _JOINING
        return "COMMA" * (is_whole and not token.depth and _begins(rest)), False
    if kind == "LINE":  # a row without a relation, or with a sign first, continues the one before
        after = list(dropwhile(lambda t: t.type in ("TEXT", "GAP"), rest))
        return "COMMA" * _begins(after), False
    if token.depth or kind not in (*_CUTS, "TEXT", "."):
        return "", True
    if kind in _CUTS:
        return _CUTS[kind], kind == "ELSE"
    if kind == ".":
        return "", not _ends(rest)
    if joint == "WHERE":
        return "", True
    if not piece:
        stands_apart = token.words.endswith(":") or " " in token.words
        return "", not (stands_apart or not rest or rest[0].type in (*_CUTS, "GAP", "LINE"))
    if _may_be_unit(piece[-1], before[0], token.words):
        return "", True
    return ("", False) if _ends(rest) else ("WHERE", True)


def _begins(tokens: Sequence[Token]) -> bool:
    """Whether tokens begin with a relation that has a left side of its own."""
    ends = (*_CUTS, "LINE", "TEXT")
    ahead = list(takewhile(lambda t: t.depth or t.type not in ends, tokens))
    first = next((each.type for each in ahead if each.type != "GAP"), "")
    return bool(_relations(ahead)) and first not in _JOINING


def _ends(rest: Sequence[Token]) -> bool:
    """Whether an entry ends before these tokens, apart from words."""
    after = list(dropwhile(lambda t: t.type in ("TEXT", "GAP"), rest))
    is_cut = not after or after[0].type in (*_CUTS, "LINE")
    return is_cut or (
        len(after) < len(rest) and rest[-len(after) - 1].type == "GAP" and _begins(after)
    )


def _may_be_unit(last: Token, before: Token, words: str) -> bool:
    """Whether the words after a formula may be a unit or another part of it."""
    if words.startswith("(") or words.split()[0].lower() in CLAUSES:
        return False
    return last.type == "NUMBER" or (
        " " not in words and (before.type != "GAP" or last.text == "}")
    )


def _with_condition(piece: list[Token]) -> Statement:
    """Divide an entry from a condition in parentheses at its end, or below its relation."""
    under = [
        each._replace(type=each.type.removeprefix("UNDER "))
        for each in piece
        if each.type.startswith("UNDER ")
    ]
    made = Statement([each for each in piece if not each.type.startswith("UNDER ")])
    start = max((n for n, t in enumerate(made.tokens) if t.text == "(" and not t.depth), default=0)
    if start and made.tokens[-1].text == ")":
        inner = [each._replace(depth=each.depth - 1) for each in made.tokens[start + 1 : -1]]
        if _relations(inner):
            made = Statement(made.tokens[:start], [inner])
    return replace(made, conditions=[*made.conditions, *([under] if under else [])])


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
    words, first = [each for each in entry.tokens[-1:] if each.type == "TEXT"], 0
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
        if not any(each.type in ("TEXT", "LETTER") for each in right):
            right = [*right, *words]  # numbers with a unit are an example
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
    r"\( ((?:\\[A-Za-z]+|[A-Za-z])(?: _ (?:\w|\\[A-Za-z]+|\{ [^{}]*\}))?)"
    r"(?: \^ (?:([1-9])|\{ (\d+(?:\.\d+)?)(?: / ([1-9]\d*))? \}))? \)"
)
"""A symbol, or a power of it, in parentheses."""


def _without_remainder(side: list[Token]) -> tuple[list[Token], float, str]:
    """Remove dots and O(...) for terms of higher order; return also the order and the quantity."""
    kept = list[Token]()
    for n, each in enumerate(side):
        following = side[n + 1].text if n + 1 < len(side) else ")"
        if each.type == "DOTS" and kept and kept[-1].type == "SIGN" and following in ")}]":
            kept.pop()
        else:
            kept.append(each)
    at = next(
        (n for n, each in enumerate(kept) if each.text == r"\mathcal{O}" and not each.depth), 0
    )
    found = _REMAINDER.fullmatch(" ".join(each.text for each in kept[at + 1 :])) if at else None
    if not found or kept[at - 1].type != "SIGN":
        return kept, 0.0, ""
    order = float(found[2] or found[3] or 1) / float(found[4] or 1)
    return kept[: at - 1], order, found[1].replace(" ", "")


# ------------------------------------------------------------------ two signs


def _signs(statement: Statement) -> list[Statement]:
    r"""Return both readings of \pm and \mp; x_{1,2} is x_1 with the upper signs."""
    if all(t.type != "PM" for part in (statement.tokens, *statement.conditions) for t in part):
        return [statement]
    return [
        replace(
            statement,
            tokens=_signed(statement.tokens, upper),
            conditions=[_signed(each, upper) for each in statement.conditions],
        )
        for upper in (True, False)
    ]


def _signed(tokens: list[Token], upper: bool) -> list[Token]:
    made = list[Token]()
    for n, each in enumerate(tokens):
        follows = tokens[n + 1].text if n + 1 < len(tokens) else ""
        if each.type == "PM":
            each = each._replace(type="SIGN", text="+" if (each.text == r"\pm") == upper else "-")
        if each.text == "+" and follows != "}" and (not made or made[-1].type in _BEFORE):
            continue
        made.append(each)
        if " ".join(t.type for t in made[-6:]) == "_ { NUMBER COMMA NUMBER }":
            made[-4:-1] = [made[-4] if upper else made[-2]]
    return made


_BEFORE = RELATIONS | {"{", "(", "[", "COMMA"}
"""Tokens after which a plus sign says nothing."""
