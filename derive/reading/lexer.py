r"""Cut LaTeX into tokens: the only place that knows how things are spelled.

In:   a display, or the LaTeX of a symbol.
Out:  tokens, each with its terminal of latex.lark, its plain LaTeX, and its place in the text.

Only layout commands are removed.  Words become tokens as well; the grammar admits those that join
statements or conditions, and everything else is refused where it stands.
"""

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from derive.command.errors import BadFormula
from derive.reading.words import COMMANDS, FUNCTIONS

_DEEPEST = 60
"""The largest nesting depth of brackets."""

_SPELLINGS = r"""
EQUAL     =      \equiv \coloneqq \triangleq defined
ORDER     <
ORDER     >
ORDER     \le    \leq \leqslant
ORDER     \ge    \geq \geqslant
ROUGH     \sim   \simeq \approx \cong
TO        \to    \rightarrow \longrightarrow
NE        \ne    \neq unequal
PROPTO    \propto
IMPLIES   \implies \Rightarrow \Longrightarrow
IFF       \iff   \Leftrightarrow \Longleftrightarrow
AND       \and   \therefore
SIGN      +
SIGN      -
PM        \pm
PM        \mp
OPERATOR  *
OPERATOR  /
OPERATOR  \cdot  \times
POWER     ^
COMMA     ,
'         '      \prime
|         |      \lvert \rvert \vert
(         (      \{ \lbrace open
)         )      \} \rbrace close
FRAC      \frac  \dfrac \tfrac \cfrac \nicefrac
OVER      \over
SQRT      \sqrt
SUM       \sum
LIM       \lim
INT       \int
INT       \pvint \fint \dashint principal
VALUE     value
DIFF      \dd
EULER     \euler
PV        \pv
PI        \pi
SYMBOL    \infty
DOTS      \dots  \ldots \cdots dots
GAP       \quad  gap
LINE      \\     row
"""
"""The terminal, the plain LaTeX, and other spellings of it, or names of groups of _TOKEN."""
_LETTERS = r"""
\alpha \beta \gamma \delta \epsilon \varepsilon \zeta \eta \theta \vartheta \iota \kappa \lambda \mu
\nu \xi \rho \varrho \sigma \tau \upsilon \phi \varphi \chi \psi \omega \ell \Gamma \Delta \Theta
\Lambda \Xi \Pi \Sigma \Upsilon \Phi \Psi \Omega
"""
_RELATED = r"\ll \gg \lesssim \gtrsim \asymp \in \subset \stackrel \overset \underset"
"""What may relate two sides, but is never read."""
GREEK = frozenset(_LETTERS.split())
ENDS_SOONER = ("circular", "hyperbolic")
"""Functions of angles and their inverses: the name of the next function ends their argument."""

_TABLE = {
    spelling: (kind, plain)
    for kind, plain, *others in (row.split() for row in _SPELLINGS.strip().splitlines())
    for spelling in (plain, *others)
}
_TABLE |= dict.fromkeys(GREEK, ("LETTER", ""))
_TABLE |= dict.fromkeys(_RELATED.split(), ("RELATED", ""))
for _each, _name in COMMANDS.items():
    _circular = FUNCTIONS[_name].like.endswith(ENDS_SOONER)
    _TABLE.setdefault(_each, ("CIRCULAR" if _circular else "FUNC", _each))

_HYPERBOLIC = ("sinh", "cosh", "tanh", "coth", "sech", "csch")
_UPRIGHT = {
    **{name: command for command, name in COMMANDS.items() if name.islower()},
    **{command[1:]: command for command in COMMANDS if command.islower()},
    **{f"arc{name}": rf"\ar{name}" for name in _HYPERBOLIC},
    **{"d": r"\dd", "e": r"\euler"},
    **dict.fromkeys(("PV", "pv", "p.v.", "P.V.", "p. v.", "CPV"), r"\pv"),
}
"""Functions and constants whose name is printed upright."""
_WORDS = {
    "AND": "and|so that|with|hence|thus|therefore|i.e|where",
    "OR": "or|or else",
    "WHERE": "for|for all|for any|for every|if|when|whenever|as|at|in|on|provided"
    "|provided that|while|as long as|in the limit|valid for",
    "WHERE ELSE": "otherwise|else|elsewhere",
    "": "which|that|since",
}
_KINDS = {word: kinds.split() for kinds, words in _WORDS.items() for word in words.split("|")}
_ENVIRONMENTS = {
    **dict.fromkeys(("split", "aligned", "gathered", "alignedat"), "LINES"),
    **dict.fromkeys(("cases", "dcases", "rcases", r"\{cases", r"\{dcases", r"\{array"), "BEGIN"),
    "array": "FRAME",
}
"""Environments whose rows are lines, or have a value and a condition each.  Others are refused as
tables, except for an array with equations around all of a display."""
CONDITIONS = frozenset(("ORDER", "TO", "NE", "RELATED"))
"""Relations of a condition, if they follow an equation after a comma or a wide space."""
RELATIONS = CONDITIONS | {"EQUAL", "ROUGH", "PROPTO"}
_AROUND = frozenset(("{", "BEGIN", "FRAME"))
"""Brackets and environments that say nothing if they enclose all of a display."""
_FEW = 20
"""The largest number of tokens in a script before words in it."""
_UNITS = frozenset("gmsJNW")
"""Units of one letter.  K may be an elliptic integral."""

