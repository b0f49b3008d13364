r"""Split a display into statements: layout commands are dropped, chains and lists are divided.

a = b = c          a = b and a = c
a < b = c          a < b and b = c
u, v   u and v     u and v, if each has its own relation
\pm, \mp           the equation with the upper signs, then with the lower signs
u for v            u under the condition v; an inequality after an equation is also a condition
"""

import re
from dataclasses import dataclass, replace

from derive.errors import BadFormula

_MOST = 20_000
"""The largest number of characters in a display."""
_DEEPEST = 60
_TOKEN = re.compile(
    r"\\(?:begin|end)\s*\{[A-Za-z]+\*?\}|\\[A-Za-z]+|\\.|[0-9]+(?:\.[0-9]+)?|\s+|.", re.DOTALL
)
_DROPPED = (
    r"\\(?:label|tag\*?|hspace\*?|vspace\*?|mathstrut|phantom)\s*\{[^{}]*\}"
    r"|\\(?:nonumber|notag|displaystyle|textstyle|limits|quad|qquad|[bB]igg?[lrm]?|mathrm|rm|it)"
    r"(?![A-Za-z])"
    r"|\\(?:left|right)\s*\.|\\(?:left|right)(?![A-Za-z])|\\[,;:! >]|~|&"
)
_WORDS = re.compile(
    r"\\(?:text|mbox|mathrm|textrm|textit|mathit|operatorname|mathbf|rm|textsf|mathsf)"
    r"\s*\{([^{}]*)\}"
)
_CASES = re.compile(
    r"(?:\\left\s*\\\{\s*)?\\begin\s*\{(cases|dcases|rcases|array)\}(?:\s*\{[^{}]*\})?"
    r"((?:(?!\\begin).)*?)\\end\s*\{\1\}(?:\s*\\right\s*\.)?",
    re.DOTALL,
)
_SPLIT = re.compile(r"\\begin\s*\{(split|aligned|gathered|alignedat)\}(?:\s*\{\d+\})?")
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
    r"\ast": "*",
    r"\prime": "'",
    r"\fint": r"\pvint",
    r"\dashint": r"\pvint",
    r"\rightarrow": r"\to",
}
_PRINCIPAL = frozenset(("pv", "p.v", "p. v", "cpv"))
_ROUGHLY = frozenset((r"\sim", r"\simeq", r"\approx", r"\cong", r"\propto", r"\to"))
_RELATIONS = frozenset(("=", "<", ">", r"\le", r"\leq", r"\ge", r"\geq", r"\equiv")) | _ROUGHLY
_ORDERED = frozenset(("<", ">", r"\le", r"\leq", r"\ge", r"\geq"))
_AND = frozenset(("and", "or", "so that", "with", "hence", "thus", "therefore", "i.e", "where"))
_OPERATOR = r"\derivativeof"
_FRACTIONS = (r"\frac", r"\dfrac", r"\tfrac")
_OPENING, _CLOSING = frozenset(("(", "{", "[", r"\begin{cases}")), frozenset(")}]")
_CLOSED = _CLOSING | {r"\end{cases}"}


@dataclass(frozen=True)
class Statement:
    """One statement of a display.

    latex      left side, relation and right side in plain LaTeX
    why        the reason why it cannot be compared; empty if it can
    is_rough   whether it is printed as an approximation
    condition  the LaTeX after "for", "as" or "if"; empty if there is no condition
    """

    latex: str
    why: str = ""
    is_rough: bool = False
    condition: str = ""


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
    collected = list[Statement]()
    parts = list[tuple[list[str], list[str]]]()
    for part in _listed(tokens, depths):
        relations = set(part) & _RELATIONS
        is_bound = part[0] == r"\whereword" or (relations <= _ORDERED and r"\whereword" not in part)
        if parts and is_bound and (parts[-1][1] or set(parts[-1][0]) & _RELATIONS - _ORDERED):
            more = [token for token in part if token != r"\whereword"]
            parts[-1][1].extend([",", *more] if parts[-1][1] else more)
        else:
            parts.append(_without_condition(part))
    for part, condition in parts:
        collected += _chain(part, condition)
    return [signed for each in collected for signed in _signs(each)]


def _plain(latex: str) -> str:
    """Remove layout commands from the text, and replace words by commands."""
    text = _CASES.sub(_marked_cases, latex)
    for kind in _SPLIT.findall(text):
        text = text.replace(rf"\end{{{kind}}}", " ")
    text = _SPLIT.sub(" ", text)
    text = re.sub(r"(?<!\\)\\\\\*?(?:\[[^\]]*\])?", " \n ", text)
    text = re.sub(r"\\text\s*\{\s*\$([^${}]*)\$([^${}]*)\}", r"\1\2", text)
    text = re.sub(r"-(?:\s|\\!|\{\})*\\int(?![A-Za-z])", _dashed, text)
    text = re.sub(r"\{\s*\\(?:rm|mathrm)\s+d\s*\}", r"\\dd ", text)
    text = _WORDS.sub(_word, text)
    text = re.sub(r"\\not\s*=", r"\\ne ", text)
    return re.sub(_DROPPED, " ", text)


