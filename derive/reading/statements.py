r"""Divide a display into statements, and tell conditions and remainders from equations.

a = b = c          a = b and a = c
a < b = c          a < b and b = c
u, v   u and v     u and v, if each has its own relation; a wide space also divides them
\pm, \mp           the equation with the upper signs, then with the lower signs
u for v            u under the condition v; an inequality after an equation is also a condition
u + O(s^2)         u without the remainder, which is of the order 2 as s -> 0

Nothing that is printed is dropped.  Words that are not understood remain in the statement, which
is then not read, unless they stand apart from it like a remark.
"""

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace

from derive.command.errors import BadFormula
from derive.reading.lexer import CLAUSES, Token, Unclear, partner, plain, scan, tokens_of

_MOST = 20_000
_LONGEST = 2000
"""The largest number of characters in a display, and in an equation."""
_NEVER = {
    r"\propto": r"\propto does not give the factor: write the equation with the factor",
    r"\to": r"\to does not form an equation: write \sim, or as text, limit(f, x, end) = ...",
    r"\ll": r"\ll does not form an equation: give the limit in `as` of the other claims",
    r"\gg": r"\gg does not form an equation: give the limit in `as` of the other claims",
    r"\ne": r"\ne cannot be checked: write it as a condition of the other claims",
    r"\in": r"\in does not form an equation: add it as a condition to the other claims",
}
"""Relations that are only understood in a condition, if at all, with the reason."""
_CONDITIONS = frozenset(("ORDER", "TO", "NE", "RELATED"))
"""Relations of a condition, if they follow an equation after a comma or a wide space."""
_RELATIONS = _CONDITIONS | {"EQUAL", "ROUGH", "PROPTO"}
_JOINTS = frozenset(("OR", "IMPLIES", "IFF"))
"""Tokens between two entries of a list that are kept with the second one."""
_CUTS = _JOINTS | {"COMMA", ";", "AND", "LINE"}
_WORDS = frozenset(("AND", "OR", "WHERE", "ELSE", "TEXT"))
_JOINING = _RELATIONS | {"SIGN", "PM", "OPERATOR"}
"""Tokens after which, or before which, an expression continues."""


@dataclass(frozen=True)
class Statement:
    """One statement of a display.

    tokens     left side, relation and right side
    why        the reason why it cannot be compared; empty if it can
    is_rough   whether it is printed as an approximation
    condition  what stands after "for", "as" or "if"
    order      the order of the remainder that is printed, such as 2 for O(s^2); 0 if there is none
    small      the LaTeX of the quantity in the remainder, such as s
    """

    tokens: list[Token]
    why: str = ""
    is_rough: bool = False
    condition: list[Token] = field(default_factory=list)
    order: float = 0
    small: str = ""

    @property
    def latex(self) -> str:
        """The statement in plain LaTeX."""
        return plain(self.tokens)


@dataclass
class _Part:
    """One entry of a list: its tokens and its condition.

    why    the reason if it is not read
    joint  the token before it: a comma, "or", or an arrow
    """

    tokens: list[Token]
    condition: list[Token] = field(default_factory=list)
    why: str = ""
    joint: str = "COMMA"

    @property
    def relations(self) -> set[str]:
        """The relations outside all brackets."""
        return {each.type for each in self.tokens if not each.depth} & _RELATIONS

    def takes(self, other: "_Part") -> bool:
        """Whether an entry that follows is a condition of this one."""
        if other.joint in ("IMPLIES", "IFF") or not (self.condition or self.is_equation):
            return False
        return other.relations <= _CONDITIONS if other.relations else not other.tokens

    @property
    def is_equation(self) -> bool:
        """Whether it has a relation that does not only state a condition."""
        return bool(self.relations - _CONDITIONS)

    @property
    def is_fragment(self) -> bool:
        """Whether it has no relation."""
        return not self.why and not self.relations

    def require(self, more: Sequence[Token], joint: str = "COMMA") -> None:
        """Add a condition."""
        if self.condition and more:
            self.condition.append(more[0]._replace(type=joint, text=_JOINT_TEXT[joint], depth=0))
        self.condition += more


_JOINT_TEXT = {"COMMA": ",", "OR": r"\or", "IMPLIES": r"\implies", "IFF": r"\iff"}


