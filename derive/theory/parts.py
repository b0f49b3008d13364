r"""Formulas of a body with polynomial pieces, as sums over parts, with terms of one sign.

The integrals of g'' are evaluated part by part.  A corner adds J w_j to twice the load over E*,
and a curved part adds k int w ds, where J is the jump of g' and k is g'' on the part.  For a convex
body nothing is subtracted.  The integrals over a part are the functions of segments.py.  For a part
between kinks 1 and 2, with sin_j and cos_j of half the angles of its ends,

    int w ds = (h**2/4) (segment(t/2) + sin(t) (sin_1 cos_2 + cos_1 sin_2)**2).
"""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property, lru_cache
from itertools import pairwise

from sympy import (
    Add,
    Expr,
    Gt,
    Max,
    Min,
    Piecewise,
    Rational,
    S,
    Symbol,
    atan2,
    factor_terms,
    pi,
    simplify,
    sin,
    sqrt,
    symbols,
)

from derive.body.piece import Piece
from derive.symbols import E_star, a, c, x
from derive.theory.edges import Edge
from derive.theory.frame import Frame, KinkFrame
from derive.theory.segments import (
    definitions_of,
    edge_angle,
    end_pressure,
    involute,
    kink_logarithm,
    part_area,
    part_arm,
    part_pressure,
    part_weight,
    root_ratio,
    second_term,
    segment,
)

h = Symbol("h", positive=True)
"""Contact width, as a symbol."""

sin_x, cos_x = symbols("sin_x cos_x", nonnegative=True)
"""Sine and cosine of half the angle of x."""


@lru_cache(maxsize=16)
def has_parts(frame: Frame) -> bool:
    """Whether a contact can leave a kink, and g'' is constant on every part."""
    if not frame.slope.is_polynomial or not any(k.clipped for k in frame.kinks):
        return False
    return not any(part.bend.has(x) for part in parts_of(frame).parts)


@lru_cache(maxsize=16)
def parts_of(frame: Frame) -> "Parts":
    """The sums over the parts of a body, computed once."""
    return Parts(frame)


@dataclass(frozen=True)
class Definition:
    """A symbol, its definition `expr`, and its meaning in a few words."""

    symbol: Symbol
    expr: Expr
    meaning: str


@dataclass(frozen=True)
class Part:
    """The part of a contact that is covered by one piece of the body.

    before, behind: the kinks at its left and right end; None at an edge.
    """

    number: int
    piece: Piece
    before: KinkFrame | None
    behind: KinkFrame | None

    @cached_property
    def t(self) -> Symbol:
        """The angle that the part spans on the half circle."""
        return Symbol(f"t_{self.number}", nonnegative=True)

    @cached_property
    def bend(self) -> Expr:
        """g'' on the part."""
        return simplify(self.piece.curvature)

    @property
    def is_inner(self) -> bool:
        """Whether the part lies between two kinks."""
        return self.before is not None and self.behind is not None

    @property
    def begins(self) -> tuple[Expr, ...]:
        """Sine and cosine of half the angle of the left end."""
        return (S.Zero, S.One) if self.before is None else _half_angle(self.before)[:2]

    @property
    def ends(self) -> tuple[Expr, ...]:
        """Sine and cosine of half the angle of the right end."""
        return (S.One, S.Zero) if self.behind is None else _half_angle(self.behind)[:2]

    @property
    def near(self) -> Expr:
        """Product of the sines of both ends."""
        return self.begins[0] * self.ends[0]

    @property
    def far(self) -> Expr:
        """Product of the cosines of both ends."""
        return self.begins[1] * self.ends[1]

    @property
    def across(self) -> Expr:
        """Sine of half the sum of the angles of both ends."""
        return self.ends[0] * self.begins[1] + self.begins[0] * self.ends[1]

    @property
    def angle(self) -> Expr:
        """Definition of t."""
        before, behind = self.before, self.behind
        if before and behind:
            span = simplify(behind.kink.position - before.kink.position)
            length = Max(0, Min(h, span, behind.left, before.right))
            return 2 * atan2(length, h * self.across * (self.near + self.far))
        kink = before or behind
        if kink is None:
            return pi  # the whole contact
        sides = (kink.left, kink.right)
        return edge_angle(*reversed(sides)) if before else edge_angle(*sides)

    # ------------------------------------------------------------------ integrals

    @property
    def area(self) -> Expr:
        """int w ds divided by h**2/8."""
        if not self.is_inner:
            return segment(self.t)
        return part_area(self.t, self.across)

    @property
    def arm(self) -> Expr:
        """int w (s - mid) ds divided by h**3/24."""
        if not self.is_inner:
            return (-1 if self.before is None else 1) * sin(self.t) ** 3
        return part_arm(self.t, *self.begins, *self.ends)

    @property
    def lean(self) -> Expr:
        """int g'/w ds."""
        if self.bend == 0:
            return simplify(self.piece.slope) * self.t
        if self.before is None:
            return self._slope_at(self.ending) * self.t - self.bend * h / 2 * involute(self.t)
        if self.behind is None:
            return self._slope_at(self.beginning) * self.t + self.bend * h / 2 * involute(self.t)
        both = self._slope_at(self.beginning) + self._slope_at(self.ending)
        bent = self.bend * h * (self.near - self.far) * involute(self.t / 2)
        return self.t / 2 * factor_terms(both) + bent

    def weight(self, edge: Edge) -> Expr:
        """int w/A ds/h for the left edge, int w/B ds/h for the right one."""
        touched = self.before if edge is Edge.LEFT else self.behind
        if self.is_inner:
            return part_weight(self.t, self.far if edge is Edge.LEFT else self.near)
        return (self.t + sin(self.t)) / 2 if touched is None else segment(self.t / 2)

    def beyond(self, edge: Edge) -> Expr:
        """Contribution to the next term of the pressure at an edge that the part does not touch."""
        both = (self.near, self.far) if edge is Edge.RIGHT else (self.far, self.near)
        return second_term(self.t, *both)

    @property
    def seen(self) -> Expr:
        """int L ds/h, for the pressure at x."""
        if self.before is None:
            return end_pressure(self.t, sin_x, cos_x)
        if self.behind is None:
            return end_pressure(self.t, cos_x, sin_x)
        start, end = ((k.kink.position - x) / h for k in (self.before, self.behind))
        return part_pressure(self.t, start, end, *self.begins, *self.ends, sin_x, cos_x)

    # ------------------------------------------------------------------ slope

    @property
    def beginning(self) -> Expr:
        """Position of the left end."""
        return -a if self.before is None else Max(-a, self.before.kink.position)

    @property
    def ending(self) -> Expr:
        """Position of the right end."""
        return c if self.behind is None else Min(c, self.behind.kink.position)

    def _slope_at(self, place: Expr) -> Expr:
        """g' at a point, as a sum of two terms of one sign if their sign is known.

        It starts from the end of the piece from which g' moves away from zero, or from its root.
        """
        slope = simplify(self.piece.slope)
        for end, sense in ((self.piece.lower, 1), (self.piece.upper, -1)):
            there = simplify(slope.subs(x, end)) if end.is_finite else None
            if there is not None and (sense * there).is_nonnegative:
                return there + self.bend * _distance(place, end)
        root = simplify(-slope.subs(x, 0) / self.bend)
        return self.bend * _distance(place, root)


