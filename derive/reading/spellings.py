r"""Find the symbols in a LaTeX statement, and propose a name for each.

A letter with all its indices and accents is one symbol: K_{N,c}, E^*, \Delta Q, q_1^{(asy)}(x).
A letter followed by a symbol, or a list of symbols, in parentheses is a function, which is one
symbol as well; p(x) and p(x, c) are two different symbols.  The draft lists every spelling, so
that the user can check it.
"""

import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass

from derive.reading.formula import usable

_TOKEN = re.compile(
    r"\\(?:begin|end)\s*\{[a-z]+\}|\\text\{[^{}]*\}|\\[A-Za-z]+|\\.|[0-9]+(?:\.[0-9]+)?|\S"
)
_NAMES = """
alpha beta gamma delta epsilon varepsilon zeta eta theta vartheta iota kappa lambda mu nu xi rho
varrho sigma tau upsilon phi varphi chi psi omega ell Gamma Delta Theta Lambda Xi Pi Sigma Upsilon
Phi Psi Omega
"""
_ACCENTS = {
    **{rf"\{name}": name for name in ("bar", "hat", "tilde", "dot", "vec")},
    **{r"\overline": "bar", r"\widehat": "hat", r"\widetilde": "tilde"},
}
_SIDES = {"+": "plus", "-": "minus"}
GREEK = frozenset(f"\\{name}" for name in _NAMES.split())
PROPOSALS = {
    "P": ("load(a, c)", "normal load", "N/m", "force|weight", ""),
    "M": ("moment(a, c)", "moment", "N", "couple|torque", ""),
    "alpha": ("tilt(a, c)", "angle of tilt", "rad", "rotation|inclination", ""),
    "a": ("", "left edge of the contact at x = -a, or half-width", "m", "radius|length", ""),
    "b": ("", "a length of the profile, or half-width", "m", "width|radius|flat", ""),
    "c": ("", "right edge of the contact, or right end of the stick zone", "m", "width|radius", ""),
    "m": ("", "left end of the stick zone", "m", "", "stick"),
    "n": ("", "right end of the stick zone", "m", "", "stick"),
    "d": ("", "size of a slip zone, or half-width of the stick zone", "m", "width", "slip|stick"),
    "e": ("", "eccentricity of the stick zone", "m", "shift|offset", "stick"),
    "R": ("", "relative radius of curvature", "m", "", ""),
    "phi": ("", "angle of a wedge's face", "rad", "", "wedge"),
    "Q": ("", "shear load", "N/m", "force", ""),
    "sigma": ("", "differential bulk tension", "Pa", "stress", "tension"),
    "E": ("", "Young's modulus", "Pa", "elastic", ""),
    "nu": ("", "Poisson's ratio", "-", "", ""),
    "mu": ("", "coefficient of friction", "-", "", "friction"),
    "Delta_Q": ("", "range of the shear load", "N/m", "force|change", ""),
    "Delta_P": ("", "range of the normal load", "N/m", "force|change", ""),
    "Delta_sigma": ("", "range of the differential bulk tension", "Pa", "change|stress", ""),
    "Delta_q": ("", "change in the shear traction", "Pa", "stress", ""),
    "Delta_K_T": (
        "",
        "change in the coefficient of 1/sqrt(s) in the shear traction",
        "Pa*sqrt(m)",
        "factor|multiplier|intensity",
        "",
    ),
    "Delta_a": ("", "movement of the edge", "m", "change", ""),
    "K_N": (
        "K_N_left(a, c)",
        "coefficient of sqrt(s) in the pressure",
        "Pa/sqrt(m)",
        "factor|multiplier|intensity",
        "",
    ),
    "K_T": (
        "",
        "coefficient of 1/sqrt(s) in the shear traction",
        "Pa*sqrt(m)",
        "factor|multiplier|intensity",
        "",
    ),
    "p": ("pressure(x, a, c)", "contact pressure", "Pa", "traction|stress", ""),
    "p_0": ("", "maximum contact pressure", "", "", ""),
    "q": ("", "shear traction", "Pa", "stress|shear", ""),
    "g": ("", "profile of the body", "m", "gap|shape|form", ""),
    "g_prime": ("", "slope of the profile", "rad", "", ""),
    "F": ("punch(s, s)", "weight of the flat punches", "Pa", "", "flat(?:-| | rigid )punch"),
    "P_prime": ("load_rate(a, c)", "slope of the contact law at fixed tilt", "Pa", "", ""),
    "a_prime": (
        "edge_ratio(a, c)",
        "change in the left edge divided by that in the right one",
        "-",
        "",
        "",
    ),
    "dQ": ("", "small change in the shear load", "N/m", "force", ""),
    "dP": ("", "small change in the normal load", "N/m", "force", ""),
    "dM": ("", "small change in the moment", "N", "", ""),
    "dsigma": ("", "small change in the bulk tension", "Pa", "", ""),
    "dP_dc": ("load_rate(a, c)", "slope of the contact law at fixed tilt", "Pa", "", ""),
    "dP_da": ("", "slope of the contact law", "Pa", "", ""),
    "gamma": ("", "a ratio or an angle", "", "", ""),
    "chi": ("", "modulus of elliptic integrals", "-", "", "elliptic"),
    "E_at_chi": (
        "elliptic_e(chi**2)",
        "complete elliptic integral of the second kind",
        "-",
        "",
        "elliptic",
    ),
    "K_at_chi": (
        "elliptic_k(chi**2)",
        "complete elliptic integral of the first kind",
        "-",
        "",
        "elliptic",
    ),
}
"""Proposals for common symbols: a formula of the body if there is one, a meaning, a unit, further
words of a paper that fit, and words without which the paper gives no reason for the proposal."""


