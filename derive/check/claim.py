"""Represent a claim, which is one printed equation or one statement in words, as data.

Both sides of a claim are written in the symbols of the source.  `meaning` expresses each of these
symbols in terms of our variables: as a formula of a sheet, an integral, a root of the conditions of
stick, or another symbol.  A change of sign is an ordinary entry of this mapping, such as `M: -M`.
"""

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from enum import StrEnum

from mpmath import mpf
from sympy import Expr, Rational, S, Symbol
from sympy.logic.boolalg import Boolean

from derive.reading.relation import Relation

Meaning = Mapping[Symbol, Expr]
Point = dict[Symbol, mpf]


class Verdict(StrEnum):
    """The verdict on a claim."""

    HOLDS = "holds"
    NUMERICAL = "numerical"
    DEFINITION = "by definition"
    CONVENTION = "convention"
    FAILS = "fails"
    UNCHECKED = "unchecked"


@dataclass(frozen=True)
class Convention:
    """A sign convention that another part of the same source contradicts.

    what         the convention in words, for example "the tension with the opposite sign"
    meaning      the entries that replace those of the claim's meaning
    contradicts  the part of the source that contradicts it
    """

    what: str
    meaning: Meaning
    contradicts: str


@dataclass(frozen=True)
class Bound:
    """A check of a bound on both sides of the state in which it is just reached.

    In that state, which is described by the claim's meaning, both sides must be equal.  If entries
    of the meaning are replaced by `allowed`, the printed relation must be true; if they are
    replaced by `beyond`, it must be false.
    """

    allowed: Meaning
    beyond: Meaning


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


@dataclass(frozen=True)
class Claim:
    """One part of a displayed equation, or one statement of the text.

    label        a unique label; the source's own label if it has one
    place        the location in the source, for the reader
    equation     the displayed equation to which it belongs; empty for a statement of the text
    says         the statement in words
    left, right  the printed sides, in the source's symbols
    relation     the relation between them
    reached      the check of a bound on both sides of the state in which it is reached
    meaning      the meanings of the source's symbols, in our variables
    against      what the claim is compared with, in words
    ranges       ranges of our variables; the others are positive and have the range SCALE
    conditions   conditions, in our variables, that every point must satisfy
    defined      whether the file's definitions make both sides the same expression
    toward       for a claim about a limit, the expression in our variables and its end
    order        for such a claim, the order of the difference; None if the ratio tends to 1
    units        a description of the units that do not fit; empty if they fit
    latex        the printed LaTeX, if the file gives it
    rounded      the constant that is printed rounded, if there is exactly one
    conventions  sign conventions that are tried if the claim is not true as printed
    through      two expressions that must agree when the symbol `left` is replaced by `right`;
                 used for a definition, which cannot be wrong by itself
    cases        the points to use, with numbers as text, if more would take too long
    source       the printed equation as text, which keeps its form; SymPy would simplify it
    reading      reads a changed form of `source` as both sides; None for one that cannot be read
    seconds      the time limit of the verdict, and then of the search for a correction
    family       claims of one family share their points, so that integrals are computed once
    swaps        symbols that may have been confused with each other
    unit_of      the units of the names in the equation and of the variables, where they are known
    steps        the steps of the comparison, for `--explain`
    unchecked    the reason why the claim cannot be decided; empty if it can
    expected     the verdict that was found when a person last examined the claim
    consequence  the effect of the error on a user's results
    """

    label: str
    place: str
    says: str
    left: Expr = S.Zero
    right: Expr = S.Zero
    relation: Relation = Relation.EQUAL
    reached: Bound | None = None
    equation: str = ""
    meaning: Meaning = field(default_factory=dict)
    against: str = ""
    ranges: Mapping[Symbol, Range] = field(default_factory=dict)
    conditions: tuple[Boolean, ...] = ()
    defined: bool = False
    toward: tuple[Expr, Expr] | None = None
    order: float | None = None
    units: str = ""
    latex: str = ""
    rounded: Rounded | None = None
    conventions: tuple[Convention, ...] = ()
    through: tuple[Expr, Expr] | None = None
    swaps: tuple[Symbol, ...] = ()
    unit_of: Mapping[Symbol, str] = field(default_factory=dict)
    cases: tuple[Mapping[Symbol, str], ...] = ()
    source: str = ""
    reading: Callable[[str], tuple[Expr, Expr] | None] | None = None
    seconds: float | None = None
    family: str = ""
    steps: tuple[str, ...] = ()
    unchecked: str = ""
    expected: Verdict | None = None
    consequence: str = ""

    def sides(self, left: Expr, right: Expr) -> tuple[Expr, Expr]:
        """Return the expressions to compare for the given printed sides."""
        if self.through is None:
            return left, right
        replaced = {left: right}
        return self.through[0].xreplace(replaced), self.through[1].xreplace(replaced)

    @property
    def name(self) -> str:
        """The name for readers: the place of an equation instead of its label in LaTeX."""
        has_number = self.equation or re.match(r"[A-Za-z]+:\S", self.label)
        return self.place if has_number and self.place else self.label

    @property
    def consequences(self) -> list[str]:
        """The consequence, one statement in each line."""
        return self.consequence.split("; ") if self.consequence else []

    def is_called(self, given: str) -> bool:
        """Whether a user may mean this claim: by its label, its name or its equation number."""
        numbers = (self.equation, f"eq. {self.equation}") if self.equation else ()
        return given in (self.label, self.name, *numbers)

    @property
    def is_inequality(self) -> bool:
        """Whether the claim is judged by which side is larger."""
        return self.relation.is_ordered and self.reached is None


@dataclass(frozen=True)
class Paper:
    """The claims of one source, in the order of its pages.

    signs: for each quantity, the labels of the claims that show its sign in each section.
    """

    title: str
    claims: tuple[Claim, ...]
    signs: Mapping[str, tuple[str, ...]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        labels = [claim.label for claim in self.claims]
        assert len(labels) == len(set(labels)), "two claims have the same label"

    def __getitem__(self, label: str) -> Claim:
        return next(claim for claim in self.claims if claim.label == label)

    def called(self, given: str) -> tuple[Claim, ...]:
        """Return the claims that a user may mean: one by its name, or all of one equation."""
        return tuple(claim for claim in self.claims if claim.is_called(given))
