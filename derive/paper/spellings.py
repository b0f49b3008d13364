r"""Which symbols a statement in LaTeX holds, how they are spelled there, and what to call them.

A letter with all that is hung on it is one symbol: K_{N,c}, E^*, \Delta Q, q_1^{(asy)}(x).
A letter before one symbol in parentheses, before a list, or with a prime, is a function of them
and is one symbol too: p(x) and p(x, c) are two.  A person sees every spelling in the draft.
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
    "c": ("", "right edge of the contact, or of the stick zone", "m"),
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
    "p_0": ("", "largest contact pressure", ""),
    "q": ("", "shear traction", "Pa"),
    "g": ("", "profile of the body", "m"),
    "g_prime": ("", "slope of the profile", "rad"),
    "F": ("punch(s, s)", "weight of the flat punches", "Pa"),
    "P_prime": ("load_rate(a, c)", "slope of the contact law at fixed tilt", "Pa"),
    "a_prime": ("edge_ratio(a, c)", "left edge against right at fixed tilt", "-"),
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
"""What the toolkit's own vocabulary suggests: a formula of the body if any, words, and a unit."""


@dataclass(frozen=True)
class Proposal:
    """What a symbol may be, as a draft proposes it."""

    formula: str = ""
    meaning: str = ""
    unit: str = ""


def proposal(name: str) -> Proposal:
    """What a symbol may be, by its name or the name without index and arguments."""
    stem = name.partition("_at_")[0]
    for known in (name, stem, re.sub(r"_(?:[0-9itABZS]|asy|LHS|RHS|star|[ac])(?=_|$)", "", stem)):
        if known in PROPOSALS:
            formula, words, unit = PROPOSALS[known]
            exact = known == name or name.removeprefix(known) in ("_at_x", "_at_c")
            unit = "" if unit == "rad" and known not in (name, stem) else unit  # alpha_1 is any
            return Proposal(formula if exact else "", words, unit)
    return Proposal()


_AFTER = r"(?:,|\s)*(?:is|denotes|are|being)\s+(?:the|an?)\s+([A-Za-z][^.,;:$\\()]{2,60})"
_BEFORE = r"\b(?:the|an?|The|An?)\s+((?:[A-Za-z-]+\s+){0,4}[A-Za-z-]+),?\s*$"
_LONGEST_BEFORE = 90


def described(text: str) -> dict[str, str]:
    r"""What the text says of symbols, LaTeX without blanks -> words: "normal load, $P$"."""
    found = dict[str, str]()
    for each in re.finditer(r"(?<![\\$])\$([^$]{1,40})\$", text):
        after = re.match(_AFTER, text[each.end() : each.end() + _LONGEST_BEFORE])
        start = max(0, each.start() - _LONGEST_BEFORE)
        before = re.search(_BEFORE, text[start : each.start()])
        words = after[1] if after else before[1] if before else ""
        if words:
            found.setdefault(_bare(each[1]), " ".join(words.split()))
    return found


def words_for(spelled: str, said: Mapping[str, str]) -> str:
    """What the text says of a symbol, its arguments and ways to write braces left aside."""
    bare = _bare(spelled)
    return said.get(bare, "") or said.get(re.sub(r"\(.*\)$", "", bare), "")


def _bare(latex: str) -> str:
    return re.sub(r"[\s{}]|\\[,;:!]", "", latex)


def spellings(latex: str) -> dict[str, str]:
    """LaTeX of every symbol of a statement -> a name for it."""
    tokens = [re.sub(r"\s", "", token) for token in _TOKEN.findall(latex)]
    integrated = r"\int" in tokens or r"\pvint" in tokens
    found, place = dict[str, str](), 0
    while place < len(tokens):
        end, name = _symbol(tokens, place)
        if tokens[place] == r"\dd" and integrated:
            place += 1
            continue
        if name and usable(name):
            found[_spelled(tokens[place:end])] = name
        place = max(end, place + 1)
    return found


def _plain_ones(latex: str) -> Iterator[tuple[str, bool]]:
    """Symbols that are printed without arguments, and whether parentheses follow."""
    tokens, place = [re.sub(r"\s", "", token) for token in _TOKEN.findall(latex)], 0
    while place < len(tokens):
        end, name = _symbol(tokens, place)
        if name and "_at_" not in name:
            yield _spelled(tokens[place:end]), tokens[end : end + 1] == ["("]
        place = max(end, place + 1)


def standing_alone(latex: str) -> set[str]:
    """Symbols that are printed without arguments and without parentheses behind them."""
    return {own for own, follows in _plain_ones(latex) if not follows}


