"""Represent a claim, which is one printed equation or one statement in words, as data.

Both sides of a claim are written in the symbols of the source.  `meaning` expresses each of these
symbols in terms of our variables: as a formula of a sheet, an integral, a root of the conditions of
stick, or another symbol.  A change of sign is an ordinary entry of this mapping, such as `M: -M`.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from enum import StrEnum
from typing import Any

from mpmath import mpf
from sympy import Expr, Rational, S, Symbol
from sympy.logic.boolalg import Boolean

from derive.check.schema import Entry, Reinterpretation, Verdict
from derive.reading.relation import Relation

__all__ = ["Verdict"]

Meaning = Mapping[Symbol, Expr]
Point = dict[Symbol, mpf]


@dataclass(frozen=True)
class Range:
    """The range of a variable: its bounds, or the bounds of its exponent as a power of two."""

    low: float
    high: float
    powers: bool = False

    @property
    def place(self) -> Expr:
        """A simple number in the range."""
        if self.powers or self.low < 1 < self.high:
            return S.One
        return Rational(str((self.low + self.high) / 2))


SCALE = Range(-1.5, 1.5, powers=True)
"""The range of lengths, loads and moduli; formulas are homogeneous in them."""
SIGNED = Range(-2, 2)


@dataclass(frozen=True)
class Rounded:
    """A constant that is printed rounded and is a factor of one side.

    value  the printed number
    half   half a unit of its last printed digit
    power  the power of the constant in the ratio right/left
    """

    value: Rational
    half: Rational
    power: int


class Basis(StrEnum):
    """What the verdict on a claim rests on."""

    BODY = "the body"
    BOTH = "the body and your definitions"
    """A parameter of the body has a meaning of its own in the claim."""
    DEFINITIONS = "your definitions"
    GIVEN = "given"
    MATHEMATICS = "mathematics"

    @property
    def word(self) -> str:
        """The same in short, for tables."""
        return ", ".join(each.split()[-1] for each in self.split(" and "))

    @property
    def parts(self) -> list[str]:
        """The same for programs; mathematics alone has no parts."""
        return [part for part in ("body", "definition", "given") if part in self]


@dataclass(frozen=True)
class AsMeant:
    """The comparison that a claim stands for.

    left, right  the printed sides, in the source's symbols
    relation     the relation between them
    meaning      the meanings of the source's symbols, in our variables
    reached      for a bound, of which `meaning` describes the state in which it is just reached:
                 the entries that change where it is met, and those where it is exceeded
    through      two expressions that must agree when the symbol `left` is replaced by `right`;
                 used for a definition, which cannot be wrong by itself
    toward       for a claim about a limit, the expression in our variables and its end
    conventions  sign conventions that are tried if the claim is not true as printed, each with the
                 entries that replace those of the meaning
    ranges       ranges of our variables; the others are positive and have the range SCALE
    conditions   conditions, in our variables, that every point must satisfy
    cases        the points to use, with numbers as text, if more would take too long
    basis        what the verdict rests on, unless the body's formulas turn out not to matter
    called       the sides to compare, in our variables, with the body's formulas as functions
    given        the claims that are taken as true
    alone        with such claims: the same claim by the file's own meanings, without them
    rounded      the constant that is printed rounded, if there is exactly one
    swaps        symbols that may have been confused with each other
    unit_of      the units of the names in the equation and of the variables, where they are known
    """

    left: Expr = S.Zero
    right: Expr = S.Zero
    relation: Relation = Relation.EQUAL
    meaning: Meaning = field(default_factory=dict)
    reached: tuple[Meaning, Meaning] | None = None
    through: tuple[Expr, Expr] | None = None
    toward: tuple[Expr, Expr] | None = None
    conventions: tuple[tuple[Reinterpretation, Meaning], ...] = ()
    ranges: Mapping[Symbol, Range] = field(default_factory=dict)
    conditions: tuple[Boolean, ...] = ()
    cases: tuple[Mapping[Symbol, str], ...] = ()
    basis: Basis = Basis.MATHEMATICS
    called: tuple[Expr, ...] = ()
    given: tuple["Claim", ...] = ()
    alone: "Claim | None" = None
    rounded: Rounded | None = None
    swaps: tuple[Symbol, ...] = ()
    unit_of: Mapping[Symbol, str] = field(default_factory=dict)

    def sides(self, left: Expr, right: Expr) -> tuple[Expr, Expr]:
        """Return the expressions to compare for the given printed sides."""
        if self.through is None:
            return left, right
        replaced = {left: right}
        return self.through[0].xreplace(replaced), self.through[1].xreplace(replaced)

    @property
    def compared(self) -> tuple[Expr, Expr]:
        """The expressions to compare for the sides as printed."""
        return self.sides(self.left, self.right)

    @property
    def is_inequality(self) -> bool:
        """Whether the claim is judged by which side is larger."""
        return self.relation.is_ordered and self.reached is None


@dataclass(frozen=True)
class Claim:
    """One part of a displayed equation, or one statement of the text.

    entry      what the file says of it; `place` and `says` are never empty
    meant      what it stands for; if the claim is unchecked, at most its sides as they were read
    text       the equation as text, which keeps its form; if it is given in LaTeX, its reading
    at         its file and line, such as claims.toml:42
    symbols    the definitions of the symbols that it uses, as in the file; empty if there is none
    words      what the file says in words of its symbols and variables
    to_accept  the entry by which the file accepts its reading; empty if it does so or has none
    obstacle   the reason why the claim cannot be judged even if this reading is accepted
    against    what the claim is compared with, in words
    units      a description of the units that do not fit; empty if they fit
    unchecked  the reason why the claim cannot be decided; empty if it can
    seconds    the time limit of the verdict, and then of the search for a correction
    """

    entry: Entry
    meant: AsMeant = AsMeant()
    text: str = ""
    at: str = ""
    symbols: Mapping[str, str] = field(default_factory=dict)
    words: Mapping[str, str] = field(default_factory=dict)
    to_accept: str = ""
    obstacle: str = ""
    against: str = ""
    units: str = ""
    unchecked: str = ""
    seconds: float | None = None

    @property
    def is_unread(self) -> bool:
        """Whether its LaTeX, or a part of it, could not be read."""
        is_read = self.text and (self.entry.accepted or not self.entry.unchecked)
        return bool(self.entry.latex and self.unchecked and not is_read)

    @property
    def shown(self) -> dict[str, str]:
        """What the user sees before accepting its reading."""
        entry = self.entry
        told = {"LaTeX": entry.latex.strip(), "understood": self.text}
        told["in the file"] = entry.understood if entry.accepted else ""
        told |= {**entry.beside, "unchecked": self.obstacle}
        return {key: text for key, text in told.items() if text}

    def changed(self, **meant: Any) -> "Claim":
        """Return the claim with other fields of its meaning, such as other sides."""
        return replace(self, meant=replace(self.meant, **meant))

    @property
    def name(self) -> str:
        """The name for readers: the place of an equation instead of its label in LaTeX."""
        entry = self.entry
        has_number = entry.equation or re.match(r"[A-Za-z]+:\S", entry.label)
        return entry.place if has_number and entry.place else entry.label

    def is_called(self, given: str) -> bool:
        """Whether a user may mean this claim: by its label, name, place or equation number."""
        number, place = self.entry.equation, self.entry.place
        numbers = (number, f"eq. {number}") if number else ()
        places = {place, *place.split(", ")} - {""}
        named = (self.entry.label, self.name, *numbers, *places)
        return given in named or not {f"eq. {given}", f"eq. ({given})"}.isdisjoint(places)


@dataclass(frozen=True)
class Paper:
    """The claims of one source, in the order of its pages.

    signs: for each quantity, the labels of the claims that show its sign in each section.
    """

    title: str
    claims: tuple[Claim, ...]
    signs: Mapping[str, tuple[str, ...]] = field(default_factory=dict)

    def __getitem__(self, label: str) -> Claim:
        return next(claim for claim in self.claims if claim.entry.label == label)

    def called(self, given: str) -> tuple[Claim, ...]:
        """Return the claims that a user may mean: one by its name, or all of one equation."""
        return tuple(claim for claim in self.claims if claim.is_called(given))
