"""Routes that end in an exact zero.

In:  FormulaSheet, and the name of a formula.
Out: Proof with the verdict *proven*, or None if there is no symbolic route or if it fails.

The integrals are evaluated a second time by antiderivatives, certified by differentiation.
Load and moment are derived from the curvature of g, after integration by parts, and the pressure
from its growth by flat punches.  The contact law is compared with the edge limit of p, and inverses
are substituted.
"""

from collections.abc import Callable
from functools import lru_cache

from sympy import (
    Abs,
    Expr,
    Poly,
    S,
    Symbol,
    cancel,
    count_ops,
    diff,
    expand,
    integrate,
    linsolve,
    pi,
    simplify,
    sin,
    solve,
    sqrt,
    symbols,
)

from derive.proof.verdict import Proof, Verdict
from derive.sheet.formulas import FormulaSheet
from derive.symbols import E_star, P, a, c, dM, dP, dQ, dsigma, e, f, h, mid, s, w, x
from derive.theory.algebra import is_zero
from derive.theory.frame import Frame, KinkFrame
from derive.theory.slip import pressure_next

_SHORT = 60
"""Largest number of operations for which an inverse is substituted symbolically."""


def symbolic_proof(sheet: FormulaSheet, name: str) -> Proof | None:
    """The proof of one formula by its symbolic route, if there is one and if it succeeds."""
    route = _ROUTES.get(name)
    if not sheet.geometry.slope.is_polynomial and route not in _FOR_ALL:
        return None
    words = route and route(sheet, name)
    return Proof(Verdict.PROVEN, words) if words else None


Route = Callable[[FormulaSheet, str], str | None]


def _equal_to(value: Callable[[FormulaSheet], Expr], words: str) -> Route:
    """The route that computes the formula again, as `value`."""

    def route(sheet: FormulaSheet, name: str) -> str | None:
        return words if is_zero(sheet[name].expr - value(sheet), sheet.frame) else None

    return route


def _tilt(sheet: FormulaSheet) -> Expr:
    """I_0 of g', from certified antiderivatives."""
    return -_integral(sheet, lambda slope: slope) / pi


def _load(sheet: FormulaSheet) -> Expr:
    """(E*/2) int g'' w ds."""
    return E_star / 2 * _curvature_integral(sheet, S.One)


def _moment(sheet: FormulaSheet) -> Expr:
    """-(E*/2) int g'' w (s + mid)/2 ds: the load of a corner at s acts halfway from s to mid."""
    return -E_star / 2 * _curvature_integral(sheet, (x + mid) / 2)


def _curvature_integral(sheet: FormulaSheet, density: Expr) -> Expr:
    """int g'' density w ds; at a corner g'' is a delta function times the jump of g'."""
    total = _integral(sheet, lambda slope: diff(slope, x) * density * w**2)
    for k in sheet.frame.kinks:
        step = k.kink.side * (k.kink.jump * density).subs(x, k.kink.position)
        total += step * k.w
    return total


def _integral(sheet: FormulaSheet, of: Callable[[Expr], Expr]) -> Expr:
    """int of(g')/w ds, separately for the base and for the jump at each kink."""
    total = certified_integral(of(sheet.frame.slope.base))
    for k in sheet.frame.kinks:
        total += certified_integral(of(k.kink.jump), k)
    return total


def certified_integral(polynomial: Expr, kink: KinkFrame | None = None) -> Expr:
    """int polynomial(s)/w ds over the contact, or over the part where the kink's jump acts.

    The antiderivative q w + k theta follows, coefficient by coefficient, from its own derivative,
    q' w**2 + q (mid - s) + k = polynomial.  This route is independent of the recursion, and it is
    its own proof.
    """
    polynomial = expand(polynomial)
    degree = Poly(polynomial, x).degree() if polynomial != 0 else 0
    unknowns = symbols(f"q_0:{max(degree, 1)}", cls=Symbol)
    constant = Symbol("k")
    q = sum((u * x**n for n, u in enumerate(unknowns)), S.Zero)
    residual = Poly(expand(diff(q, x) * w**2 + q * (mid - x) + constant - polynomial), x)
    (values,) = linsolve(residual.all_coeffs(), [*unknowns, constant])
    *coefficients, angle = values
    if kink is None:
        return angle * pi
    at = sum((v * kink.kink.position**n for n, v in enumerate(coefficients)), S.Zero)
    return angle * kink.theta - kink.kink.side * at * kink.w