def unclear_call(latex: str, spelled: Mapping[str, str], alone: Collection[str]) -> str:
    """A symbol that is a function wherever it stands else, before what may be its argument or not.

    Empty if there is none.
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


def _symbol(tokens: Sequence[str], place: int) -> tuple[int, str]:
    """Where the symbol that starts here ends, and its name; no name if none starts here."""
    if place >= len(tokens):
        return place, ""
    head = tokens[place]
    if head == r"\frac":
        return _derivative(tokens, place)
    if head in (r"\dd", r"\Delta") and place + 1 < len(tokens):
        end, name = _symbol(tokens, place + 1)
        if name and tokens[place + 1] not in (r"\dd", r"\Delta", r"\frac"):
            return end, ("d" if head == r"\dd" else "Delta_") + name
    if head in _ACCENTS:
        inner, end = _group(tokens, place + 1)
        stop, name = _symbol(inner, 0)
        if not name or stop != len(inner):
            return place, ""
        end, name = _hung(tokens, end, f"{name}_{_ACCENTS[head]}")
        return _called(tokens, end, name)
    if not (len(head) == 1 and head.isalpha()) and head not in _GREEK:
        return place, ""
    if head == r"\Gamma" and tokens[place + 1 : place + 2] == ["("]:
        return place, ""
    name, place = head.removeprefix("\\"), place + 1
    place, name = _hung(tokens, place, name)
    return _called(tokens, place, name)


def _hung(tokens: Sequence[str], place: int, name: str) -> tuple[int, str]:
    """Indices, primes, stars and words in the exponent."""
    while place < len(tokens):
        if tokens[place] == "'":
            name, place = f"{name}_prime", place + 1
            continue
        if tokens[place] not in "_^":
            break
        inner, end = _group(tokens, place + 1)
        words = [t.removeprefix("\\") for t in inner if t not in "(),"]
        plain = bool(words) and all(word.isalnum() for word in words)
        if tokens[place] == "_" and plain:
            name = f"{name}_{_index(inner)}"
        elif inner == ["*"]:
            name = f"{name}_star"
        elif inner == ["'"]:
            name = f"{name}_prime"
        elif plain and (inner[0] == "(" or len(inner) > 1) and all(w.isalpha() for w in words):
            name = f"{name}_{''.join(words)}"
        else:
            break
        place = end
    return place, name


def _index(inner: Sequence[str]) -> str:
    parts = "".join(t.removeprefix("\\") for t in inner if t not in "()").split(",")
    return "_".join(filter(None, parts))


def _group(tokens: Sequence[str], place: int) -> tuple[list[str], int]:
    """What stands in the brackets here, or the one token, and where that ends."""
    if place >= len(tokens):
        return [], place
    closing = {"{": "}", "(": ")"}.get(tokens[place])
    if closing is None:
        return [tokens[place]], place + 1
    depth = 0
    for end in range(place, len(tokens)):
        depth += (tokens[end] == tokens[place]) - (tokens[end] == closing)
        if depth == 0:
            return list(tokens[place + 1 : end]), end + 1
    return [], len(tokens)


def _called(tokens: Sequence[str], place: int, name: str) -> tuple[int, str]:
    """The name with its arguments, if it is printed as a function of them."""
    if place >= len(tokens) or tokens[place] != "(":
        return place, name
    inner, end = _group(tokens, place)
    arguments, depth = [list[str]()], 0
    for token in inner:
        depth += (token in "({") - (token in ")}")
        if token == "," and depth == 0:
            arguments.append([])
        else:
            arguments[-1].append(token)
    one = [
        (1, argument[0]) if len(argument) == 1 and argument[0].isdigit() else _symbol(argument, 0)
        for argument in arguments
    ]
    alone = all(n and e == len(a) for a, (e, n) in zip(arguments, one, strict=True))
    if not alone or not inner:
        return place, name
    return end, f"{name}_at_{'_'.join(n for _, n in one)}"


def _derivative(tokens: Sequence[str], place: int) -> tuple[int, str]:
    """A quotient of two differentials, which may be second ones."""
    over, middle = _group(tokens, place + 1)
    under, end = _group(tokens, middle)
    if not over or not under or {over[0], under[0]} - {r"\dd", r"\partial"}:
        return place, ""
    order = ""
    if over[1:2] == ["^"]:
        inner, after = _group(over, 2)
        order, over = "".join(inner), [over[0], *over[after:]]
        count = 1 if under[-2:] == ["^", order] else 3
        if not order.isdigit() or under[-count - 1 :][:1] != ["^"] or order not in under[-count:]:
            return place, ""
        under = under[: -count - 1]
    names = []
    for part in (over, under):
        stop, name = _symbol(part, 1)
        if not name or stop != len(part):
            return place, ""
        names.append(name)
    return end, f"d{order}{names[0]}_d{names[1]}{order}"