def _marked_cases(match: re.Match[str]) -> str:
    rows = re.sub(r"(?<!\\)\\\\(?:\[[^\]]*\])?", r" \\caserow ", match[2])
    cells = re.sub(r"(?<!\\)&", r" \\casecol ", rows)
    return rf"\begin{{cases}}{cells}\end{{cases}}"


def _dashed(match: re.Match[str]) -> str:
    r"""Read -\!\!\!\int as a principal value, but keep an ordinary minus before an integral."""
    return r"\pvint" if r"\!" in match[0] else match[0]


def _word(match: re.Match[str]) -> str:
    inner = match[1].strip()
    before = match.string[: match.start()].rstrip()
    if inner == "d":
        return r"\dd "
    if inner == "sgn":
        return r"\sgn "
    if inner.lower().strip(" .") in _PRINCIPAL:
        return r"\pvword "
    if before.endswith(("_", "^", "_{", "^{")):
        return f"{{{inner}}}" if before.endswith(("_", "^")) else inner
    if len(inner) <= 1 or not any(map(str.isalpha, inner)):
        return f" {inner} "
    word = inner.strip(" ,.;")
    return r" \andword " if word in _AND else r" \whereword "


def _tokens(text: str) -> list[str]:
    tokens = [t for t in _TOKEN.findall(text) if "\n" in t or not t.isspace()]
    cleaned = ["\n" if t.isspace() else _ALIKE.get(t, re.sub(r"\s", "", t)) for t in tokens]
    for index, token in enumerate(cleaned[:-1]):
        if token == r"\pvword" and cleaned[index + 1] == r"\int":
            cleaned[index + 1] = r"\pvint"
    return [token for token in cleaned if token != r"\pvword"]


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
    return (len(token) == 1 and token.isalpha()) or token in (r"\xi", r"\eta", r"\theta", r"\tau")


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
    for token, depth in zip(tokens, depths, strict=True):
        cut = token in (",", ";", r"\andword", "\n")
        if depth == 0 and cut:
            parts.append(["\n"] if token == "\n" else [])
        elif token != "\n":
            parts[-1].append(token)
    rows = list[list[str]]()
    for part in parts:
        row, inside = part[:1] == ["\n"], part[1:] if part[:1] == ["\n"] else part
        goes_on = row and inside and (inside[0] in {"+", "-", *_RELATIONS} or not _has(inside))
        if goes_on and rows:
            rows[-1] += inside
        elif inside:
            rows.append(inside)
    return [part[:-1] if part[-1] == "." else part for part in rows]


def _has(part: list[str]) -> bool:
    return any(token in _RELATIONS for token in part)


def _without_condition(part: list[str]) -> tuple[list[str], list[str]]:
    """Return the tokens before and after the first word outside brackets."""
    depth = 0
    for at, token in enumerate(part):
        depth += (token in _OPENING) - (token in _CLOSED)
        if depth == 0 and token == r"\whereword":
            rest = part[at + 1 :]
            return part[:at], [token for token in rest if token != r"\whereword"]
    return part, []


def _chain(part: list[str], condition: list[str]) -> list[Statement]:
    """Return the statements of a chain of relations; equal sides are compared with the first."""
    sides, between, depth = [list[str]()], list[str](), 0
    for token in part:
        depth += (token in _OPENING) - (token in _CLOSED)
        if depth == 0 and token in _RELATIONS:
            between.append("=" if token == r"\equiv" else token)
            sides.append([])
        else:
            sides[-1].append(token)
    collected, first = list[Statement](), 0
    for n, relation in enumerate(between):
        if n and not (relation == "=" == between[n - 1]):
            first = n
        rough = relation if relation in _ROUGHLY else ""
        left, right = sides[first], _without_dots(sides[n + 1])
        if first and _without_dots(left) != left:
            left, rough = sides[0], next((r for r in between[:n] if r in _ROUGHLY), "")
        text = _joined([*left, rough or relation, *right])
        why = ""
        if not left or not right or rough in (r"\to", r"\propto"):
            why, rough = "this is not an equation with two sides", ""
        collected.append(Statement(text, why, bool(rough), _joined(condition)))
    return collected


def _without_dots(side: list[str]) -> list[str]:
    """Remove the dots that stand for higher-order terms."""
    dots = re.sub(r"\+ (?:\. ?\. ?\.|\\(?:l|c|)dots)(?= |$)", "", " ".join(side))
    return dots.split() if dots != " ".join(side) else side


def _joined(tokens: list[str]) -> str:
    return re.sub(r" (?=[_^'})\]])|(?<=[{(\[_^]) ", "", " ".join(tokens))


def _signs(statement: Statement) -> list[Statement]:
    r"""Return both readings of \pm and \mp."""
    if not re.search(r"\\(?:pm|mp)(?![A-Za-z])", statement.latex):
        return [statement]
    made = []
    for upper, lower in (("+", "-"), ("-", "+")):
        text = re.sub(r"\\pm(?![A-Za-z])", upper, statement.latex)
        text = re.sub(r"\\mp(?![A-Za-z])", lower, text)
        text = re.sub(r"(^|[{(\[=<>])\s*\+", r"\1 ", text)
        made.append(replace(statement, latex=text))
    return made