_SPACE = r"(?:~|\\[;:, >])"
_FONTS = "text|mbox|hbox|textnormal|mathrm|textrm|textit|mathit|operatorname|mathbf|textsf|mathsf"
_TOKEN = re.compile(
    rf"""(?P<layout>
        \\l?eqno(?![A-Za-z]).*
      | \\(?:label|tag\*?|hspace\*?|vspace\*?|mathstrut|phantom)\s*\{{[^{{}}]*\}}
      | \\(?:nonumber|notag|displaystyle|textstyle|(?:no)?limits|mathop|boxed)(?![A-Za-z])
      | \\[bB]igg?[lrm]?(?![A-Za-z])
      | \\(?:left|right)\s*\. | \\(?:left|right)(?![A-Za-z]|\s*[{{}}]) | \\!
      | \s+)
    | (?P<gap>(?:{_SPACE}\s*){{2,}} | \\q?quad(?![A-Za-z]))
    | (?P<space>{_SPACE})
    | (?P<number>(?:0|\d+(?=\{{,\}}(?!\d{{3}}(?!\d))))\{{,\}}\d+ | \d+(?:\.\d+)?)
    | (?P<open>\\(?:left|right)\s*\{{) | (?P<close>\\(?:left|right)\s*\}})
    | (?P<order>(?:\\(?:mathcal|mathscr)\s*(?:\{{\s*O\s*\}}|O))
      | [Oo](?=(?:\s|\\left|\\[bB]igg?l?)*\())
    | (?P<principal>-(?:\s|\{{\}})*\\!(?:\s|\\!|\{{\}})*\\int(?![A-Za-z]))
    | (?P<value>(?:\||\\r?vert)(?=\s*_))
    | (?P<defined>:\s*=) | (?P<unequal>\\not\s*=)
    | (?P<dots>\.\s*\.\s*\.)
    | (?P<row>\\\\\*?(?:\[[^\]]*\])?)
    | (?P<environment>(?P<curly>\\\{{\s*)?\\(?:(?P<begin>begin)|end)\s*\{{(?P<name>[A-Za-z]+\*?)\}}
        (?(begin)(?:(?:(?<=array\}})|(?<=edat\}}))\s*\{{[^{{}}]*\}})?))
    | (?P<words>\{{\s*\\(?:rm|it|bf|sf)(?![A-Za-z])\s*(?P<old>[^{{}}\\]*)\}}
      | (?P<closed>\{{\s*)?\\(?P<font>{_FONTS})\*?\s*
        (?:\{{(?P<inner>(?:[^{{}}$]|\$[^$]*\$)*)\}} | (?<=\s)(?P<letter>[A-Za-z]))(?(closed)\s*\}}))
    | (?P<command>\\[A-Za-z]+ | \\. | .)
    """,
    re.DOTALL | re.VERBOSE,
)


class Token(NamedTuple):
    """A token.

    type   the terminal of the grammar
    text   its plain LaTeX
    at     its place in the display
    depth  the number of brackets around it
    size   the number of tokens that it stands for; without braces, TeX takes only one
    """

    type: str
    text: str
    at: int
    depth: int = 0
    size: int = 1

    @property
    def words(self) -> str:
        """The words of a remark."""
        return self.text.removeprefix(r"\text{").removesuffix("}")


@dataclass
class Unclear(Exception):
    """The LaTeX cannot be read, or can be read in two ways, from a place on."""

    at: int
    why: str
    remedy: str


def refusal(where: str, latex: str, error: Unclear) -> BadFormula:
    """Return the error for a place in LaTeX, with the line that holds it."""
    start = latex.rfind("\n", 0, error.at) + 1
    line = latex[start:].partition("\n")[0]
    return BadFormula(where, line, error.at - start, error.why, error.remedy)


def plain(tokens: Sequence[Token]) -> str:
    """Return the plain LaTeX of tokens."""
    return re.sub(r" (?=[_^'})\]])|(?<=[{(\[_^]) ", "", " ".join(each.text for each in tokens))


def tokens_of(latex: str) -> list[Token]:
    """Cut a display, or the LaTeX of a symbol; raise Unclear if its brackets do not match."""
    return _differentials(_indices_first(_unframed(_nested(scan(latex)))))