def _pressure(sheet: FormulaSheet, name: str) -> str | None:
    """Each edge separately: dp/dc = K_right (a + x)/(2 sqrt(h) w), dp/da = K_left (c - x)/(...).

    At fixed tilt, where a'(c) = K_right/K_left, both together give dp/dc = P'(c)/(pi w).  The
    rates of load and tilt tie K_N to them, and p vanishes with w and the L_j at both edges.
    """
    for edge, K, opposite in ((c, "K_N_right", a + x), (a, "K_N_left", c - x)):
        grows = sheet[K].expr * opposite / (2 * sqrt(h) * w)
        off = sheet.frame.diff(sheet[name].expr, edge) - grows
        if not (_is_in_the_rates(sheet, K) and is_zero(off, sheet.frame)):
            return None
    return "growth by flat punches, dp/dc = P'(c)/(pi w) at fixed tilt"


def _full_stick(sheet: FormulaSheet, name: str) -> str | None:
    """int dq = dQ and (1/pi) PV int dq(s)/(t - s) ds = dsigma/4, from certified antiderivatives.

    PV int ds/(w(s) (t - s)) is zero inside the contact, so the value of dq w at t is subtracted.
    """
    above, t = sheet[name].expr * w, Symbol("t")
    if not above.is_polynomial(x):
        return None
    strain = certified_integral(cancel((above - above.subs(x, t)) / (t - x)))
    off = certified_integral(above) - dQ, strain / pi - dsigma / 4
    return "force and strain from antiderivatives" if not any(map(simplify, off)) else None


def _stick(sheet: FormulaSheet, name: str) -> str | None:
    """K_T and L_T from dq sqrt(s) and its derivative at s = 0, with w = sqrt(s) sqrt(h - s)."""
    inward = 1 if name.endswith("left") else -1
    at = -a + s if inward > 0 else c - s
    without_root = sheet["full_stick_change"].expr.subs(1 / w, 1)
    regular = without_root.subs(x, at) / sqrt(h - s)
    wanted = regular if name.startswith("K") else diff(regular, s)
    if without_root.has(w) or simplify(sheet[name].expr - wanted.subs(s, 0)) != 0:
        return None
    return "limit of the full-stick change at the edge"


def _margin(sheet: FormulaSheet, name: str) -> str | None:
    """f K_N dedge/2 - |K_T|, times pi sqrt(h), if dP and dM move the edges by da and dc."""
    moves, K = symbols("da dc", real=True), symbols("K_left K_right", positive=True)
    force = [pi * sqrt(h) / 4 * k * move for k, move in zip(K, moves, strict=True)]
    loads = {dP: sum(force), dM: -(force[0] * (mid - h / 4) + force[1] * (mid + h / 4))}
    side = 0 if name.endswith("left") else 1
    friction = f * pi * sqrt(h) * K[side] * Abs(moves[side]) / 2
    shear = pi * Abs(simplify(sqrt(h) * sheet[f"K_T_{('left', 'right')[side]}"].expr))
    found = sheet[name].expr.subs(loads, simultaneous=True)
    width = Symbol("h", positive=True)
    off = (found - friction + shear).subs(c, width - a)
    if simplify(off.replace(Abs, lambda v: Abs(simplify(expand(v))))) != 0:
        return None
    return "f K_N dedge/2 - |K_T| as the edges move by flat punches"


def _slip(sheet: FormulaSheet, name: str) -> str | None:
    """2 f int_0^d K_N sqrt(s) sqrt(h/(d - s)) ds = pi sqrt(h) |K_T|, by an antiderivative."""
    side = name.removeprefix("slip_")
    length, t = Symbol("d", positive=True), Symbol("t", positive=True)
    # s = d sin(t)**2: the integral is d int_0^(pi/2) 2 sin(t)**2 dt
    weight = integrate(2 * sin(t) ** 2, (t, 0, pi / 2)) * length
    K_T, K_N = (sheet[f"{K}_{side}"].expr for K in ("K_T", "K_N"))
    (found,) = solve(2 * f * weight - pi * Symbol("ratio"), length)
    width = Symbol("h", positive=True)
    ratio = Abs(simplify(K_T.subs(c, width - a))) / K_N.subs(c, width - a)
    off = sheet[name].expr.subs(c, width - a) - found.subs(Symbol("ratio"), ratio)
    return "first power of d in both conditions" if simplify(off) == 0 else None