_ARGUMENTS = {"p": "x", "F": "s"}
"""The arguments of proposed formulas, if they are not c."""


@dataclass(frozen=True)
class Proposal:
    """The formula, the meaning and the unit that a draft proposes for a symbol."""

    formula: str = ""
    meaning: str = ""
    unit: str = ""


def proposal(name: str, words: str = "", text: str = "") -> Proposal:
    """Return the proposal for a name, with or without its index and arguments.

    words: the description in the paper, which replaces the meaning and which formula and unit fit
    text: the text of the paper
    """
    stem = name.partition("_at_")[0]
    for known in (name, stem, re.sub(r"_(?:[0-9AB]|asy|LHS|RHS|star)(?=_|$)", "", stem)):
        if known not in PROPOSALS:
            continue
        formula, meaning, unit, fitting, needed = PROPOSALS[known]
        if needed and not _speaks_of(needed, known, text):
            break
        if words and not _fits(words, meaning, fitting):
            break
        exact = name in (known, f"{known}_at_{_ARGUMENTS.get(known, 'c')}")
        # an indexed angle, such as alpha_1, may be any quantity
        unit = "" if unit == "rad" and known not in (name, stem) else unit
        return Proposal(formula if exact else "", words or meaning, unit)
    return Proposal(meaning=words)


def _speaks_of(needed: str, name: str, text: str) -> bool:
    """Whether the text contains these words; for a single letter, whether it contains them near one
    of its occurrences."""
    letter = name if len(name) == 1 else rf"\\{name}"
    if not (len(name) == 1 or rf"\{name}" in GREEK):
        return bool(re.search(needed, text, re.IGNORECASE))
    for each in re.finditer(r"(?<![\\$])\$([^$]{1,80})\$", text):
        if re.search(rf"(?<![A-Za-z\\]){letter}(?![A-Za-z])", each[1]):
            around = text[max(each.start() - _NEAR, 0) : each.end() + _NEAR]
            if re.search(needed, around, re.IGNORECASE):
                return True
    return False


_NEAR = 150
"""The number of characters between a symbol and words that belong to it."""


def _fits(words: str, meaning: str, fitting: str) -> bool:
    """Whether a description in a paper may be that of a proposal."""
    own = {each for each in re.findall(r"[a-z]+", meaning.lower()) if each not in _SMALL}
    said = set(re.findall(r"[a-z]+", words.lower()))
    return bool(own & said) or bool(fitting and re.search(fitting, words, re.IGNORECASE))


_SMALL = frozenset(
    ("the", "a", "an", "of", "in", "or", "at", "over", "by", "to", "that", "one", "x", "normal")
) | {"right", "left", "contact"}
"""Words of a meaning that fit many symbols."""
_STOPS = "which|that|where|when|and|as|so|if|while|with|but|or|for|because|since"
_AFTER = (
    r"(?:,|\s)*(?:is|denotes|being|are(?!\s[^.$]*\sand\s))\s+(?:the|an?)\s+"
    rf"((?:(?!(?:{_STOPS})\b)[A-Za-z'-]+\s*)+)"
)
_BEFORE = r"\b(?:the|an?|The|An?)\s+((?:[A-Za-z'-]+\s+){0,4}[A-Za-z'-]+),?\s*$"
_LONGEST_BEFORE = 90
_MOST_WORDS = 8
"""The largest number of words in a meaning."""
_LINKS = "to|by|from|into|with|and|or|on|at|for|as|in|between|is|are|be|moves|under|until|than"
_QUANTITY = re.compile(
    r"(?:coefficient|radius|angle|modulus|range|change|size|rate|length|width|depth|centre|center"
    r"|work|half-\w+|semi-\w+|ratio|position|end|edge|distance|amplitude|slope|degree|number|force"
    r"|load|pressure|tension|stress|moment|curvature|factor|product|sum|mean|value)s?\b"
)
"""Nouns after which `of` belongs to the meaning."""


