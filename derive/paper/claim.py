"""A claim: one printed equation, or one formula in words, as data.

Its two sides stand in the source's own symbols.  `meaning` says what each of them is in ours: a
formula of a sheet, a defining integral, a root of the conditions of stick, or another symbol.  A
map of signs is nothing but such an entry, `M: -M` say, and can be read there.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum

from mpmath import mpf
from sympy import Abs, Expr, Rational, S, Symbol
from sympy.logic.boolalg import Boolean

Meaning = Mapping[Symbol, Expr]
Point = dict[Symbol, mpf]


class Verdict(StrEnum):
    """What is known of a claim."""

    HOLDS = "holds"
    NUMERICAL = "numerical"
    DEFINITION = "by definition"
    CONVENTION = "convention"
    FAILS = "fails"
    UNCHECKED = "unchecked"


class Relation(StrEnum):
    """What stands between the two sides.

    A likeness is judged by the term that leads, as an equation.
    """

    EQUAL = "="
    LIKE = "~"
    BELOW = "<"
    AT_MOST = "<="
    ABOVE = ">"
    AT_LEAST = ">="

    @property
    def is_strict(self) -> bool:
        """Whether one side must be larger, not equal."""
        return self in (Relation.BELOW, Relation.ABOVE)

    @property
    def is_ordered(self) -> bool:
        """Whether one side must be no smaller than the other."""
        return self in _TURNED

    @property
    def turned(self) -> "Relation":
        """The opposite inequality."""
        return _TURNED[self]


_TURNED = {
    Relation.BELOW: Relation.ABOVE,
    Relation.ABOVE: Relation.BELOW,
    Relation.AT_MOST: Relation.AT_LEAST,
    Relation.AT_LEAST: Relation.AT_MOST,
}


@dataclass(frozen=True)
class Convention:
    """A map of signs that an earlier place of the same source excludes.

    what         in words, e.g. "the tension with the opposite sign"
    meaning      the entries of the claim's meaning that it replaces
    contradicts  the place that says otherwise
    """

    what: str
    meaning: Meaning
    contradicts: str


@dataclass(frozen=True)
class Bound:
    """How a condition is judged whose meaning puts both sides where it is just reached.

    There they must be equal.  Off it the direction shows: with `allowed` in the place of entries of
    the meaning the printed relation must be true, with `beyond` it must not.
    """

    allowed: Meaning
    beyond: Meaning


@dataclass(frozen=True)
class Range:
    """Where a variable is drawn: evenly between two bounds, or over powers of two."""

    low: float
    high: float
    powers: bool = False

    @property
    def place(self) -> Expr:
        """A simple number of the range."""
        if self.powers or self.low < 1 < self.high:
            return S.One
        return Rational(str((self.low + self.high) / 2))


SCALE = Range(-1.5, 1.5, powers=True)
"""A length, a load or a modulus; they are homogeneous, so their size matters little."""
SIGNED = Range(-2, 2)


@dataclass(frozen=True)
class Rounded:
    """A constant that is printed rounded, and is a factor of one side.

    power: of the constant in the right side over the left one
    """

    value: Rational
    half: Rational
    power: int


@dataclass(frozen=True)
class Claim:
    """One part of one displayed equation, or one statement of the text.

    label        unlike all others; the source's own label where it has one
    place        where it stands, for a reader with the paper in hand
    equation     the displayed equation that it is a part of; empty for a statement of the text
    says         what it says, in words
    left, right  the printed sides, in the source's symbols
    relation     between them
    reached      a bound that is judged where it is reached, as an equation, and off it
    meaning      what the symbols stand for, in ours
    against      what it is compared with, in words
    ranges       where ours are drawn; those not named are positive and drawn by SCALE
    conditions   what must be true, in ours, of every point that is looked at
    defined      whether both sides are one expression once the file's own definitions are put in
    toward       what goes to which end, in ours, for a claim about a limit
    order        the power of what goes to zero that the difference is of; None: of lower order
    units        what does not fit in its units, if anything
    latex        as it is printed, if the file has it so
    rounded      the one constant that is printed rounded, if there is one
    conventions  maps to try where it does not hold as it stands
    through      two expressions that must agree once `left`, a symbol, is replaced by `right`;
                 for a definition, which by itself says nothing that could be wrong
    cases        the points themselves, where few are all that can be afforded; numbers as text
    source       the equation as the source has it, as text, where the sides cannot keep its form:
                 SymPy takes a - a for zero as soon as it is written
    seconds      that the verdict, and then the search for a correction, may take
    family       claims of one family are looked at in the same points, their integrals done once
    swaps        symbols that may have been mistaken for each other
    steps        how the comparison was derived, for `--explain`
    unchecked    why it cannot be decided, if it cannot
    expected     the verdict found when the claim was last looked at by a person
    consequence  what the difference does to a user's numbers
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
    cases: tuple[Mapping[Symbol, str], ...] = ()
    source: str = ""
    seconds: float | None = None
    family: str = ""
    steps: tuple[str, ...] = ()
    unchecked: str = ""
    expected: Verdict | None = None
    consequence: str = ""

    def sides(self, left: Expr, right: Expr) -> tuple[Expr, Expr]:
        """What is compared if the printed sides were these."""
        if self.through is None:
            return left, right
        replaced = {left: right}
        return self.through[0].xreplace(replaced), self.through[1].xreplace(replaced)

    @property
    def is_inequality(self) -> bool:
        """Whether it is judged by which side is larger."""
        return self.relation.is_ordered and self.reached is None

    @property
    def has_modulus(self) -> bool:
        """Whether a modulus is printed, which may be one too many."""
        return bool(self.right.has(Abs) or self.left.has(Abs))


@dataclass(frozen=True)
class Paper:
    """The claims of one source, in the order of its pages.

    signs: for each quantity the labels of the claims that show which sign a section gives it.
    """

    title: str
    claims: tuple[Claim, ...]
    signs: Mapping[str, tuple[str, ...]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        labels = [claim.label for claim in self.claims]
        assert len(labels) == len(set(labels)), "two claims of one label"

    def __getitem__(self, label: str) -> Claim:
        return next(claim for claim in self.claims if claim.label == label)