def statements(where: str, latex: str) -> list[Statement]:
    """Return all statements of a display; raise BadFormula if its brackets do not match."""
    if len(latex) > _MOST:
        why = f"the display has more than {_MOST} characters"
        raise BadFormula(where, latex[:80], 80, why, "split it")
    try:
        tokens = tokens_of(latex)
    except Unclear as error:
        given = latex[error.at : error.at + 80]
        raise BadFormula(where, given, 0, error.why, error.remedy) from error
    for each in tokens:
        if each.type == "FRAME":
            why = f"{each.text} inside a display is not supported: write it as text"
            return [Statement(tokens, why)]
    parts = list[_Part]()
    for part in map(_divided, _listed(tokens)):
        if parts and parts[-1].takes(part):
            parts[-1].require(part.tokens, part.joint)
            parts[-1].require(part.condition, "COMMA" if part.tokens else part.joint)
        elif part.tokens or part.condition:
            if part.joint == "IMPLIES" and parts and not parts[-1].is_equation:
                part.why = "it follows from a condition: write the condition in `require`"
            if part.joint == "IFF" and parts:
                why = "equivalent statements may both be false: write, as text, the one that holds"
                part.why = parts[-1].why = why
            parts.append(part)
    found = [each for part in _with_fragments(parts) for each in _chain(part)]
    return [signed for each in found for signed in _signs(each)]


def remarks(latex: str) -> list[str]:
    """Return the words in a display that are neither conditions nor parts of formulas."""
    return [each.words for each in scan(latex[:_MOST]) if each.type == "TEXT"]


def _listed(tokens: list[Token]) -> list[list[Token]]:
    """Divide a list; a row without a relation, or with a sign first, continues the one before."""
    parts: list[list[Token]] = [[]]
    for n, token in enumerate(tokens):
        if token.depth or token.type not in _CUTS | {"GAP"}:
            parts[-1].append(token)
        elif token.type != "GAP":
            parts.append([token] if token.type in _JOINTS | {"LINE"} else [])
        elif _is_whole(parts[-1]) and _begins(tokens[n + 1 :]):
            parts.append([])
        else:
            parts[-1].append(token)
    rows = list[list[Token]]()
    for part in parts:
        is_row = bool(part) and part[0].type == "LINE"
        inside = _trimmed(part[is_row:])
        goes_on = inside and (
            inside[0].type in _RELATIONS | {"SIGN"} or not _Part(inside).relations
        )
        if is_row and goes_on and rows:
            rows[-1] += inside
        elif inside and [each.text for each in inside] != ["."]:
            rows.append(inside)
    return [row[:-1] if row[-1].text == "." else row for row in rows]


def _trimmed(part: list[Token]) -> list[Token]:
    """Remove wide spaces at both ends."""
    while part and part[0].type == "GAP":
        part = part[1:]
    while part and part[-1].type == "GAP":
        part = part[:-1]
    return part


def _without_gaps(part: Iterable[Token]) -> list[Token]:
    return [each for each in part if each.type != "GAP"]


def _is_whole(part: list[Token]) -> bool:
    """Whether a part has a relation and a right side that may end here."""
    inside = _without_gaps(part)
    return bool(_Part(inside).relations) and inside[-1].type not in _JOINING | _WORDS - {"TEXT"}


def _begins(tokens: list[Token]) -> bool:
    """Whether tokens begin with a relation that has a left side of its own."""
    seen = False
    for each in _without_gaps(tokens):
        if not each.depth:
            if each.type in _RELATIONS:
                return seen
            if each.type in _CUTS | _WORDS or (each.type in _JOINING and not seen):
                return False
        seen = True
    return False


def _with_fragments(parts: list[_Part]) -> list[_Part]:
    """Join entries without a relation to their neighbours, which are then not read."""
    made = list[_Part]()
    for part in parts:
        if made and (part.is_fragment or made[-1].is_fragment):
            alone = made[-1] if made[-1].is_fragment else part
            made[-1].why = made[-1].why or _unclear(alone.tokens)
            made[-1].tokens = [*made[-1].tokens, Token("COMMA", ",", 0), *part.tokens]
            made[-1].require(part.condition)
        else:
            made.append(part)
    return made


def _unclear(tokens: list[Token]) -> str:
    shown = plain(tokens) or "a condition"
    return f"{shown} stands without a relation, so it is unclear what it belongs to"


