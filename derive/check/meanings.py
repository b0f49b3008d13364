r"""The standard meanings of a paper's letters, from the four answers in its claims file.

In:   the answers: the body, whether the contact is symmetric, the letters and the modulus.
Out:  Standard: the variables, and the formulas of the symbols, in the letters of the paper.

A line of the file beats the standard meaning of its symbol.
"""

import re
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

from msgspec.structs import replace as with_entries

from derive.body.geometry import Geometry
from derive.check.schema import Answers, DefinedSymbol, Place, Variable
from derive.reading.formula import usable
from derive.reading.lexer import Unclear, tokens_of
from derive.reading.spellings import spellings

_TABLE = """
a; ; m; half-width of the contact; symmetric
a; ; m; left edge of the contact, at x = -a; general
c; ; m; right edge of the contact, at x = c; general
m; ; m; half-width of the stick zone; even
m; ; m; left end of the stick zone, at x = -m; uneven
n; ; m; right end of the stick zone, at x = n; uneven
d; ; m; half-width of the stick zone; eccentric
e; ; m; eccentricity: the middle of the stick zone is at x = e; eccentric
E_star; ; Pa; composite modulus
f; ; -; coefficient of friction
nu; ; -; Poisson's ratio; nu
kappa; ; -; Kolosov's constant, 3 - 4 nu; kappa
E; 2*E_star*(1 - nu**2); Pa; Young's modulus of two similar bodies; nu similar
E; E_star*(1 - nu**2); Pa; Young's modulus, the other body is rigid; nu rigid
mu; E_star*(kappa + 1)/4; Pa; shear modulus of two similar bodies; kappa similar
mu; E_star*(kappa + 1)/8; Pa; shear modulus, the other body is rigid; kappa rigid

width; left + right; m; width of the contact
half_width; (left + right)/2; m; half-width of the contact
middle; (right - left)/2; m; middle of the contact; general
m; d - e; m; left end of the stick zone, at x = -m; eccentric
n; d + e; m; right end of the stick zone, at x = n; eccentric
d; (m + n)/2; m; half-width of the stick zone; uneven
e; (n - m)/2; m; eccentricity: the middle of the stick zone is at x = e; uneven
stick_width; stick_left + stick_right; m; width of the stick zone
d_left; left - (stick_left); m; width of the left slip zone
d_right; right - (stick_right); m; width of the right slip zone

P; load(edges); N/m; normal load
[P]_0; load(edges); N/m; normal load, which is constant
M; moment(edges); N; moment, positive with the tilt; general
alpha; tilt(edges); rad; tilt, positive anticlockwise; general
p; pressure(x, edges); Pa; contact pressure
[p]_0; pressure(0, edges); Pa; largest pressure; symmetric hertz
[p]_0; pressure((c - a)/2, edges); Pa; largest pressure; general hertz
[p]_max; pressure(0, edges); Pa; largest pressure; symmetric hertz
[p]_max; pressure((c - a)/2, edges); Pa; largest pressure; general hertz
[p]_m; load(edges)/(left + right); Pa; mean pressure
K_N; K_N_right(edges); Pa/sqrt(m); coefficient of sqrt(s) in p at an edge; symmetric
[K_N]_[a]; K_N_left(edges); Pa/sqrt(m); coefficient of sqrt(s) in p at the left edge; general
[K_N]_[c]; K_N_right(edges); Pa/sqrt(m); coefficient of sqrt(s) in p at the right edge; general
d[P]_d[a]; load_rate(edges); Pa; slope of the contact law; symmetric
[P]_prime; load_rate(edges); Pa; slope of the contact law at fixed tilt
[a]_prime; edge_ratio(edges); -; change in the left edge over that in the right one; general

Q; f*(load(edges) - load(stick)); N/m; shear load, at constant normal load
[Q]_max; f*(load(edges) - load(stick)); N/m; largest shear load, at constant normal load
q; f*(pressure(x, edges) - stick_pressure); Pa; shear traction at the largest shear load
d[Q]_d[m]; -f*load_rate(stick); Pa; slope of the shear load at constant normal load; symmetric even
sigma; 2*f*E_star*(tilt(edges) - tilt(stick)); Pa; bulk tension on first loading; tension
Delta_[Q]; 2*f*(load(edges) - load(stick)); N/m; range of the shear load
Delta_[sigma]; 4*f*E_star*(tilt(edges) - tilt(stick)); Pa; range of the bulk tension; tension
"""
"""Our letter, formula, unit, meaning, and the cases in which the row applies, all of which must be
true.  A letter without a formula is a variable.  Parts in brackets follow the paper's letters: if a
is l, d[P]_d[a] is dP_dl.  `left` and `right`, or both as `edges`, are the ends of the contact, and
likewise those of the stick zone.  `stick_pressure` is that of the stick zone, zero beside it."""
_RANGES = {"nu": (0.0, 0.5), "kappa": (1.0, 3.0)}
_STICK = {"even": ("m", "m"), "uneven": ("m", "n"), "eccentric": ("d - e", "d + e")}
_ENDS = {"even": "its half-width alone", "uneven": "its two ends", "eccentric": "d and e"}
_CONSTANTS = {"E", "mu"}
_ABSENT = {
    "symmetric": "the contact is not symmetric",
    "general": "the contact is symmetric",
    "hertz": "the body is not hertz",
    "nu": "the elastic constants are {modulus}",
    "kappa": "the elastic constants are {modulus}",
    "": "the stick zone is given by {ends}",
}
"""The reasons why rows with these cases do not apply, of which the first is given."""


