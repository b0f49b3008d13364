r"""Split a display into statements: layout commands are dropped, chains and lists are divided.

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
from collections.abc import Iterator
from dataclasses import dataclass, replace

from derive.command.errors import BadFormula
from derive.reading.spellings import GREEK
from derive.reading.words import COMMANDS

_MOST = 20_000
"""The largest number of characters in a display."""
_DEEPEST = 60
_TOKEN = re.compile(
    r"\\(?:begin|end)\s*\{[A-Za-z]+\*?\}|\\(?:text|under)\{[^{}]*\}|\\[A-Za-z]+|\\."
    r"|[0-9]+(?:\.[0-9]+)?|\s+|.",
    re.DOTALL,
)
_DROPPED = (
    r"\\(?:label|tag\*?|hspace\*?|vspace\*?|mathstrut|phantom)\s*\{[^{}]*\}"
    r"|\\(?:nonumber|notag|displaystyle|textstyle|limits|boxed|[bB]igg?[lrm]?)(?![A-Za-z])"
    r"|\\(?:left|right)\s*\.|\\(?:left|right)(?![A-Za-z])|\\[,;:! >]|~"
)
_FONTS = "text|mbox|hbox|textnormal|mathrm|textrm|textit|mathit|operatorname|mathbf|textsf|mathsf"
_WORDS = re.compile(rf"\\({_FONTS})\*?\s*(?:\{{([^{{}}]*)\}}|(?<=\s)([A-Za-z]))")
_ROMAN = re.compile(r"\{\s*\\(?:(?:rm|it|bf|sf)(?![A-Za-z])\s*([^{}\\]*)|mathrm\s+([A-Za-z])\s*)\}")
_MIXED = re.compile(r"\\(?:text|mbox|hbox|textrm|textnormal)\s*(?=\{)")
_CASES = re.compile(
    r"(?:\\left\s*\\\{\s*)?\\begin\s*\{(cases|dcases|rcases|array)\}(?:\s*\{[^{}]*\})?"
    r"((?:(?!\\begin).)*?)\\end\s*\{\1\}(?:\s*\\right\s*\.)?",
    re.DOTALL,
)
_SYSTEM = re.compile(
    r"((?:\s|\\label\s*\{[^{}]*\}|\{?\\displaystyle)*)(?:(?:\\left)?\s*\\\{)?"
    r"\s*\\begin\s*\{(array|cases|dcases|aligned|gathered)\}(?:\s*\{[^{}]*\})?"
    r"((?:(?!\\begin).)*?)\\end\s*\{\2\}(?:\s*\\right\s*\.)?([\s.,;}]*(?:\\label\s*\{[^{}]*\})?\s*)",
    re.DOTALL,
)
"""An array with nothing printed before or after it: its rows are statements."""
_SPLIT = re.compile(r"\\begin\s*\{(split|aligned|gathered|alignedat)\}(?:\s*\{\d+\})?")
_UNDER = re.compile(
    r"\\(?:underset|overset|stackrel)\s*\{([^{}]*\\(?:to|rightarrow)(?![A-Za-z])[^{}]*)\}"
    r"\s*\{?\s*(\\(?:sim|simeq|approx|cong)(?![A-Za-z])|=)\s*\}?"
)
_DECIMAL_COMMA = re.compile(r"(?<![\d.])(0|\d+(?=\{,\}(?!\d{3}(?!\d))))\{,\}(\d+)")
"""A decimal comma.  Before three digits it may also separate thousands, unless 0 precedes it."""
_ALIKE = {
    r"\lvert": "|",
    r"\rvert": "|",
    r"\vert": "|",
    r"\{": "(",
    r"\}": ")",
    r"\lbrace": "(",
    r"\rbrace": ")",
    r"\cfrac": r"\frac",
    r"\leqslant": r"\le",
    r"\geqslant": r"\ge",
    r"\prime": "'",
    r"\fint": r"\pvint",
    r"\dashint": r"\pvint",
    r"\rightarrow": r"\to",
    r"\longrightarrow": r"\to",
    r"\quad": r"\gap",
    r"\qquad": r"\gap",
    "&": r"\gap",
    r"\coloneqq": "=",
    r"\triangleq": "=",
    r"\neq": r"\ne",
    r"\not=": r"\ne",
    r"\therefore": r"\andword",
    **dict.fromkeys((r"\Rightarrow", r"\Longrightarrow"), r"\implies"),
    **dict.fromkeys((r"\Leftrightarrow", r"\Longleftrightarrow"), r"\iff"),
}
_IMPLIES, _EQUIVALENT = r"\implies", r"\iff"
_JOINTS = (r"\orword", _IMPLIES, _EQUIVALENT)
"""Tokens between two entries of a list that are kept with the second one."""
_STARS = frozenset((r"\ast", r"\star"))
_PRINCIPAL = frozenset(("pv", "p.v", "p. v", "cpv"))
_ROUGHLY = frozenset((r"\sim", r"\simeq", r"\approx", r"\cong"))
_NEVER = {
    r"\propto": r"\propto does not give the factor: write the equation with the factor",
    r"\to": r"\to does not form an equation: write \sim, or as text, limit(f, x, end) = ...",
    r"\ll": r"\ll does not form an equation: give the limit in `as` of the other claims",
    r"\gg": r"\gg does not form an equation: give the limit in `as` of the other claims",
    r"\ne": r"\ne cannot be checked: write it as a condition of the other claims",
    r"\in": r"\in does not form an equation: add it as a condition to the other claims",
}
"""Relations that are only understood in a condition, if at all, with the reason."""
_ORDERED = frozenset(("<", ">", r"\le", r"\leq", r"\ge", r"\geq"))
_RELATIONS = frozenset(("=", r"\equiv")) | _ORDERED | _ROUGHLY | _NEVER.keys()
_CONDITIONS = _ORDERED | _NEVER.keys() - {r"\propto"}
"""Relations of a condition, if they follow an equation after a comma or a wide space."""
_AND = frozenset(("and", "so that", "with", "hence", "thus", "therefore", "i.e", "where"))
_OR = frozenset(("or", "or else"))
_WHERE = frozenset(
    ("for", "for all", "for any", "for every", "if", "when", "whenever", "where", "as", "at", "in")
) | {"on", "provided", "provided that", "while", "as long as", "in the limit", "valid for"}
_ELSE = frozenset(("otherwise", "else", "elsewhere"))
_AS_COMMANDS = {
    **{name: command for command, name in COMMANDS.items() if name.islower()},
    **{command[1:]: command for command in COMMANDS if command.islower()},
    **{f"arc{name}": rf"\ar{name}" for name in ("sinh", "cosh", "tanh")},
    **{"cot": r"\cot", "d": r"\dd", "e": r"\euler"},
}
"""Functions and constants whose name is printed upright."""
_UNITS = frozenset("gmsJNW")
"""Units of one letter.  K may be an elliptic integral."""
_OPERATOR = r"\derivativeof"
_REMAINDER, _SMALLER = r"\bigo", r"\smallo"
_FRACTIONS = (r"\frac", r"\dfrac", r"\tfrac")
_OPENING, _CLOSING = frozenset(("(", "{", "[", r"\begin{cases}")), frozenset(")}]")
_CLOSED = _CLOSING | {r"\end{cases}"}
_JOINING = frozenset(("+", "-", "/", "*", r"\cdot", r"\times", r"\pm", r"\mp")) | _RELATIONS
"""Tokens after which, or before which, an expression continues."""


@dataclass(frozen=True)
class Statement:
    """One statement of a display.

    latex      left side, relation and right side in plain LaTeX
    why        the reason why it cannot be compared; empty if it can
    is_rough   whether it is printed as an approximation
    condition  the LaTeX after "for", "as" or "if"; empty if there is no condition
    order      the order of the remainder that is printed, such as 2 for O(s^2); 0 if there is none
    small      the LaTeX of the quantity in the remainder, such as s
    """

    latex: str
    why: str = ""
    is_rough: bool = False
    condition: str = ""
    order: float = 0
    small: str = ""


def statements(where: str, latex: str) -> list[Statement]:
    """Return all statements of a display; raise BadFormula if its brackets do not match."""
    if len(latex) > _MOST:
        why = f"the display has more than {_MOST} characters"
        raise BadFormula(where, latex[:80], 80, why, "split it")
    tokens = _differentials(_derivatives(_over(_bare(_tokens(_plain(latex))))))
    depths = _depths(where, tokens)
    if inner := next((t for t in tokens if t.startswith(r"\begin") and t not in _OPENING), ""):
        return [Statement(latex, f"{inner} inside a display is not supported: write it as text")]
    if _OPERATOR in tokens:
        why = "d/dx before its operand is not supported: write it as text, diff(f, x)"
        return [Statement(latex, why)]
    parts = list[_Part]()
    for row in _listed(tokens, depths):
        part = _divided(row)
        if parts and parts[-1].takes(part):
            more = [*part.tokens, *([","] if part.tokens and part.condition else [])]
            parts[-1].require([*more, *part.condition], part.joint)
        elif part.tokens or part.condition:
            if part.joint == _IMPLIES and parts and not parts[-1].is_equation():
                part.why = "it follows from a condition: write the condition in `require`"
            if part.joint == _EQUIVALENT and parts:
                why = "equivalent statements may both be false: write, as text, the one that holds"
                part.why = parts[-1].why = why
            parts.append(part)
    parts = _with_fragments(parts)
    collected = [each for part in parts for each in _chain(part)]
    return [signed for each in collected for signed in _signs(each)]


def remarks(latex: str) -> list[str]:
    """Return the words in a display that are neither conditions nor parts of formulas."""
    return [t[6:-1] for t in _tokens(_plain(latex[:_MOST])) if t.startswith(r"\text{")]


def _plain(latex: str) -> str:
    """Remove layout commands from the text, and replace words by commands."""
    text = re.sub(r"\\l?eqno(?![A-Za-z]).*$", " ", latex, flags=re.DOTALL)
    text = re.sub(r"\s+", " ", text)
    text = re.sub(r"\\(left|right)\s*([{}])", r"\\\1\\\2", text)
    text = re.sub(r"(?:(?:~|\\[;:, >])\s*){2,}", r" \\quad ", text)
    text = _DECIMAL_COMMA.sub(r"\1.\2", text)
    if system := _SYSTEM.fullmatch(text):
        text = system[1] + system[3] + system[4]
    text = _CASES.sub(_marked_cases, text)
    for kind in _SPLIT.findall(text):
        text = text.replace(rf"\end{{{kind}}}", " ")
    text = _SPLIT.sub(" ", text)
    text = re.sub(r"(?<!\\)\\\\\*?(?:\[[^\]]*\])?", " \n ", text)
    text = re.sub(r"-(?:\s|\\!|\{\})*\\int(?![A-Za-z])", _dashed, text)
    text = re.sub(r"\\(?:mathcal|mathscr)\s*(?:\{\s*O\s*\}|O)", r"\\bigo ", text)
    text = re.sub(r"\\stackrel\s*\{\s*\\\w+\s*\{?\s*def\.?\s*\}?\s*\}\s*\{\s*=\s*\}", "=", text)
    text = _UNDER.sub(r"\2 \\under{\1} ", text)
    text = _ROMAN.sub(r"\\mathrm{\1\2}", text)
    text = re.sub(rf"(?<![_^])(?<![_^] )\{{\s*(\\(?:{_FONTS})\s*\{{[^{{}}]*\}})\s*\}}", r"\1", text)
    text = _WORDS.sub(_word, _unmixed(text))
    text = re.sub(r"\\not\s*=", r"\\ne ", text)
    text = re.sub(_DROPPED, " ", text)
    return re.sub(r":\s*=", "=", text)


def _marked_cases(match: re.Match[str]) -> str:
    if match[1] == "array" and r"\{" not in match[0].partition(r"\begin")[0]:
        return match[0]
    rows = re.sub(r"(?<!\\)\\\\(?:\[[^\]]*\])?", r" \\caserow ", match[2])
    cells = re.sub(r"(?<!\\)&", r" \\casecol ", rows)
    return rf"\begin{{cases}}{cells}\end{{cases}}"


def _dashed(match: re.Match[str]) -> str:
    r"""Read -\!\!\!\int as a principal value, but keep an ordinary minus before an integral."""
    return r"\pvint" if r"\!" in match[0] else match[0]


def _unmixed(text: str) -> str:
    r"""Write \text{for $x > 0$} as \text{for} x > 0."""
    made, position = "", 0
    while match := _MIXED.search(text, position):
        end = _closing(text, match.end())
        inner = text[match.end() + 1 : end - 1]
        made += text[position : match.start()]
        if "$" in inner:
            for n, part in enumerate(re.split(r"(?<!\\)\$", inner)):
                made += f" {part} " if n % 2 else rf"\text{{{part}}}" if part.strip() else ""
        else:
            made += text[match.start() : end]
        position = end
    return made + text[position:]


def _closing(text: str, start: int) -> int:
    """Return the end of the braced group that starts at `start`."""
    depth = 0
    for match in re.finditer(r"(?<!\\)[{}]", text[start:]):
        depth += 1 if match[0] == "{" else -1
        if depth == 0:
            return start + match.end()
    return len(text)


def _word(match: re.Match[str]) -> str:
    inner = (match[2] if match[2] is not None else match[3]).strip()
    before = match.string[: match.start()].rstrip()
    if before.endswith(("_", "^")):
        return f"{{{inner}}}"
    if re.search(r"[_^]\s*\{[^{}]*$", before):
        return inner
    if inner in _AS_COMMANDS and match[1] not in ("mathit", "textit", "mathbf"):
        return f"{_AS_COMMANDS[inner]} "
    if inner.lower().strip(" .") in _PRINCIPAL:
        return r"\pvword "
    if inner in _UNITS and re.search(r"\d\}?(?:\s|~|\\[,;:! ])*$", before):
        return rf" \text{{{inner}}} "
    if len(inner) <= 1 or not any(map(str.isalpha, inner)):
        return f" {inner} "
    word = " ".join(re.sub(r"\\(?:[,;:! ]|$)|~", " ", inner).split()).strip(" ,.;")
    lower = word.lower().strip(" :")
    for known, command in ((_AND, "and"), (_OR, "or"), (_WHERE, "where"), (_ELSE, "else")):
        if lower in known:
            return rf" \{command}word "
    return rf" \text{{{word}}} "


def _tokens(text: str) -> list[str]:
    tokens = [t for t in _TOKEN.findall(text) if "\n" in t or not t.isspace()]
    cleaned = ["\n" if t.isspace() else _token(t) for t in tokens]
    for index, token in enumerate(cleaned[:-1]):
        after = cleaned[index + 1]
        if token == r"\pvword" and after == r"\int":
            cleaned[index + 1] = r"\pvint"
        if token in _STARS and _is_raised(cleaned, index):
            cleaned[index] = "*"
        if token in ("O", "o") and after == "(" and cleaned[index - 1 : index] in (["+"], ["-"]):
            cleaned[index] = _REMAINDER if token == "O" else _SMALLER
    ends = (r"\caserow", r"\casecol", r"\end{cases}")
    return [
        token
        for n, token in enumerate(cleaned)
        if token != r"\pvword"
        and not (token in (",", ".", ";") and cleaned[n + 1 : n + 2] in [[end] for end in ends])
    ]


def _token(token: str) -> str:
    words = token.startswith((r"\text{", r"\under{"))
    return token if words else _ALIKE.get(token, re.sub(r"\s", "", token))


def _is_raised(tokens: list[str], at: int) -> bool:
    """Whether a token is an exponent or an index, alone or in braces."""
    before = tokens[max(at - 2, 0) : at]
    return before[-1:] in (["^"], ["_"]) or (before[-1:] == ["{"] and before[0] in ("^", "_"))


def _bare(tokens: list[str]) -> list[str]:
    """Remove braces that enclose all tokens."""
    while tokens[:1] == ["{"] and _end(tokens, 0, 1) == len(tokens) - 1:
        tokens = tokens[1:-1]
    return tokens


def _derivatives(tokens: list[str]) -> list[str]:
    r"""Write \frac{d P}{d a} and dP/da as \frac{\dd P}{\dd a}, and mark a separate d/dx."""
    made, differentials = list[str](), (["d"], [r"\dd"])
    for token in tokens:
        made.append(token)
        start = len(made) - 5
        if start >= 0 and made[start + 2] == "/" and _may_be_variable(token):
            over, under = made[start : start + 1], made[start + 3 : start + 4]
            if over in differentials and under in differentials:
                frac = [r"\frac", "{", r"\dd", made[start + 1], "}", "{", r"\dd", token, "}"]
                made[start:] = frac
    for index, token in enumerate(made):
        if token not in _FRACTIONS or made[index + 1 : index + 2] != ["{"]:
            continue
        middle = _end(made, index + 1, 1)
        below = middle + 2
        if made[middle + 1 : below] != ["{"] or made[below : below + 1] not in differentials:
            continue
        if made[index + 2] in ("d", r"\dd"):
            made[index + 2] = _OPERATOR if middle - index == 3 else r"\dd"
            made[below] = r"\dd"
    return made


def _over(tokens: list[str]) -> list[str]:
    r"""Write {a \over b} as \frac{a}{b}."""
    while r"\over" in tokens:
        at = tokens.index(r"\over")
        start, end = _end(tokens, at, -1), _end(tokens, at, 1)
        frac = [r"\frac", "{", *tokens[start + 1 : at], "}", "{", *tokens[at + 1 : end], "}"]
        tokens = [*tokens[: start + 1], *frac, *tokens[end:]]
    return tokens


def _end(tokens: list[str], at: int, step: int) -> int:
    """Find the enclosing brace before or after a position, or else the end of the text."""
    opened, closed = ("{", "}") if step > 0 else ("}", "{")
    depth, at = 0, at + step
    while 0 <= at < len(tokens):
        if tokens[at] == closed and depth == 0:
            break
        depth += (tokens[at] == opened) - (tokens[at] == closed)
        at += step
    return at


def _differentials(tokens: list[str]) -> list[str]:
    r"""Write d before a variable of integration as \dd, and move \dd out of numerators."""
    integrals = sum(token in (r"\int", r"\pvint") for token in tokens)
    if not integrals:
        return tokens
    if not any(t == r"\dd" and not _is_in_fraction(tokens, n) for n, t in enumerate(tokens)):
        made = list[str]()
        for index, token in enumerate(tokens):
            after = tokens[index + 1 : index + 2]
            is_one = integrals and token == "d" and bool(after) and _may_be_variable(after[0])
            if is_one and r"\int" in [t.replace("pv", "") for t in tokens[:index]]:
                token, integrals = r"\dd", integrals - 1
            made.append(token)
        tokens = made
    return _out_of_numerators(tokens)


def _is_in_fraction(tokens: list[str], at: int) -> bool:
    r"""Whether \dd is first above or below a fraction bar, as in a derivative."""
    before = tokens[at - 2 : at]
    return before[:1] in ([r"\frac"], ["}"]) and before[1:] == ["{"]


def _may_be_variable(token: str) -> bool:
    return (len(token) == 1 and token.isalpha()) or token in GREEK


def _out_of_numerators(tokens: list[str]) -> list[str]:
    r"""Write \frac{g \dd s}{h} as \frac{g}{h} \dd s."""
    for index in range(len(tokens) - 1, -1, -1):
        if tokens[index] not in _FRACTIONS or tokens[index + 1 : index + 2] != ["{"]:
            continue
        middle = _end(tokens, index + 1, 1)
        over, end = tokens[index + 2 : middle], _end(tokens, middle + 1, 1)
        if over[-2:-1] != [r"\dd"] or tokens[middle + 1 : middle + 2] != ["{"]:
            continue
        if tokens[middle + 2 : middle + 3] == [r"\dd"]:
            continue
        head, under = tokens[: index + 2], tokens[middle : end + 1]
        tokens = [*head, *(over[:-2] or ["1"]), *under, *over[-2:], *tokens[end + 1 :]]
    return tokens


def _depths(where: str, tokens: list[str]) -> list[int]:
    """Return the nesting depth of each token in brackets."""
    depth, depths = 0, list[int]()
    for token in tokens:
        depth -= token in _CLOSED
        depths.append(depth)
        depth += token in _OPENING
        if depth < 0 or depth > _DEEPEST:
            text = " ".join(tokens)
            why = (
                "a closing bracket matches nothing"
                if depth < 0
                else "brackets are nested too deeply"
            )
            raise BadFormula(where, text[:80], 0, why, "correct the brackets")
    if depth:
        text = " ".join(tokens)
        raise BadFormula(where, text[:80], 0, "a bracket is not closed", "correct the brackets")
    return depths


def _listed(tokens: list[str], depths: list[int]) -> list[list[str]]:
    """Divide a list; a row without a relation, or with a sign first, continues the one before."""
    parts: list[list[str]] = [[]]
    for at, (token, depth) in enumerate(zip(tokens, depths, strict=True)):
        cut = token in (",", ";", r"\andword", "\n", *_JOINTS)
        if token == r"\gap":
            if depth == 0 and _is_whole(parts[-1]) and _begins(tokens, depths, at):
                parts.append([])
            elif depth == 0:
                parts[-1].append(token)
        elif depth == 0 and cut:
            parts.append([token] if token in ("\n", *_JOINTS) else [])
        elif token != "\n":
            parts[-1].append(token)
    rows = list[list[str]]()
    for part in parts:
        row, inside = part[:1] == ["\n"], part[1:] if part[:1] == ["\n"] else part
        inside = _trimmed(inside)
        goes_on = row and inside and (inside[0] in {"+", "-", *_RELATIONS} or not _has(inside))
        if goes_on and rows:
            rows[-1] += inside
        elif inside:
            rows.append(inside)
    return [part[:-1] if part[-1] == "." else part for part in rows if part != ["."]]


def _trimmed(part: list[str]) -> list[str]:
    """Remove wide spaces at both ends."""
    while part[:1] == [r"\gap"]:
        part = part[1:]
    while part[-1:] == [r"\gap"]:
        part = part[:-1]
    return part


def _outside(part: list[str]) -> Iterator[tuple[int, str]]:
    """Yield the tokens outside all brackets, with their positions."""
    depth = 0
    for at, token in enumerate(part):
        depth -= token in _CLOSED
        if depth == 0 and token not in _OPENING:
            yield at, token
        depth += token in _OPENING


def _has(part: list[str]) -> bool:
    return any(token in _RELATIONS for _, token in _outside(part))


def _is_whole(part: list[str]) -> bool:
    """Whether a part has a relation and a right side that may end here."""
    last = next((t for t in reversed(part) if t != r"\gap"), "")
    return _has(part) and last not in _JOINING and not last.endswith("word")


def _begins(tokens: list[str], depths: list[int], at: int) -> bool:
    """Whether a new relation with a left side of its own starts after a position."""
    seen = False
    for token, depth in zip(tokens[at + 1 :], depths[at + 1 :], strict=True):
        if token == r"\gap":
            continue
        if depth:
            seen = True
            continue
        if token in _RELATIONS:
            return seen
        ends = token in (",", ";", "\n") or token.endswith("word") or _is_text(token)
        if ends or (token in _JOINING and not seen):
            return False
        seen = True
    return False


@dataclass
class _Part:
    """One entry of a list: its tokens and its condition.

    why    the reason if it is not read
    joint  the token before it: a comma, "or", or an arrow
    """

    tokens: list[str]
    condition: list[str]
    why: str = ""
    joint: str = ","

    def takes(self, other: "_Part") -> bool:
        """Whether an entry that follows is a condition of this one."""
        if other.joint in (_IMPLIES, _EQUIVALENT) or not (self.condition or self.is_equation()):
            return False
        relations = {token for _, token in _outside(other.tokens) if token in _RELATIONS}
        return relations <= _CONDITIONS if relations else not other.tokens

    def is_equation(self) -> bool:
        """Whether it has a relation that does not only state a condition."""
        return any(token in _RELATIONS - _CONDITIONS for _, token in _outside(self.tokens))

    def require(self, more: list[str], joint: str = ",") -> None:
        """Add a condition."""
        self.condition += [*([joint] if self.condition and more else []), *more]


def _with_fragments(parts: list[_Part]) -> list[_Part]:
    """Join entries without a relation to their neighbours, which are then not read."""
    made = list[_Part]()
    for part in parts:
        if made and (_is_fragment(part) or _is_fragment(made[-1])):
            alone = made[-1].tokens if _is_fragment(made[-1]) else part.tokens
            made[-1].tokens = [*made[-1].tokens, ",", *part.tokens]
            made[-1].require(part.condition)
            made[-1].why = made[-1].why or _unclear(alone)
        else:
            made.append(part)
    return made


def _is_fragment(part: _Part) -> bool:
    return not part.why and not _has(part.tokens)


def _unclear(tokens: list[str]) -> str:
    shown = _joined(tokens) or "a condition"
    return f"{shown} stands without a relation, so it is unclear what it belongs to"


def _divided(part: list[str]) -> _Part:
    """Divide an entry into its formula and the condition after the first word."""
    joint = part[0] if part[0] in _JOINTS else ","
    part = _trimmed(part[part[0] == joint :])
    under = [token for token in part if token.startswith(r"\under{")]
    part = [token for token in part if not token.startswith(r"\under{")]
    while part and _is_text(part[0]) and _is_remark(part[0], part[1:2]):
        part = _trimmed(part[1:])
    at = next((n for n, t in _outside(part) if _is_text(t) or t.endswith("word")), len(part))
    body, rest = part[:at], part[at:]
    if rest and _is_text(rest[0]):
        if not body or _may_be_unit(body, rest[0][len(r"\text{") : -1]):
            return _Part([token for token in part if token != r"\gap"], [], joint=joint)
        after = next((n for n, t in enumerate(rest) if not _is_text(t) and t != r"\gap"), len(rest))
        rest = rest[after:] if rest[after:] == [] or rest[after].endswith("word") else rest
    body = [token for token in _trimmed(body) if token != r"\gap"]
    made = _Part(body, [], joint=joint)
    if body[-1:] == [")"] and _has(body[(start := _opening(body)) + 1 : -1]):
        made = _Part(body[:start], body[start + 1 : -1], joint=joint)
    rest = rest[1:] if rest[:1] == [r"\whereword"] else rest
    made.require(["," if t == r"\whereword" else t for t in rest if t != r"\gap"])
    for each in under:
        made.require(_tokens(each[len(r"\under{") : -1]))
    return made


def _is_text(token: str) -> bool:
    return token.startswith(r"\text{")


def _is_remark(token: str, after: list[str]) -> bool:
    """Whether words before a formula stand apart from it; a single word may be an operator."""
    words = token[len(r"\text{") : -1]
    return words.endswith(":") or " " in words or after in ([], [r"\gap"])


def _may_be_unit(body: list[str], words: str) -> bool:
    """Whether the words after a formula may be a unit or another part of it."""
    if words.startswith("(") or words.split()[0].lower() in _STARTS:
        return False
    last = next((token for token in reversed(body) if token != r"\gap"), "")
    if last[:1].isdigit():
        return True
    return " " not in words and (body[-1] != r"\gap" or last == "}")


_STARTS = frozenset(each.split()[0] for each in (*_WHERE, *_AND, *_OR)) | {"which", "that", "since"}
"""Words that start a clause."""


def _opening(part: list[str]) -> int:
    """Return the position of the bracket that the last token closes."""
    depth = 0
    for at in range(len(part) - 1, -1, -1):
        depth += (part[at] in _CLOSED) - (part[at] in _OPENING)
        if depth == 0:
            return at
    return 0


def _chain(part: _Part) -> list[Statement]:
    """Return the statements of a chain of relations; equal sides are compared with the first."""
    if part.why or not _has(part.tokens):
        why = part.why or _unclear(part.tokens)
        tokens = part.tokens or part.condition
        return [Statement(_joined(tokens), why, condition=_joined(part.condition))]
    sides, between, last = [list[str]()], list[str](), 0
    for at, token in _outside(part.tokens):
        if token in _RELATIONS:
            sides[-1] = part.tokens[last:at]
            between.append("=" if token == r"\equiv" else token)
            sides.append([])
            last = at + 1
    sides[-1] = part.tokens[last:]
    collected, first = list[Statement](), 0
    for n, relation in enumerate(between):
        if n and not (relation == "=" == between[n - 1]):
            first = n
        rough = relation if relation in _ROUGHLY else ""
        left, (right, rest) = sides[first], _without_rest(sides[n + 1])
        if first and _without_rest(left)[0] != left:
            left, rough = sides[0], next((r for r in between[:n] if r in _ROUGHLY), rough)
        if rest == _DOTS and relation == "=":
            rough = rough or r"\sim"
        text = _joined([*left, rough or relation, *right])
        why = _fault(relation, left, right, rest) or _of_example(right, part.tokens)
        made = Statement(text, why, bool(rough))
        collected.append(_with_rest(made, rest, _from_one_side(part.condition)))
    return collected


_DOTS = [r"\dots"]
_DOT = (["."], [r"\dots"], [r"\ldots"], [r"\cdots"])


def _fault(relation: str, left: list[str], right: list[str], rest: list[str]) -> str:
    """Return the reason why a relation between two sides cannot be compared."""
    if relation in _NEVER:
        return _NEVER[relation]
    if _REMAINDER in (*left, *right):
        return (
            "a remainder O(...) is only understood as the last term: write the equation without it"
        )
    if not left or not right:
        side = "right" if left else "left"
        return f"there is nothing to the {side} of {relation}: write both sides"
    if _SMALLER in (*left, *right):
        return "a remainder o(...) has no order: write the equation with \\sim and its limit"
    if rest and relation in _ORDERED:
        return "an inequality with a remainder cannot be checked: write it without the remainder"
    return ""


def _from_one_side(condition: list[str]) -> list[str]:
    r"""Write s \to 0^+ as s \to 0, s > 0."""
    made = list[str]()
    for part in _cut(condition):
        tokens = part[:-1] if part[-1:] == ["}"] and part[-2:-1] in (["+"], ["-"]) else part
        if r"\to" not in tokens or tokens[-1] not in ("+", "-"):
            made += [*([","] if made else []), *part]
            continue
        sign = ">" if tokens[-1] == "+" else "<"
        tokens = tokens[:-1]
        while tokens[-1] in ("^", "_", "{"):
            tokens = tokens[:-1]
        at = tokens.index(r"\to")
        made += [*([","] if made else []), *tokens, ",", *tokens[:at], sign, *tokens[at + 1 :]]
    return made


def _cut(tokens: list[str]) -> list[list[str]]:
    """Divide tokens at commas."""
    parts: list[list[str]] = [[]]
    for token in tokens:
        if token == ",":
            parts.append([])
        else:
            parts[-1].append(token)
    return [part for part in parts if part]


def _of_example(side: list[str], chain: list[str]) -> str:
    """Return the reason why numbers in a chain with a unit cannot be compared."""
    words = chain[-1][len(r"\text{") : -1] if _is_text(chain[-1]) else ""
    letters = any(_is_text(t) or t in GREEK or (len(t) == 1 and t.isalpha()) for t in side)
    if not words or letters:
        return ""
    return f"numbers with the words {words!r} are an example: write them as text, without symbols"


def _with_rest(made: Statement, rest: list[str], condition: list[str]) -> Statement:
    """Add the condition, and the limit and order of a printed remainder."""
    told = _joined(condition)
    if made.why or not rest or rest == _DOTS:
        return replace(made, condition=told)
    size = _SIZE.fullmatch(_joined(rest).replace(" ", ""))
    if size is None:
        why = f"the remainder of order {_joined(rest)} is not understood: write the equation "
        return replace(made, why=f"{why}without it, with as = '...' and order = ...")
    if r"\to" not in condition:
        told = ", ".join(filter(None, (told, rf"{size[1]} \to 0")))
    over, _, under = (size[2] or size[3] or "1").partition("/")
    return replace(made, condition=told, order=float(over) / float(under or 1), small=size[1])


_SIZE = re.compile(
    r"((?:\\[A-Za-z]+|[A-Za-z])(?:_(?:\w|\\[A-Za-z]+|\{[^{}]*\}))?)"
    r"(?:\^(?:([1-9])|\{(\d+(?:\.\d+)?(?:/[1-9]\d*)?)\}))?"
)
"""A symbol, or a power of it."""


def _without_rest(side: list[str]) -> tuple[list[str], list[str]]:
    """Remove dots and O(...) for terms of higher order; return also what the O(...) holds."""
    kept, position = list[str](), 0
    while position < len(side):
        end = position + 1
        while side[position] in ("+", "-") and side[end : end + 1] in _DOT:
            end += 1
        is_last = end == len(side) or side[end] in _CLOSED
        if is_last and end - position > 1 and side[position + 1 : end] != ["."]:
            position = end
            continue
        kept.append(side[position])
        position += 1
    if len(kept) < len(side):
        return kept, _DOTS
    start = _opening(side) if side[-1:] == [")"] else 0
    if start > 1 and side[start - 1] == _REMAINDER and side[start - 2] in ("+", "-"):
        return side[: start - 2], side[start + 1 : -1]
    return side, []


def _joined(tokens: list[str]) -> str:
    return re.sub(r" (?=[_^'})\]])|(?<=[{(\[_^]) ", "", " ".join(tokens))


def _signs(statement: Statement) -> list[Statement]:
    r"""Return both readings of \pm and \mp; x_{1,2} is x_1 with the upper signs."""
    signs = re.compile(r"\\(?:pm|mp)(?![A-Za-z])")
    if not signs.search(statement.latex + statement.condition):
        return [statement]
    return [
        replace(
            statement,
            latex=_signed(statement.latex, upper),
            condition=_signed(statement.condition, upper),
        )
        for upper in (True, False)
    ]


def _signed(text: str, upper: bool) -> str:
    plus, minus = "+-" if upper else "-+"
    text = re.sub(r"\\pm(?![A-Za-z])", plus, text)
    text = re.sub(r"\\mp(?![A-Za-z])", minus, text)
    text = re.sub(r"_\{(\d) ?, ?(\d)\}", r"_{\1}" if upper else r"_{\2}", text)
    return re.sub(r"(^|[{(\[=<>,]|\\to)\s*\+(?!\})", r"\1 ", text)
