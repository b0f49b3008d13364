r"""The statements of one display: what is for the eye is left out, chains and lists are cut.

a = b = c          a = b and a = c
a < b = c          a < b and b = c
u, v   u and v     u and v, where each has a relation of its own
\pm, \mp           the equation with the upper signs, then with the lower ones
"""

import re
from dataclasses import dataclass

from derive.errors import BadFormula

_MOST = 20_000
"""Characters of a display."""
_DEEPEST = 60
_TOKEN = re.compile(r"\\[A-Za-z]+|\\.|[0-9]+(?:\.[0-9]+)?|\s+|.", re.DOTALL)
_DROPPED = (
    r"\\(?:label|tag\*?|hspace\*?|vspace\*?)\s*\{[^{}]*\}"
    r"|\\(?:nonumber|notag|displaystyle|textstyle|limits|quad|qquad|[bB]igg?[lrm]?)(?![A-Za-z])"
    r"|\\(?:left|right)\s*\.|\\(?:left|right)(?![A-Za-z])|\\[,;:! >]|~|&"
)
_WORDS = re.compile(
    r"\\(?:text|mbox|mathrm|textrm|textit|mathit|operatorname|mathbf)\s*\{([^{}]*)\}"
)
_ALIKE = {
    r"\lvert": "|",
    r"\rvert": "|",
    r"\vert": "|",
    r"\{": "(",
    r"\}": ")",
    r"\cfrac": r"\frac",
    r"\leqslant": r"\le",
    r"\geqslant": r"\ge",
    r"\ast": "*",
    r"\prime": "'",
}
_ROUGHLY = frozenset((r"\sim", r"\simeq", r"\approx", r"\cong", r"\propto", r"\to", r"\rightarrow"))
_RELATIONS = frozenset(("=", "<", ">", r"\le", r"\leq", r"\ge", r"\geq", r"\equiv")) | _ROUGHLY
_AND = frozenset(("and", "or", "so that", "with"))
_WHERE = frozenset(("for", "as", "if", "when", "where", "otherwise"))
_OPENING, _CLOSING = frozenset("({["), frozenset(")}]")


@dataclass(frozen=True)
class Statement:
    """One statement of a display.

    latex  left, relation and right in plain LaTeX
    why    why it cannot be compared; empty if it may be
    is_rough  whether it is printed as an approximation
    """

    latex: str
    why: str = ""
    is_rough: bool = False


def statements(where: str, latex: str) -> list[Statement]:
    """All statements of a display; raises BadFormula where its brackets do not fit."""
    if len(latex) > _MOST:
        raise BadFormula(where, latex[:80], 80, f"the display is longer than {_MOST}", "split it")
    tokens = _tokens(_plain(latex))
    depths = _depths(where, tokens)
    if r"\begin" in tokens:
        return [
            Statement(latex, r"a \begin inside the display is not read: write its cases as text")
        ]
    found = list[Statement]()
    for part in _listed(tokens, depths):
        found += _chain(*_without_condition(part))
    return [signed for each in found for signed in _signs(each)]


def _plain(latex: str) -> str:
    """The text without what does not count, words as commands."""
    text = re.sub(r"(?<!\\)\\\\(?:\[[^\]]*\])?", " \n ", latex)
    text = re.sub(r"\\text\s*\{\s*\$([^${}]*)\$([^${}]*)\}", r"\1\2", text)
    text = _WORDS.sub(_word, text)
    text = re.sub(r"\\not\s*=", r"\\ne ", text)
    return re.sub(_DROPPED, " ", text)


def _word(found: re.Match[str]) -> str:
    inner = found[1].strip()
    before = found.string[: found.start()].rstrip()
    if inner == "d":
        return r"\dd "
    if inner == "sgn":
        return r"\sgn "
    if before.endswith(("_", "^", "_{", "^{")):
        return f"{{{inner}}}" if before.endswith(("_", "^")) else inner
    if len(inner) <= 1 or not any(map(str.isalpha, inner)):
        return f" {inner} "
    word = inner.strip(" ,.;")
    return r" \andword " if word in _AND else r" \whereword "