def described(text: str) -> dict[str, str]:
    r"""Find descriptions of symbols in the text, such as "normal load, $P$".

    The keys of the result are LaTeX without spaces and braces.
    """
    descriptions = dict[str, str]()
    for each in re.finditer(r"(?<![\\$])\$([^$]{1,40})\$", text):
        after = re.match(_AFTER, text[each.end() : each.end() + 2 * _LONGEST_BEFORE])
        start = max(0, each.start() - _LONGEST_BEFORE)
        before = re.search(_BEFORE, text[start : each.start()])
        words = _phrase(after[1]) if after else _noun(before[1]) if before else ""
        if words:
            descriptions.setdefault(_bare(each[1]), words)
    return descriptions


def _phrase(words: str) -> str:
    """Return a description that follows its symbol; empty if it does not end sensibly."""
    told = words.split()
    while told and re.fullmatch(f"{_LINKS}|of|the|an?", told[-1]):
        told.pop()
    return " ".join(told) if len(told) <= _MOST_WORDS else ""


def _noun(words: str) -> str:
    """Return the last noun before a symbol, such as depth in "a half-plane to the depth $z$"."""
    words = re.sub(r"\s+(?:being|is|are|called|denoted|say)$", "", words)
    told = re.split(rf"\b(?:{_LINKS})\s+(?:(?:the|an?)\s+)?", " ".join(words.split()) + " ")[-1]
    first, _, rest = told.partition(" of ")
    if rest and not _QUANTITY.search(first):
        told = rest
    return " ".join(re.sub(r"^(?:the|an?)\s+", "", told).split())


def words_for(spelled: str, descriptions: Mapping[str, str]) -> str:
    """Return the description of a symbol, regardless of its arguments and braces."""
    bare = _bare(spelled)
    return descriptions.get(bare, "") or descriptions.get(re.sub(r"\(.*\)$", "", bare), "")


def _bare(latex: str) -> str:
    return re.sub(r"[\s{}]|\\[,;:!]", "", latex)


def spellings(latex: str) -> dict[str, str]:
    """Return a name for the LaTeX of every symbol in a statement."""
    tokens = [re.sub(r"\s", "", token) for token in _TOKEN.findall(latex)]
    integrated = r"\int" in tokens or r"\pvint" in tokens
    names, position = dict[str, str](), 0
    while position < len(tokens):
        end, name = _symbol(tokens, position)
        if tokens[position] == r"\dd" and integrated:
            position += 1
            continue
        if name and usable(name):
            names[_spelled(tokens[position:end])] = name
        position = max(end, position + 1)
    return names


def _plain_ones(latex: str) -> Iterator[tuple[str, bool]]:
    """Yield the symbols printed without arguments, and whether a parenthesis follows."""
    tokens, position = [re.sub(r"\s", "", token) for token in _TOKEN.findall(latex)], 0
    while position < len(tokens):
        end, name = _symbol(tokens, position)
        if name and "_at_" not in name:
            yield _spelled(tokens[position:end]), tokens[end : end + 1] == ["("]
        position = max(end, position + 1)


def standing_alone(latex: str) -> set[str]:
    """Return the symbols that are printed without arguments and without following parentheses."""
    return {own for own, follows in _plain_ones(latex) if not follows}


def unclear_call(latex: str, spelled: Mapping[str, str], alone: Collection[str]) -> str:
    """Return a symbol for which it is unclear whether the parentheses after it are its argument.

    Such a symbol is a function wherever else it occurs.  The result is empty if there is none.
    """
    functions = {own.partition("(")[0] for own, name in spelled.items() if "_at_" in name}
    unclear = functions - set(alone)
    return next((own for own, follows in _plain_ones(latex) if follows and own in unclear), "")


def _spelled(tokens: Sequence[str]) -> str:
    text = ""
    for token in tokens:
        text += " " if re.search(r"\\[A-Za-z]+$", text) and token[0].isalpha() else ""
        text += token
    return text


def _symbol(tokens: Sequence[str], position: int) -> tuple[int, str]:
    """Return the end and the name of the symbol that starts here; without one the name is ""."""
    if position >= len(tokens):
        return position, ""
    head = tokens[position]
    if head == r"\frac":
        return _derivative(tokens, position)
    if head in (r"\dd", r"\Delta") and position + 1 < len(tokens):
        end, name = _symbol(tokens, position + 1)
        if name and tokens[position + 1] not in (r"\dd", r"\Delta", r"\frac"):
            return end, ("d" if head == r"\dd" else "Delta_") + name
    if head in _ACCENTS:
        inner, end = _group(tokens, position + 1)
        stop, name = _symbol(inner, 0)
        if not name or stop != len(inner):
            return position, ""
        end, name = _hung(tokens, end, f"{name}_{_ACCENTS[head]}")
        return _called(tokens, end, name)
    if not (len(head) == 1 and head.isalpha()) and head not in GREEK:
        return position, ""
    if head == r"\Gamma" and tokens[position + 1 : position + 2] == ["("]:
        return position, ""
    name, position = letter_name(head), position + 1
    position, name = _hung(tokens, position, name)
    return _called(tokens, position, name)