def scan(latex: str, start: int = 0, end: int | None = None) -> list[Token]:
    """Cut LaTeX into tokens without regard to brackets."""
    made = list[Token]()
    stop = len(latex) if end is None else end
    for match in _TOKEN.finditer(latex, start, stop):
        kind = str(match.lastgroup)
        if kind in ("layout", "space"):
            continue
        made += _READERS.get(kind, _command)(match, made)
        if [each.text for each in made[-2:]] == [r"\pv", r"\int"]:
            made[-2:] = [made[-1]._replace(text=r"\pvint")]
    return made


def _command(match: re.Match[str], before: list[Token]) -> list[Token]:
    text = match[0] if match["command"] else str(match.lastgroup)
    scripts = [each.text in ("^", "_") for each in before[-2:]]
    if text in (r"\ast", r"\star") and any(scripts) and (scripts[-1] or before[-1].text == "{"):
        text = "*"
    kind, other = _TABLE.get(text, ("LETTER" if text.isalpha() else text, ""))
    return [Token(kind, other or text, match.start())]


def _environment(match: re.Match[str], _: list[Token]) -> list[Token]:
    side, name = match["begin"] or "end", match["name"]
    other = "FRAME" if name in _ENVIRONMENTS else "TABLE"
    kind = _ENVIRONMENTS.get((match["curly"] or "").strip() + name, other)
    return [Token(kind if match["begin"] else "END", rf"\{side}{{{name}}}", match.start())]


def _number(match: re.Match[str], before: list[Token]) -> list[Token]:
    text = match[0].replace("{,}", ".")
    if text.isdigit() and before and before[-1].type == "FRAC":  # as in \frac12
        return [Token("NUMBER", each, match.start() + n) for n, each in enumerate(text)]
    return [Token("NUMBER", text, match.start(), size=len(text))]


def _order(match: re.Match[str], before: list[Token]) -> list[Token]:
    """O(...) and o(...) are remainders after a sign."""
    if match[0] in "Oo" and (not before or before[-1].type != "SIGN"):
        return [Token("LETTER", match[0], match.start())]
    letter = "o" if match[0] == "o" else "O"
    return [Token("REST", rf"\mathcal{{{letter}}}", match.start())]


def _words(match: re.Match[str], before: list[Token]) -> list[Token]:
    r"""Read words, and \text{for $x > 0$} as \text{for} x > 0."""
    group = next(each for each in ("old", "inner", "letter") if match[each] is not None)
    made, start = list[Token](), match.start(group)
    for n, part in enumerate(match[group].split("$")):
        span = (start, start + len(part))
        font = match["font"] or ""
        made += scan(match.string, *span) if n % 2 else _worded(part, font, match, span, before)
        start = span[1] + 1
    return made


def _worded(
    words: str, font: str, match: re.Match[str], span: tuple[int, int], before: list[Token]
) -> list[Token]:
    """Read words: parts of an index, the name of a function, letters, or words."""
    inner, at, letters = words.strip(), match.start(), scan(match.string, *span)
    if before and before[-1].text in ("_", "^"):
        return [Token("{", "{", at), *letters, Token("}", "}", at)]
    if re.search(r"[_^] \{[^{}]*$", " ".join(each.text for each in before[-_FEW:])):
        return letters
    if inner in _UPRIGHT and font not in ("mathit", "textit", "mathbf"):
        return [Token(*_TABLE[_UPRIGHT[inner]], at)]
    last = next((each for each in reversed(before) if each.type not in ("GAP", "}")), None)
    is_unit = inner in _UNITS and last is not None and last.type == "NUMBER"
    if not is_unit and (len(inner) <= 1 or not any(map(str.isalpha, inner))):
        return letters
    word = " ".join(re.sub(r"\\(?:[,;:! ]|$)|~", " ", inner).split()).strip(" ,.;")
    kinds = () if is_unit else _KINDS.get(word.lower().strip(" :"), ())
    return [Token(kind, rf"\{kind.lower()}", at) for kind in kinds] or [
        Token("TEXT", rf"\text{{{word}}}", at)
    ]


_READERS: Mapping[str, Callable[[re.Match[str], list[Token]], list[Token]]] = {
    "number": _number,
    "order": _order,
    "environment": _environment,
    "words": _words,
}


_CLOSING = {
    **{"(": ")", "{": "}", "[": "]", "LBAR": "RBAR"},
    **dict.fromkeys(("BEGIN", "LINES", "FRAME"), "END"),
}
_PUNCTUATION = frozenset(("COMMA", ".", ";", "GAP"))