class _Row(NamedTuple):
    """What one of our letters means; the formula of a variable is empty."""

    pattern: str
    formula: str
    unit: str
    meaning: str
    cases: frozenset[str] = frozenset()

    @property
    def letter(self) -> str:
        """Our letter."""
        return re.sub(r"[][]", "", self.pattern)


_ROWS = [
    _Row(letter, formula, unit, meaning, frozenset("".join(cases).split()))
    for letter, formula, unit, meaning, *cases in (
        re.split(r"\s*;\s*", row) for row in _TABLE.splitlines() if row
    )
]


@dataclass(frozen=True)
class Standard:
    """The standard meanings of a paper.

    letters     our letters for variables and parameters -> names of the paper
    variables   these variables and parameters
    symbols     the other names of the paper
    conditions  what is true of the variables in every claim
    absent      the names that have a standard meaning for other answers, with the reason why not
    body        the name of the body
    answers     the other answers; None if there are none
    """

    letters: Mapping[str, str]
    variables: Mapping[str, Variable] = field(default_factory=dict)
    symbols: Mapping[str, DefinedSymbol] = field(default_factory=dict)
    conditions: tuple[str, ...] = ()
    absent: Mapping[str, str] = field(default_factory=dict)
    body: str = "hertz"
    answers: Answers | None = None

    def reasons(self, names: Iterable[str]) -> str:
        """Say of those names that could have a standard meaning why they have none."""
        told = ((name, self.absent[name]) for name in names if name in self.absent)
        return "".join(f"; {name} has no standard meaning, because {why}" for name, why in told)

    def of(self, names: Collection[str], given: Iterable[str] = ()) -> dict[str, DefinedSymbol]:
        """Return the meanings of those names that have a standard meaning, also p_at_b for p(b).

        given: names with another meaning; if p or p(x) is one of them, p(b) has no standard meaning
        """
        found, others = dict[str, DefinedSymbol](), {*given}
        for name in sorted(names):
            stem, _, at = name.partition("_at_")
            entry, is_free = self.symbols.get(stem), others.isdisjoint((name, stem, f"{stem}_at_x"))
            is_place = entry and "(x, " in entry.text and (at.isdigit() or at in names)
            if entry and is_free and (is_place or not at):
                formula = re.sub(r"\bx\b", at or "x", entry.text)
                found[name] = with_entries(entry, formula=formula)
        return found


NONE = Standard({"E_star": "E_star", "f": "f"})
"""No standard meanings; our letters are those of every body."""