def letter_name(letter: str) -> str:
    r"""Return the name of a letter; \lambda is lam, because formulas may not hold lambda."""
    return "lam" if letter == r"\lambda" else letter.removeprefix("\\")


def _hung(tokens: Sequence[str], position: int, name: str) -> tuple[int, str]:
    """Read the indices, primes, stars and words that follow a letter."""
    while position < len(tokens):
        if tokens[position] == "'":
            name, position = f"{name}_prime", position + 1
            continue
        if tokens[position] not in "_^":
            break
        inner, end = _group(tokens, position + 1)
        words = [t.removeprefix("\\") for t in inner if t not in "(),"]
        plain = _plain(words)
        if tokens[position] == "_" and plain:
            name = f"{name}_{_index(inner)}"
        elif inner in (["+"], ["-"]):
            name = f"{name}_{_SIDES[inner[0]]}"
        elif tokens[position] == "_" and _is_sided(inner):
            name = f"{name}_{_index(inner[:-1])}_{_SIDES[inner[-1]]}"
        elif inner == ["*"]:
            name = f"{name}_star"
        elif inner == ["'"]:
            name = f"{name}_prime"
        elif plain and (inner[0] == "(" or len(inner) > 1) and all(w.isalpha() for w in words):
            name = f"{name}_{''.join(words)}"
        else:
            break
        position = end
    return position, name


def _is_sided(inner: Sequence[str]) -> bool:
    """Whether an index ends with a sign after a comma, as in K_{N,+}."""
    words = [token.removeprefix("\\") for token in inner[:-2]]
    return inner[-1:] != [] and inner[-1] in _SIDES and inner[-2:-1] == [","] and _plain(words)


def _plain(words: Sequence[str]) -> bool:
    return bool(words) and all(word.isalnum() for word in words)


def _index(inner: Sequence[str]) -> str:
    parts = "".join(t.removeprefix("\\") for t in inner if t not in "()").split(",")
    return "_".join(filter(None, parts))


def _group(tokens: Sequence[str], position: int) -> tuple[list[str], int]:
    """Return the content of the brackets here, or one token, and where it ends."""
    if position >= len(tokens):
        return [], position
    closing = {"{": "}", "(": ")"}.get(tokens[position])
    if closing is None:
        return [tokens[position]], position + 1
    depth = 0
    for end in range(position, len(tokens)):
        depth += (tokens[end] == tokens[position]) - (tokens[end] == closing)
        if depth == 0:
            return list(tokens[position + 1 : end]), end + 1
    return [], len(tokens)


def _called(tokens: Sequence[str], position: int, name: str) -> tuple[int, str]:
    """Add the arguments to a name if it is printed as a function."""
    if position >= len(tokens) or tokens[position] != "(":
        return position, name
    inner, end = _group(tokens, position)
    arguments, depth = [list[str]()], 0
    for token in inner:
        depth += (token in "({") - (token in ")}")
        if token in (",", ";") and depth == 0:
            arguments.append([])
        else:
            arguments[-1].append(token)
    symbols = [
        (1, argument[0]) if len(argument) == 1 and argument[0].isdigit() else _symbol(argument, 0)
        for argument in arguments
    ]
    alone = all(n and e == len(a) for a, (e, n) in zip(arguments, symbols, strict=True))
    if not alone or not inner:
        return position, name
    return end, f"{name}_at_{'_'.join(n for _, n in symbols)}"


def _derivative(tokens: Sequence[str], position: int) -> tuple[int, str]:
    """Read a quotient of two differentials, such as dP/dc or its second derivative."""
    numerator, middle = _group(tokens, position + 1)
    denominator, end = _group(tokens, middle)
    if not numerator or not denominator or {numerator[0], denominator[0]} - {r"\dd", r"\partial"}:
        return position, ""
    order = ""
    if numerator[1:2] == ["^"]:
        inner, after = _group(numerator, 2)
        order, numerator = "".join(inner), [numerator[0], *numerator[after:]]
        count = 1 if denominator[-2:] == ["^", order] else 3
        if (
            not order.isdigit()
            or denominator[-count - 1 :][:1] != ["^"]
            or order not in denominator[-count:]
        ):
            return position, ""
        denominator = denominator[: -count - 1]
    names = []
    for part in (numerator, denominator):
        stop, name = _symbol(part, 1)
        if not name or stop != len(part):
            return position, ""
        names.append(name)
    return end, f"d{order}{names[0]}_d{names[1]}{order}"