def _tokens(text: str) -> list[str]:
    found = [t for t in _TOKEN.findall(text) if "\n" in t or not t.isspace()]
    return ["\n" if t.isspace() else _ALIKE.get(t, t) for t in found]


def _depths(where: str, tokens: list[str]) -> list[int]:
    """How deep in brackets each token stands."""
    depth, deep = 0, list[int]()
    for token in tokens:
        depth -= token in _CLOSING
        deep.append(depth)
        depth += token in _OPENING
        if depth < 0 or depth > _DEEPEST:
            text = " ".join(tokens)
            why = "a bracket closes nothing" if depth < 0 else "brackets are nested too deep"
            raise BadFormula(where, text[:80], 0, why, "mend the brackets")
    if depth:
        text = " ".join(tokens)
        raise BadFormula(where, text[:80], 0, "a bracket is not closed", "mend the brackets")
    return deep


def _listed(tokens: list[str], depths: list[int]) -> list[list[str]]:
    """The parts of a list; a new row goes on where it begins with a sign or has no relation."""
    parts: list[list[str]] = [[]]
    for token, depth in zip(tokens, depths, strict=True):
        cut = token in (",", ";", r"\andword", "\n")
        if depth == 0 and cut:
            parts.append(["\n"] if token == "\n" else [])
        elif token != "\n":
            parts[-1].append(token)
    made = list[list[str]]()
    for part in parts:
        row, inside = part[:1] == ["\n"], part[1:] if part[:1] == ["\n"] else part
        goes_on = row and inside and (inside[0] in {"+", "-", *_RELATIONS} or not _has(inside))
        if goes_on and made:
            made[-1] += inside
        elif inside:
            made.append(inside)
    return [part[:-1] if part[-1] == "." else part for part in made]


def _has(part: list[str]) -> bool:
    return any(token in _RELATIONS for token in part)


def _without_condition(part: list[str]) -> tuple[list[str], str]:
    at = part.index(r"\whereword") if r"\whereword" in part else len(part)
    return part[:at], "".join(part[at + 1 :])


def _chain(part: list[str], condition: str) -> list[Statement]:
    """The statements of a chain of relations, whose equal sides all stand against the first."""
    sides, between, depth = [list[str]()], list[str](), 0
    for token in part:
        depth += (token in _OPENING) - (token in _CLOSING)
        if depth == 0 and token in _RELATIONS:
            between.append(token)
            sides.append([])
        else:
            sides[-1].append(token)
    made, first = list[Statement](), 0
    for n, relation in enumerate(between):
        if n and not (relation == "=" == between[n - 1]):
            first = n
        rough = relation if relation in _ROUGHLY else ""
        left, right = sides[first], _without_dots(sides[n + 1])
        if first and _without_dots(left) != left:
            left, rough = sides[0], next((r for r in between[:n] if r in _ROUGHLY), "")
        text = _joined([*left, rough or relation, *right])
        why = f"printed with {rough}, an approximation: write its leading terms with =" * bool(
            rough
        )
        if not left or not right or rough in (r"\to", r"\rightarrow", r"\propto"):
            why, rough = "this is no equation with two sides", ""
        made.append(Statement(text, why, bool(rough)))
    return made


def _without_dots(side: list[str]) -> list[str]:
    """A side without dots for higher terms."""
    dots = re.sub(r"\+ (?:\. ?\. ?\.|\\(?:l|c|)dots)(?= |$)", "", " ".join(side))
    return dots.split() if dots != " ".join(side) else side


def _joined(tokens: list[str]) -> str:
    return re.sub(r" (?=[_^'})\]])|(?<=[{(\[_^]) ", "", " ".join(tokens))


def _signs(statement: Statement) -> list[Statement]:
    r"""Both readings of \pm and \mp."""
    if not re.search(r"\\(?:pm|mp)(?![A-Za-z])", statement.latex):
        return [statement]
    made = []
    for upper, lower in (("+", "-"), ("-", "+")):
        text = re.sub(r"\\pm(?![A-Za-z])", upper, statement.latex)
        text = re.sub(r"\\mp(?![A-Za-z])", lower, text)
        text = re.sub(r"(^|[{(\[=<>])\s*\+", r"\1 ", text)
        made.append(Statement(text, statement.why, statement.is_rough))
    return made
