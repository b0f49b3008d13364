r"""The contribution of a kink to the formulas: its angle, its root, its logarithm.

With x = mid + (h/2) cos(theta), the contact becomes the half circle 0 < theta < pi, and a kink at
x_j divides it.  All formulas are rational in three symbols per kink:

    theta_j  the angle of the part of the contact in which the jump acts,
             2 atan( sqrt(c - x_j) / sqrt(a + x_j) ) if this part lies to the right of the kink
    w_j      sqrt((a + x_j)(c - x_j))
    L_j      (1/2) log |(sqrt u_j + sqrt v_j) / (sqrt u_j - sqrt v_j)|,
             u_j = (c - x_j)(a + x),  v_j = (a + x_j)(c - x)

The square root of a quadratic q(x) in g' adds four symbols: its values at both edges, and the
parameter and the characteristic of its elliptic integrals.

A kink outside the contact has theta_j = 0 or pi and w_j = L_j = 0.  Its roots are clipped at zero,
so that the same formula also holds for a contact that has left the kink.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

from sympy import Abs, Add, Expr, Max, Symbol, atan2, diff, expand, log, sqrt, symbols

from derive.body.profile import Kink, Slope
from derive.symbols import a, c, h, w, x

_FEW_TERMS = 5
"""Largest number of terms of g' for which a body with one kink is written over one denominator,
which is shorter.  With more terms, each with its own length, this would take half a minute."""


def _symbol(stem: str, **assumptions: bool) -> Any:
    """An attribute of a numbered object: a symbol with its number."""
    return cached_property(lambda owner: Symbol(f"{stem}_{owner.number}", **assumptions))


@dataclass(frozen=True)
class KinkFrame:
    """A kink with its three symbols."""

    kink: Kink
    clipped: bool

    theta = _symbol("theta", nonnegative=True)
    """Angle of the part of the contact in which the jump acts."""

    w = _symbol("w", nonnegative=True)
    """Root of the product of the distances from the kink to both edges."""

    L = _symbol("L", nonnegative=True)
    """The kink's logarithm in the pressure."""

    @property
    def number(self) -> int:
        """Counted from the left."""
        return self.kink.number

    @property
    def left(self) -> Expr:
        """Distance from the left edge to the kink, a + x_j."""
        return a + self.kink.position

    @property
    def right(self) -> Expr:
        """Distance from the kink to the right edge, c - x_j."""
        return c - self.kink.position

    def clip(self, distance: Expr) -> Expr:
        """The distance to the kink, or zero if the contact has left the kink."""
        return Max(0, distance) if self.clipped else distance

    @property
    def angle(self) -> Expr:
        """Definition of theta_j."""
        near, far = (self.right, self.left) if self.kink.side > 0 else (self.left, self.right)
        return 2 * atan2(sqrt(self.clip(near)), sqrt(self.clip(far)))

    @property
    def root(self) -> Expr:
        """Definition of w_j."""
        return sqrt(self.clip(self.left) * self.clip(self.right))

    @property
    def u(self) -> Expr:
        """u_j, which vanishes at the left edge."""
        return self.clip(self.right) * (a + x)

    @property
    def v(self) -> Expr:
        """v_j, which vanishes at the right edge."""
        return self.clip(self.left) * (c - x)

    @property
    def logarithm(self) -> dict[Symbol, Expr]:
        """Definition of L_j in terms of two more symbols, u_j and v_j, and that of these."""
        u, v = symbols(f"u_{self.number} v_{self.number}", nonnegative=True)
        quotient = (sqrt(u) + sqrt(v)) / (sqrt(u) - sqrt(v))
        return {self.L: log(Abs(quotient)) / 2, u: self.u, v: self.v}