def _substituted(sheet: FormulaSheet, name: str) -> str | None:
    """The contact obtained from (P, M) carries P at the lever arm e."""
    edges = {edge: sheet[f"contact_{edge}"].expr for edge in (a, c)}
    load = sheet.flat("load").subs(edges, simultaneous=True)
    moment = sheet.flat("moment").subs(edges, simultaneous=True)
    if count_ops(moment) > 4 * _SHORT:
        return None
    if simplify(load - P) != 0 or simplify(moment - P * e) != 0:
        return None
    return "substituted symbolically"


def _next(sheet: FormulaSheet, name: str) -> str | None:
    """L_N from the growth of p as its edge moves, dp/dc = K_N sqrt(h - s)/(2 sqrt(h) sqrt(s))."""
    edge = a if name.endswith("left") else c
    K = sheet[name.replace("L", "K", 1)].expr
    off = sheet[name].expr - pressure_next(sheet.frame.diff(K, edge), 0, K)
    return "growth of K_N by flat punches as its edge moves" if is_zero(off, sheet.frame) else None


def _differentiated(of: str, edge: Symbol) -> Route:
    """The route that differentiates another formula."""

    def route(sheet: FormulaSheet, name: str) -> str | None:
        grows = _is_rate(sheet.frame, sheet[name].expr, sheet[of].expr, edge)
        return f"derivative of {of}" if grows else None

    return route


@lru_cache(maxsize=16)
def _is_rate(frame: Frame, rate: Expr, of: Expr, edge: Symbol) -> bool:
    """Whether `rate` is the derivative along an edge."""
    return is_zero(rate - frame.diff(of, edge), frame)


def _of_law(value: Callable[[FormulaSheet], Expr]) -> Route:
    """The route of a quantity of the contact law, computed again from K_N as `value`.

    The four rates, which are linear in the symbols of the kinks, tie K_N to load and tilt:
    P_a, P_c = (pi sqrt(h)/4) K_N and alpha_a, alpha_c = +/- K_N/(E* sqrt(h)) at the left and the
    right edge; a'(c) = -alpha_c/alpha_a and P'(c) = P_c + P_a a'(c) follow from these.
    """

    def route(sheet: FormulaSheet, name: str) -> str | None:
        if not all(_is_in_the_rates(sheet, f"K_N_{side}") for side in ("left", "right")):
            return None
        return _equal_to(value, "limit of p at the edges")(sheet, name)

    return route


def _edge_coefficient(sheet: FormulaSheet, name: str) -> str | None:
    """K_N from the rates of load and tilt at its edge."""
    words = "(2/pi) P'(c)/sqrt(a + c) and a'(c), by derivatives of P and alpha"
    return words if _is_in_the_rates(sheet, name) else None


def _is_in_the_rates(sheet: FormulaSheet, name: str) -> bool:
    """Whether load and tilt change at that edge as K_N says."""
    edge, sense = (a, 1) if name.endswith("left") else (c, -1)
    K = sheet[name].expr
    of_load, of_tilt = pi * sqrt(h) / 4 * K, sense * K / (E_star * sqrt(h))
    return all(
        _is_rate(sheet.frame, rate, sheet[of].expr, edge)
        for of, rate in (("load", of_load), ("tilt", of_tilt))
    )


_ROUTES: dict[str, Route] = {
    "tilt": _equal_to(_tilt, "I_0 from antiderivatives checked by differentiation"),
    "load": _equal_to(_load, "integration by parts, P = (E*/2) int g'' w ds"),
    "moment": _equal_to(_moment, "integration by parts, M = -(E*/2) int g'' w (s + mid)/2 ds"),
    "pressure": _pressure,
    "edge_ratio": _of_law(lambda s: s["K_N_right"].expr / s["K_N_left"].expr),
    "load_rate": _of_law(lambda s: pi / 2 * sqrt(h) * s["K_N_right"].expr),
    "punch": _of_law(lambda s: sqrt(h) / 2 * s["K_N_right"].expr),
    **{f"K_N_{side}": _edge_coefficient for side in ("left", "right")},
    **{
        f"{of}_by_{edge}": _differentiated(of, edge)
        for of in ("load", "moment", "tilt")
        for edge in (a, c)
    },
    "full_stick_change": _full_stick,
    **{f"{K}_T_{side}": _stick for K in "KL" for side in ("left", "right")},
    **{f"stick_margin_{side}": _margin for side in ("left", "right")},
    **{f"slip_{side}": _slip for side in ("left", "right")},
    **{f"L_N_{side}": _next for side in ("left", "right")},
    "contact_a": _substituted,
    "contact_c": _substituted,
}

_FOR_ALL = (_full_stick, _stick, _margin, _slip)
"""Routes that hold for every body."""