def standard(answers: Answers, geometry: Geometry, place: Place) -> Standard:
    """Return the standard meanings; raise BadClaimsFile if a letter has two meanings."""
    said = {ours: _name_of(theirs) for ours, theirs in answers.letters.items()}
    zone, edges = _zone(answers), ("a", "a" if answers.symmetric else "c")
    stick, words = _STICK[zone], {*re.findall(r"\w+", answers.modulus)}
    cases = words | {geometry.name, zone, "symmetric" if answers.symmetric else "general"}
    cases |= {"tension"} if zone != "even" else set()
    cases |= {"similar"} if "rigid" not in words else set()
    rows = {row.letter: row for row in _ROWS if row.cases <= cases}
    rows |= {q.name: _Row(q.name, "", q.unit, q.meaning) for q in geometry.parameters}
    letters = {ours: said.get(ours, ours) for ours, row in rows.items() if not row.formula}
    names = letters | {ours: ours for ours in _CONSTANTS & rows.keys()} | said
    _demand_clear(names, rows.keys(), place)
    ends = {"edges": ", ".join(edges), "stick": ", ".join(stick)}
    inside = f"-({stick[0]}) < x and x < {stick[1]}"
    ends |= {"stick_pressure": f"Piecewise((pressure(x, {ends['stick']}), {inside}), (0, True))"}
    ends |= {"left": edges[0], "right": edges[1], "stick_left": stick[0], "stick_right": stick[1]}
    variables, symbols = dict[str, Variable](), dict[str, DefinedSymbol]()
    for ours, row in rows.items():
        name = names.get(ours) or _replaced(_PARTS, names, row.pattern)
        if not row.formula:
            low, high = _RANGES.get(ours, (None, None))
            variables[name] = Variable(row.meaning, row.unit, low, high)
        elif ours in names or name not in names.values():
            formula = _replaced(_WORD, letters, _replaced(_WORD, ends, row.formula))
            formula = re.sub(r"(?<!\w)\((\w+)\)", r"\1", formula)
            symbols[name] = DefinedSymbol(row.meaning, row.unit, formula)
    within = {f"{end} < {edge}" for end, edge in zip(stick, edges, strict=True)}
    conditions = tuple(_replaced(_WORD, letters, each) for each in sorted(within))
    known = {*rows, *names.values(), *variables, *symbols}
    absent = dict[str, str]()
    for row in sorted(_ROWS, key=lambda row: -len(row.cases - cases)):
        name, missing = _replaced(_PARTS, names, row.pattern), row.cases - cases | {""}
        if row.letter not in known and name not in known:
            why = next(why for case, why in _ABSENT.items() if case in missing)
            absent[name] = why.format(modulus=answers.modulus, ends=_ENDS[zone])
    return Standard(letters, variables, symbols, conditions, absent, geometry.name, answers)


def _zone(answers: Answers) -> str:
    """Return how the ends of the stick zone are written, which the given letters show."""
    if answers.letters.keys() & {"d", "e"} and not answers.letters.keys() & {"m", "n"}:
        return "eccentric"
    return "even" if answers.symmetric and "n" not in answers.letters else "uneven"


def _demand_clear(names: Mapping[str, str], known: Collection[str], place: Place) -> None:
    """Refuse a letter that is not ours, that no formula can hold, or that has two meanings."""
    for ours, theirs in names.items():
        why = f"letters: {ours!r} is not one of our letters for this contact"
        place.demand(ours in known, why, f"use one of {', '.join(sorted(known))}")
        why = f"letters: {theirs!r} cannot be the name of a symbol"
        place.demand(usable(theirs), why, r"write one letter, such as b, \mu or K_a")
        others = [each for each, name in names.items() if name == theirs and each != ours]
        why = f"letters: {theirs} would stand for {ours} and for {', '.join(others)}"
        place.demand(not others, why, f"also give the paper's letter for {ours}: {ours} = ...")


_PARTS = r"\[(\w+)\]"
_WORD = r"\b([A-Za-z]\w*)\b(?!\()"
"""A name that is not called."""


def _replaced(pattern: str, names: Mapping[str, str], text: str) -> str:
    """Replace the names that a pattern finds in a text."""
    return re.sub(pattern, lambda found: names.get(found[1], found[1]), text)


def _name_of(letter: str) -> str:
    r"""Return the name of a letter, which may be given in LaTeX: mu for \mu, K_N_a for K_{N,a}."""
    try:
        names = [*spellings(tokens_of(letter)).values()]
    except Unclear:
        return letter
    return names[0] if len(names) == 1 else letter.strip()