@dataclass(frozen=True)
class RootFrame:
    """The square root of a quadratic in g', with the symbols of its elliptic integrals."""

    quadratic: Expr
    number: int

    left = _symbol("q_left", positive=True)
    right = _symbol("q_right", positive=True)
    """Values of the root at both edges."""

    m = _symbol("m", real=True)
    n = _symbol("n", real=True)
    """Parameter of the elliptic integrals, and characteristic of that of the third kind."""

    @property
    def definitions(self) -> dict[Symbol, Expr]:
        """Definitions of all four symbols; m and n in terms of the values at the edges."""
        square = diff(self.quadratic, x, 2) / 2 * h**2
        return {
            self.left: sqrt(self.quadratic.subs(x, -a)),
            self.right: sqrt(self.quadratic.subs(x, c)),
            self.m: (square - (self.right - self.left) ** 2) / (4 * self.left * self.right),
            self.n: square / (self.left + self.right) ** 2,
        }


@dataclass(frozen=True)
class Frame:
    """All kinks of a body, its square roots, and the algebra of their symbols."""

    slope: Slope

    @cached_property
    def roots(self) -> tuple[RootFrame, ...]:
        """One frame for each quadratic whose square root g' contains."""
        return tuple(RootFrame(q, i) for i, q in enumerate(self.slope.quadratics, start=1))

    @cached_property
    def kinks(self) -> tuple[KinkFrame, ...]:
        """One frame for each kink; it is clipped unless every contact must span the kink.

        A single kink between two straight flanks is always spanned, since only a kink carries load.
        """
        always_spanned = len(self.slope.kinks) == 1 and all(p.straight for p in self.slope.pieces)
        return tuple(KinkFrame(kink, clipped=not always_spanned) for kink in self.slope.kinks)

    @cached_property
    def is_long(self) -> bool:
        """Whether sums over a common denominator are much longer than the separate terms."""
        slope = self.slope
        if len(slope.kinks) != 1 or not slope.is_polynomial:
            return len(slope.kinks) > 1
        parts = (slope.base, slope.kinks[0].jump)
        return sum(len(Add.make_args(expand(part))) for part in parts) > _FEW_TERMS

    @cached_property
    def printed(self) -> dict[Symbol, Expr]:
        """Definition of each symbol of the frame; it may contain symbols that have their own."""
        found: dict[Symbol, Expr] = {}
        for k in self.kinks:
            found |= {k.theta: k.angle, k.w: k.root, **k.logarithm}
        for root in self.roots:
            found |= root.definitions
        return found

    @cached_property
    def definitions(self) -> dict[Symbol, Expr]:
        """Definition of each symbol of the frame, written out."""
        return {s: definition.xreplace(self.printed) for s, definition in self.printed.items()}

    def defined_in(self, *exprs: Expr) -> dict[Symbol, Expr]:
        """Definitions of the symbols of the frame that expressions contain, as printed."""
        held = set().union(*(expr.free_symbols for expr in exprs))
        held |= set().union(*(d.free_symbols for s, d in self.printed.items() if s in held))
        return {s: definition for s, definition in self.printed.items() if s in held}

    def flat(self, expr: Expr) -> Expr:
        """`expr` with every symbol of the frame written out."""
        return expr.xreplace(self.definitions)

    def diff(self, expr: Expr, edge: Symbol) -> Expr:
        """Derivative with respect to the edge a or c, by the chain rule; free of 1/w_j.

        From cos(theta_j) = (x_j - mid)/(h/2):  d theta_j/dc = w_j/(h (c - x_j)) and
        d theta_j/da = -w_j/(h (a + x_j)) if the jump acts on the right, with opposite signs if it
        acts on the left; d w_j/dc = w_j/(2 (c - x_j)),  d w_j/da = w_j/(2 (a + x_j));
        d L_j/dc = w_j (a + x)/(2 h w (c - x_j)),  d L_j/da = w_j (c - x)/(2 h w (a + x_j)).
        """
        total = expr.diff(edge)
        for k in self.kinks:
            distance, sense = (k.right, 1) if edge == c else (k.left, -1)
            total += expr.diff(k.theta) * sense * k.kink.side * k.w / (h * distance)
            total += expr.diff(k.w) * k.w / (2 * distance)
            opposite = a + x if edge == c else c - x
            total += expr.diff(k.L) * k.w * opposite / (2 * h * w * distance)
        return total