def _distance(place: Expr, other: Expr) -> Expr:
    """place - other, by a single comparison if `place` is a Max or Min that contains `other`."""
    if isinstance(place, Max | Min) and other in place.args:
        (edge,) = set(place.args) - {other}
        return Max(0, edge - other) if isinstance(place, Max) else -Max(0, other - edge)
    return place - other


def _half_angle(kink: KinkFrame) -> tuple[Symbol, ...]:
    """Sine, cosine, tangent and cotangent of half the angle of a kink."""
    n = kink.number
    return symbols(f"sin_{n} cos_{n} tan_{n} cot_{n}", nonnegative=True)


@dataclass(frozen=True)
class Parts:
    """The formulas of a body as sums over its parts and corners."""

    frame: Frame

    @cached_property
    def parts(self) -> tuple[Part, ...]:
        """All parts, from left to right."""
        ends = pairwise((None, *self.frame.kinks, None))
        pieces = enumerate(zip(self.frame.slope.pieces, ends, strict=True), start=1)
        return tuple(Part(number, piece, *kinks) for number, (piece, kinks) in pieces)

    @property
    def curved(self) -> tuple[Part, ...]:
        """Parts on which g'' is not zero."""
        return tuple(part for part in self.parts if part.bend != 0)

    @property
    def corners(self) -> Iterator[tuple[Expr, KinkFrame]]:
        """Jumps of g', each with its kink."""
        return ((k.kink.step, k) for k in self.frame.kinks if k.kink.is_corner)

    @cached_property
    def formulas(self) -> dict[str, Expr]:
        """All formulas by their names on the sheet."""
        found = {name: getattr(self, name) for name in ("tilt", "load", "moment", "pressure")}
        for edge in Edge:
            found[f"K_N_{edge.name.lower()}"] = self.edge_coefficient(edge)
            found[f"L_N_{edge.name.lower()}"] = self.second_coefficient(edge)
        return found

    @property
    def tilt(self) -> Expr:
        """-(1/pi) int g'/w ds."""
        return -Add(*(part.lean for part in self.parts)) / pi

    @property
    def load(self) -> Expr:
        """(E*/2) int g'' w ds."""
        curved = E_star * h**2 / 16 * self._sum(lambda part: part.area)
        return curved + Add(*(E_star * J * k.root / 2 for J, k in self.corners))

    @property
    def moment(self) -> Expr:
        """-(E*/4) int g'' w (s + mid) ds."""
        curved = (a - c) * self._sum(lambda part: part.area) - h / 3 * self._sum(lambda p: p.arm)
        corners = (E_star * J * k.root * (a - c - 2 * k.kink.position) / 8 for J, k in self.corners)
        return factor_terms(E_star * h**2 / 32 * curved) + Add(*corners)

    @property
    def pressure(self) -> Expr:
        """(E*/pi) int g'' L ds."""
        curved = E_star * h / pi * self._sum(lambda part: part.seen)
        corners = (
            E_star * J / (2 * pi) * kink_logarithm(2 * k.u / h, 2 * k.v / h, x - k.kink.position)
            for J, k in self.corners
        )
        return curved + Add(*corners)

    def edge_coefficient(self, edge: Edge) -> Expr:
        """Coefficient of sqrt(s): (E*/(pi sqrt(h))) int g'' w/B ds at the right edge."""
        curved = E_star * sqrt(h) / pi * self._sum(lambda part: part.weight(edge))
        return curved + E_star / (pi * sqrt(h)) * self._jumps(edge, lambda r: r)

    def second_coefficient(self, edge: Edge) -> Expr:
        """Coefficient of s**(3/2): a part due to g'' at the edge, and a part due to the others."""
        here = -E_star * self.bend_at(edge) / (4 * sqrt(h))
        curved = E_star / (3 * pi * sqrt(h)) * self._others(edge)
        corners = self._jumps(edge, lambda r: r * (3 + 2 * r**2))
        return here + curved + E_star / (6 * pi * h ** Rational(3, 2)) * corners

    @cached_property
    def definitions(self) -> tuple[Definition, ...]:
        """Definitions of the symbols in the formulas; each follows those that it contains."""
        found = [Definition(h, a + c, "contact width")]
        for k in self.frame.kinks:
            at = f"at x = {k.kink.position}"
            kinds = ("sine", "cosine", "tangent", "cotangent")
            clipped = (sqrt(Min(h, Max(0, distance)) / h) for distance in (k.left, k.right))
            exprs = (*clipped, root_ratio(k.left, k.right), root_ratio(k.right, k.left))
            for kind, symbol, expr in zip(kinds, _half_angle(k), exprs, strict=True):
                found.append(Definition(symbol, expr, f"half-angle {kind} {at}"))
        found += [
            Definition(part.t, part.angle, f"angle of part {part.number}") for part in self.parts
        ]
        found += [
            Definition(sin_x, sqrt(Max(0, a + x) / h), "half-angle sine at x"),
            Definition(cos_x, sqrt(Max(0, c - x) / h), "half-angle cosine at x"),
        ]
        for edge in Edge:
            symbol, at = self.bend_at(edge), f"g'' at the {edge.name.lower()} edge"
            if isinstance(symbol, Symbol):
                found.append(Definition(symbol, self._bends(edge), at))
        return tuple(found)

    def defined_in(self, forms: Iterable[Expr]) -> dict[Expr, Expr]:
        """Definitions of the symbols in the formulas, and of the functions, as they are printed."""
        exprs, held = [*forms], []
        for d in reversed(self.definitions):
            if any(expr.has(d.symbol) for expr in exprs):
                exprs.append(d.expr)
                held.append(d)
        return {d.symbol: d.expr for d in reversed(held)} | definitions_of(exprs)

    def bend_at(self, edge: Edge) -> Expr:
        """g'' at an edge: a symbol, or zero for a body without curved parts."""
        return Symbol(f"k_{edge.name.lower()}", real=True) if self.curved else S.Zero

    def _bends(self, edge: Edge) -> Expr:
        """Definition of g'' at an edge."""
        kinks = self.frame.kinks
        if edge is Edge.LEFT:
            inward, distances = self.parts, [k.left for k in kinks]
        else:
            inward, distances = self.parts[::-1], [k.right for k in reversed(kinks)]
        *others, last = inward
        branches = [(p.bend, Gt(d, 0)) for p, d in zip(others, distances, strict=True)]
        return Piecewise(*branches, (last.bend, True))

    def _others(self, edge: Edge) -> Expr:
        """Contribution of the parts that do not end at an edge, by g'' relative to that edge."""
        if not self.curved:
            return S.Zero
        others = self.parts[1:] if edge is Edge.LEFT else self.parts[:-1]
        here = self.bend_at(edge)
        return Add(*((part.bend - here) * part.beyond(edge) for part in others))

    def _jumps(self, edge: Edge, of_tangent: Callable[[Expr], Expr]) -> Expr:
        """Sum over the corners' jumps times a function of sqrt(A/B), for the right edge."""
        place = 2 if edge is Edge.RIGHT else 3
        return factor_terms(Add(*(J * of_tangent(_half_angle(k)[place]) for J, k in self.corners)))

    def _sum(self, share: Callable[[Part], Expr]) -> Expr:
        """Sum over g'' times a share, grouped by g''."""
        groups: dict[Expr, Expr] = {}
        for part in self.curved:
            groups[part.bend] = groups.get(part.bend, S.Zero) + share(part)
        return factor_terms(Add(*(bend * total for bend, total in groups.items())))