def _divided(part: list[Token]) -> _Part:
    """Divide an entry into its formula and the condition after the first word."""
    joint = part[0].type if part[0].type in _JOINTS else "COMMA"
    part = _trimmed(part[part[0].type == joint :])
    under = [each for each in part if each.type.startswith("UNDER ")]
    part = [each for each in part if not each.type.startswith("UNDER ")]
    while part and part[0].type == "TEXT" and _is_remark(part[0].words, part[1:2]):
        part = _trimmed(part[1:])
    at = next((n for n, t in enumerate(part) if not t.depth and t.type in _WORDS), len(part))
    body, rest = part[:at], part[at:]
    if rest and rest[0].type == "TEXT":
        if not body or _may_be_unit(body, rest[0].words):
            return _Part(_without_gaps(part), joint=joint)
        after = next((n for n, t in enumerate(rest) if t.type not in ("TEXT", "GAP")), len(rest))
        rest = rest[after:] if rest[after:] == [] or rest[after].type in _WORDS else rest
    made = _Part(_without_gaps(body), joint=joint)
    if body and body[-1].text == ")":
        start = max(n for n, t in enumerate(made.tokens) if t.text == "(" and not t.depth)
        inner = [each._replace(depth=each.depth - 1) for each in made.tokens[start + 1 : -1]]
        if _Part(inner).relations:
            made = _Part(made.tokens[:start], inner, joint=joint)
    rest = rest[1:] if rest and rest[0].type == "WHERE" else rest
    made.require(
        [
            each._replace(type="COMMA", text=",") if each.type == "WHERE" else each
            for each in _without_gaps(rest)
        ]
    )
    made.require([each._replace(type=each.type.removeprefix("UNDER ")) for each in under])
    return made


def _is_remark(words: str, after: list[Token]) -> bool:
    """Whether words before a formula stand apart from it; a single word may be an operator."""
    return words.endswith(":") or " " in words or [each.type for each in after] in ([], ["GAP"])


def _may_be_unit(body: list[Token], words: str) -> bool:
    """Whether the words after a formula may be a unit or another part of it."""
    if words.startswith("(") or words.split()[0].lower() in CLAUSES:
        return False
    last = _without_gaps(body)[-1:]
    if last and last[0].type == "NUMBER":
        return True
    return " " not in words and (body[-1].type != "GAP" or (bool(last) and last[0].text == "}"))


def _chain(part: _Part) -> list[Statement]:
    """Return the statements of a chain of relations; equal sides are compared with the first."""
    if part.why or not part.relations:
        why = part.why or _unclear(part.tokens)
        return [Statement(part.tokens or part.condition, why, condition=part.condition)]
    cuts = [n for n, t in enumerate(part.tokens) if not t.depth and t.type in _RELATIONS]
    between = [part.tokens[n] for n in cuts]
    ends = zip([-1, *cuts], [*cuts, len(part.tokens)], strict=True)
    sides = [part.tokens[start + 1 : end] for start, end in ends]
    found, first = list[Statement](), 0
    for n, relation in enumerate(between):
        if n and not (relation.type == "EQUAL" == between[n - 1].type):
            first = n
        rough = relation.type == "ROUGH"
        left, (right, rest) = sides[first], _without_rest(sides[n + 1])
        if first and _without_rest(left)[0] != left:
            left = sides[0]
            rough = rough or any(each.type == "ROUGH" for each in between[:n])
        if rest == _DOTS and relation.type == "EQUAL":
            rough = True
        why = _fault(relation, left, right, rest) or _of_example(right, part.tokens)
        sign = relation._replace(type="ROUGH", text=r"\sim") if rough else relation
        made = Statement([*left, sign, *right], why, rough)
        found.append(_with_rest(made, rest, _from_one_side(part.condition)))
    return found


_DOTS = [Token("DOTS", r"\dots", 0)]


def _fault(relation: Token, left: list[Token], right: list[Token], rest: list[Token]) -> str:
    """Return the reason why a relation between two sides cannot be compared."""
    kinds, count = {each.type for each in (*left, *right)}, len(plain([*left, *right]))
    if count > _LONGEST:
        why = f"the equation has {count} characters, and at most {_LONGEST} are read"
        return f"{why}: split the equation, or shorten it with new symbols"
    if relation.text in _NEVER:
        return _NEVER[relation.text]
    if "REST" in kinds:
        return (
            "a remainder O(...) is only understood as the last term: write the equation without it"
        )
    if not left or not right:
        side = "right" if left else "left"
        return f"there is nothing to the {side} of {relation.text}: write both sides"
    if "SMALLER" in kinds:
        return "a remainder o(...) has no order: write the equation with \\sim and its limit"
    if rest and relation.type == "ORDER":
        return "an inequality with a remainder cannot be checked: write it without the remainder"
    return ""