def _nested(tokens: list[Token]) -> list[Token]:
    """Give each token its depth, and tell rows and columns of cases from others."""
    made, opened, depth, cases = list[Token](), list[Token](), 0, 0
    for token in tokens:
        kind = token.type
        if kind == "|":
            kind = "RBAR" if opened and opened[-1].type == "LBAR" else "LBAR"
        elif kind == "TABLE":
            raise _table(token)
        elif cases:
            kind = {"LINE": "ROW", "&": "COL"}.get(kind, kind)
        while cases and kind in ("ROW", "COL", "END") and made[-1].type in _PUNCTUATION:
            made.pop()
        token, is_shown = token._replace(type=kind), kind != "LINES"
        if kind in _CLOSING.values():
            if not opened:
                raise Unclear(token.at, "a closing bracket matches nothing", "correct the brackets")
            last = opened.pop()
            if _closing(last) != token.text:
                raise _unclosed(last)
            is_shown = last.type != "LINES"
            depth, cases = depth - is_shown, cases - (last.type == "BEGIN")
        made += [token._replace(depth=depth)] if is_shown else []
        if kind in _CLOSING:
            opened.append(token)
            depth, cases = depth + is_shown, cases + (kind == "BEGIN")
        if depth >= _DEEPEST:
            raise Unclear(token.at, "brackets are nested too deeply", "use fewer brackets")
    if opened:
        raise _unclosed(opened[-1])
    return made


def _unframed(tokens: list[Token]) -> list[Token]:
    """Remove braces and environments around all; rows and columns in them are the display's."""
    start = next((n for n, each in enumerate(tokens) if each.type != "GAP"), 0)
    if tokens and tokens[start].type in _AROUND:
        end, name = partner(tokens, start), tokens[start].text[len(r"\begin{") : -1]
        is_system = name != "array" or any(t.type in RELATIONS for t in tokens[start:end])
        if is_system and all(each.type in _PUNCTUATION for each in tokens[end + 1 :]):
            return _unframed(
                [each._replace(depth=each.depth - 1) for each in tokens[start + 1 : end]]
            )
    for each in tokens:
        if each.type == "FRAME":
            raise _table(each)
        if each.type == "OVER" and not each.depth:
            why = r"\over divides the whole display"
            raise Unclear(each.at, why, "put braces around the fraction")
    return [each for each in tokens if not (each.depth and each.type in ("LINE", "&", "GAP"))]


def partner(tokens: Sequence[Token], at: int) -> int:
    """Return the position of the bracket that closes the one at a position."""
    after = range(at + 1, len(tokens))
    return next(n for n in after if tokens[n].depth == tokens[at].depth)


def _closing(token: Token) -> str:
    """Return the text that closes a bracket or an environment."""
    return _CLOSING.get(token.text, token.text.replace("begin", "end"))


def _table(token: Token) -> Unclear:
    why = f"{token.text} is a table or a matrix, which is not read"
    return Unclear(token.at, why, "write what it says as claims in text")


def _unclosed(token: Token) -> Unclear:
    return Unclear(token.at, f"this {token.text} is not closed", f"add {_closing(token)}")


def _indices_first(tokens: list[Token]) -> list[Token]:
    """Put an index before the exponent that is printed above it, as in c_s^2 for c^2_s."""
    made = list(tokens)
    for at in range(len(made)):
        end = _past(made, at + 1)
        if made[at].text == "^" and [each.text for each in made[end : end + 1]] == ["_"]:
            after = _past(made, end + 1)
            made[at:after] = [*made[end:after], *made[at:end]]
    return made


def _past(tokens: Sequence[Token], at: int) -> int:
    """Return the position after a token or a group in braces."""
    return (partner(tokens, at) if [t.text for t in tokens[at : at + 1]] == ["{"] else at) + 1


def _differentials(tokens: list[Token]) -> list[Token]:
    r"""Tell the d of integrals from those of derivatives and changes, which become \dd."""
    texts, derived = [each.text for each in tokens], set[int]()
    for above in (n + 2 for n, each in enumerate(tokens) if each.type == "FRAC"):
        below = _past(tokens, above - 1) + 1
        starts = (texts[above - 1 : above + 1], texts[below - 1 : below + 1])
        if all(each in (["{", "d"], ["{", r"\dd"]) for each in starts):
            derived |= {above, below}
    is_upright = any(each.type == "DIFF" and n not in derived for n, each in enumerate(tokens))
    made, integrals = list[Token](), 0
    for n, each in enumerate(tokens):
        integrals = 0 if each.type in RELATIONS and not each.depth else integrals
        integrals += each.type == "INT"
        follows = [after.type for after in tokens[n + 1 : n + 2]]
        if n in derived or (each.type == "DIFF" and not integrals):
            each = each._replace(type="CHANGE", text=r"\dd")
        elif integrals and not is_upright and each.text == "d" and follows == ["LETTER"]:
            each, integrals = each._replace(type="DIFF"), integrals - 1
        made.append(each._replace(text=r"\mathrm{d}") if each.type == "DIFF" else each)
    return made
