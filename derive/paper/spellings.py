r"""Find the symbols in a LaTeX statement, and propose a name for each.

A letter with all its indices and accents is one symbol: K_{N,c}, E^*, \Delta Q, q_1^{(asy)}(x).
A letter followed by a symbol, or a list of symbols, in parentheses is a function, which is one
symbol as well; p(x) and p(x, c) are two different symbols.  The draft lists every spelling, so
that the user can check it.
"""

import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass

from derive.paper.formula import usable

_TOKEN = re.compile(r"\\(?:begin|end)\s*\{[a-z]+\}|\\[A-Za-z]+|\\.|[0-9]+(?:\.[0-9]+)?|\S")
_NAMES = """
alpha beta gamma delta epsilon varepsilon zeta eta theta vartheta iota kappa lambda mu nu xi rho
varrho sigma tau upsilon phi varphi chi psi omega ell Gamma Delta Theta Lambda Xi Pi Sigma Upsilon
Phi Psi Omega
"""
_ACCENTS = {
    **{rf"\{name}": name for name in ("bar", "hat", "tilde", "dot", "vec")},
    **{r"\overline": "bar", r"\widehat": "hat", r"\widetilde": "tilde"},
}
_GREEK = frozenset(f"\\{name}" for name in _NAMES.split())
PROPOSALS = {
    "P": ("load(a, c)", "normal load", "N/m"),
    "M": ("moment(a, c)", "moment", "N"),
    "alpha": ("tilt(a, c)", "angle of tilt", "rad"),
    "a": ("", "left edge of the contact at x = -a, or half-width", "m"),
    "b": ("", "a length of the profile, or half-width", "m"),
    "c": ("", "right edge of the contact, or right end of the stick zone", "m"),
    "m": ("", "left end of the stick zone", "m"),
    "n": ("", "right end of the stick zone", "m"),
    "d": ("", "size of a slip zone, or half-width of the stick zone", "m"),
    "e": ("", "eccentricity of the stick zone", "m"),
    "R": ("", "relative radius of curvature", "m"),
    "phi": ("", "angle of a wedge's face", "rad"),
    "Q": ("", "shear load", "N/m"),
    "sigma": ("", "differential bulk tension", "Pa"),
    "E": ("", "Young's modulus", "Pa"),
    "nu": ("", "Poisson's ratio", "-"),
    "mu": ("", "coefficient of friction", "-"),
    "Delta_Q": ("", "range of the shear load", "N/m"),
    "Delta_P": ("", "range of the normal load", "N/m"),
    "Delta_sigma": ("", "range of the differential bulk tension", "Pa"),
    "Delta_q": ("", "change of the shear traction", "Pa"),
    "Delta_K_T": ("", "change of the coefficient of 1/sqrt(s) in the shear traction", "Pa*sqrt(m)"),
    "Delta_a": ("", "movement of the edge", "m"),
    "K_N": ("K_N_left(a, c)", "coefficient of sqrt(s) in the pressure", "Pa/sqrt(m)"),
    "K_T": ("", "coefficient of 1/sqrt(s) in the shear traction", "Pa*sqrt(m)"),
    "p": ("pressure(x, a, c)", "contact pressure", "Pa"),
    "p_0": ("", "maximum contact pressure", ""),
    "q": ("", "shear traction", "Pa"),
    "g": ("", "profile of the body", "m"),
    "g_prime": ("", "slope of the profile", "rad"),
    "F": ("punch(s, s)", "weight of the flat punches", "Pa"),
    "P_prime": ("load_rate(a, c)", "slope of the contact law at fixed tilt", "Pa"),
    "a_prime": ("edge_ratio(a, c)", "change of the left edge over that of the right one", "-"),
    "dQ": ("", "small change of the shear load", "N/m"),
    "dP": ("", "small change of the normal load", "N/m"),
    "dM": ("", "small change of the moment", "N"),
    "dsigma": ("", "small change of the bulk tension", "Pa"),
    "dP_dc": ("load_rate(a, c)", "slope of the contact law at fixed tilt", "Pa"),
    "dP_da": ("", "slope of the contact law", "Pa"),
    "gamma": ("", "a ratio or an angle", ""),
    "chi": ("", "modulus of elliptic integrals", "-"),
    "E_at_chi": ("elliptic_e(chi**2)", "complete elliptic integral of the second kind", "-"),
    "K_at_chi": ("elliptic_k(chi**2)", "complete elliptic integral of the first kind", "-"),
}
"""Proposals for common symbols: a formula of the body if there is one, a meaning, and a unit."""


@dataclass(frozen=True)
class Proposal:
    """The formula, the meaning and the unit that a draft proposes for a symbol."""

    formula: str = ""
    meaning: str = ""
    unit: str = ""


def proposal(name: str) -> Proposal:
    """Return the proposal for a name, with or without its index and arguments."""
    stem = name.partition("_at_")[0]
    for known in (name, stem, re.sub(r"_(?:[0-9itABZS]|asy|LHS|RHS|star|[ac])(?=_|$)", "", stem)):
        if known in PROPOSALS:
            formula, words, unit = PROPOSALS[known]
            exact = known == name or name.removeprefix(known) in ("_at_x", "_at_c")
            # an indexed angle, such as alpha_1, may be any quantity
            unit = "" if unit == "rad" and known not in (name, stem) else unit
            return Proposal(formula if exact else "", words, unit)
    return Proposal()


_AFTER = r"(?:,|\s)*(?:is|denotes|are|being)\s+(?:the|an?)\s+([A-Za-z][^.,;:$\\()]{2,60})"
_BEFORE = r"\b(?:the|an?|The|An?)\s+((?:[A-Za-z-]+\s+){0,4}[A-Za-z-]+),?\s*$"
_LONGEST_BEFORE = 90


def described(text: str) -> dict[str, str]:
    r"""Find descriptions of symbols in the text, such as "normal load, $P$".

    The keys of the result are LaTeX without spaces and braces.
    """
    descriptions = dict[str, str]()
    for each in re.finditer(r"(?<![\\$])\$([^$]{1,40})\$", text):
        after = re.match(_AFTER, text[each.end() : each.end() + _LONGEST_BEFORE])
        start = max(0, each.start() - _LONGEST_BEFORE)
        before = re.search(_BEFORE, text[start : each.start()])
        words = after[1] if after else before[1] if before else ""
        if words:
            descriptions.setdefault(_bare(each[1]), " ".join(words.split()))
    return descriptions


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
    if not (len(head) == 1 and head.isalpha()) and head not in _GREEK:
        return position, ""
    if head == r"\Gamma" and tokens[position + 1 : position + 2] == ["("]:
        return position, ""
    name, position = head.removeprefix("\\"), position + 1
    position, name = _hung(tokens, position, name)
    return _called(tokens, position, name)


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
        plain = bool(words) and all(word.isalnum() for word in words)
        if tokens[position] == "_" and plain:
            name = f"{name}_{_index(inner)}"
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
        if token == "," and depth == 0:
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