def _from_one_side(condition: list[Token]) -> list[Token]:
    r"""Write s \to 0^+ as s \to 0, s > 0."""
    made = list[Token]()
    for part in separate(condition):
        found = re.search(r" [_^] ?(\{ ?)?([+-])( ?\})?$", f"{' '.join(t.text for t in part)}")
        kinds = [each.type for each in part]
        if made:
            made.append(Token("COMMA", ",", part[0].at))
        if "TO" not in kinds or not found:
            made += part
            continue
        at, part = kinds.index("TO"), part[: -len(found[0].split())]
        sign = Token("ORDER", ">" if found[2] == "+" else "<", part[at].at)
        made += [*part, Token("COMMA", ",", part[at].at), *part[:at], sign, *part[at + 1 :]]
    return made


def separate(condition: list[Token]) -> list[list[Token]]:
    """Divide a condition into those that must all hold."""
    if any(each.type == "OR" for each in condition):
        return [condition]
    parts: list[list[Token]] = [[]]
    for each in condition:
        if not each.depth and each.type in ("COMMA", ";", ".", "AND"):
            parts.append([])
        else:
            parts[-1].append(each)
    return [part for part in parts if part]


def _of_example(side: list[Token], chain: list[Token]) -> str:
    """Return the reason why numbers in a chain with a unit cannot be compared."""
    words = chain[-1].words if chain[-1].type == "TEXT" else ""
    if not words or any(each.type in ("TEXT", "LETTER") for each in side):
        return ""
    return f"numbers with the words {words!r} are an example: write them as text, without symbols"


def _with_rest(made: Statement, rest: list[Token], condition: list[Token]) -> Statement:
    """Add the condition, and the quantity and order of a printed remainder."""
    if made.why or not rest or rest == _DOTS:
        return replace(made, condition=condition)
    size = _SIZE.fullmatch("".join(each.text for each in rest))
    if size is None:
        why = f"the remainder of order {plain(rest)} is not understood: write the equation "
        return replace(made, why=f"{why}without it, with as = '...' and order = ...")
    over, _, under = (size[2] or size[3] or "1").partition("/")
    order = float(over) / float(under or 1)
    return replace(made, condition=condition, order=order, small=size[1])


_SIZE = re.compile(
    r"((?:\\[A-Za-z]+|[A-Za-z])(?:_(?:\w|\\[A-Za-z]+|\{[^{}]*\}))?)"
    r"(?:\^(?:([1-9])|\{(\d+(?:\.\d+)?(?:/[1-9]\d*)?)\}))?"
)
"""A symbol, or a power of it."""


def _without_rest(side: list[Token]) -> tuple[list[Token], list[Token]]:
    """Remove dots and O(...) for terms of higher order; return also what the O(...) holds."""
    kept = list[Token]()
    for n, each in enumerate(side):
        following = side[n + 1].text if n + 1 < len(side) else ")"
        if each.type == "DOTS" and kept and kept[-1].type == "SIGN" and following in ")}]":
            kept.pop()
        else:
            kept.append(each)
    if len(kept) < len(side):
        return kept, _DOTS
    at = next((n for n, t in enumerate(side) if t.type == "REST" and not t.depth), 0)
    if at and partner(side, at + 1) == len(side) - 1:
        return side[: at - 1], side[at + 2 : -1]
    return side, []


def _signs(statement: Statement) -> list[Statement]:
    r"""Return both readings of \pm and \mp; x_{1,2} is x_1 with the upper signs."""
    if all(each.type != "PM" for each in (*statement.tokens, *statement.condition)):
        return [statement]
    return [
        replace(
            statement,
            tokens=_signed(statement.tokens, upper),
            condition=_signed(statement.condition, upper),
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
        if [t.type for t in made[-5:]] == ["{", "NUMBER", "COMMA", "NUMBER", "}"] and made[
            -6:-5
        ] == [t for t in made[-6:-5] if t.text == "_"]:
            made[-4:-1] = [made[-4] if upper else made[-2]]
    return made


_BEFORE = _RELATIONS | {"{", "(", "[", "COMMA"}
"""Tokens after which a plus sign says nothing."""
