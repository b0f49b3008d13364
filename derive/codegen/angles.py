"""Rules for angles: a tilt near zero, or an edge near a corner, without a difference of angles.

In:  the Program of one function.
Out: the Program in other terms; each rule states its identity.
"""

from dataclasses import replace

from sympy import (
    Abs,
    Add,
    Dummy,
    Expr,
    Max,
    Min,
    Mul,
    Piecewise,
    S,
    Symbol,
    atan2,
    cancel,
    count_ops,
    expand,
    factor,
    pi,
    sign,
    simplify,
    tan,
    together,
)

from derive.body.piece import vanishes
from derive.codegen.program import Kept, Program, Step
from derive.proof.points import Point, numeric
from derive.sheet.formulas import FormulaSheet
from derive.symbols import alpha
from derive.theory.frame import KinkFrame
from derive.theory.ring import factored

_scale, _angle, _rest, _t, near, far = (
    Dummy(name, positive=True) for name in ("scale", "angle", "rest", "tangent", "near", "far")
)
leaning = Dummy("leaning", real=True)


def angles_about_the_right_angle(program: Program, sheet: FormulaSheet) -> Program:
    """Apply two identities, with theta_j = 2 atan2(sqrt u, sqrt v) and u v = w_j**2.

        q (pi/2 - theta_j)     -> q atan2(v - u, 2 w_j)
        q (pi/2 - atan2(y, x)) -> q atan2(x, y) for y > 0

    A tilt near zero is a small difference of angles near pi/2.  The difference of u and v, in
    contrast, is exact.
    """
    kinks = {k.theta: k for k in sheet.frame.kinks}

    def change(expr: Expr) -> Expr:
        for angle in _angles(expr, kinks):
            times = expr.coeff(angle) if expr.is_Add else expand(expr).coeff(angle)
            if vanishes(expr.xreplace({angle: pi / 2})) and times != 0:
                expr = simplify(-times) * _complement(angle, kinks)
        return expr

    return program.with_outputs(change)


def _angles(expr: Expr, kinks: dict[Symbol, KinkFrame]) -> list[Expr]:
    return sorted((expr.free_symbols & kinks.keys()) | expr.atoms(atan2), key=str)


def shares_of_the_half_circle(program: Program, sheet: FormulaSheet) -> Program:
    """A pi + B theta -> A theta' + (A + B) theta where A + B is simpler than B.

    Here theta' = pi - theta.  For the angle of a kink, this is the angle of the other side; for
    theta = atan2(y, x) with y > 0, it is atan2(y, -x).  With A = R_2 and B = R_1 - R_2, both new
    terms are positive, whereas (R_1 - R_2) theta can be negative.
    """
    kinks = {k.theta: k for k in sheet.frame.kinks}
    of_kinks = {symbol for k in sheet.frame.kinks for symbol in (k.theta, k.w, k.L)}

    def change(expr: Expr) -> Expr:
        for angle in _angles(expr, kinks):
            for total in sorted(expr.atoms(Add), key=count_ops):
                times = total.coeff(angle)
                rest = [term for term in total.args if not term.has(angle)]
                free = Add(*(term for term in rest if not term.free_symbols & of_kinks))
                if free == 0 or times == 0:
                    continue
                share = factored(times + free / pi)
                if count_ops(share) >= count_ops(factored(times)):
                    continue
                other = factored(free / pi) * _other_side(angle, kinks)
                left = Add(*(term for term in rest if term.free_symbols & of_kinks))
                expr = expr.xreplace({total: other + share * angle + left})
                break
        return expr

    return program.with_outputs(change)


def _complement(angle: Expr, kinks: dict[Symbol, KinkFrame]) -> Expr:
    if isinstance(angle, atan2):
        y, along = angle.args
        return atan2(along, y)
    k = kinks[angle]
    return atan2(k.kink.side * simplify(k.left - k.right), 2 * k.w)


def _other_side(angle: Expr, kinks: dict[Symbol, KinkFrame]) -> Expr:
    """pi - angle, as an angle of its own instead of a difference."""
    if isinstance(angle, atan2):
        y, along = angle.args
        return atan2(y, -along)
    y, along = kinks[angle].angle.args[1].args
    return 2 * atan2(along, y)


def tangents_from_both_ends(program: Program, example: Point) -> Program:
    """F tan z and F/tan z from t, the tangent of the smaller of z and pi/2 - z.

    Near pi/2, the complement pi/2 - z is an exact small difference, but z is not.  Where z and its
    complement are exchanged as alpha changes sign, the smaller one is z at |alpha|.  Tangents of
    parameters alone are not changed.
    """
    of_tilt = {t for v in program.outputs.values() for t in v.atoms(tan) if t.has(alpha)}
    tangents = sorted(of_tilt, key=str)
    if len(tangents) != 1:
        return program
    (tangent,) = tangents
    sign_of = 1 if numeric(tangent.args[0])(example) > 0 else -1
    angle = factor(together(sign_of * tangent.args[0]))
    rest = factor(together(pi / 2 - angle))
    outputs = {n: v.subs(tangent, sign_of * _t) for n, v in program.outputs.items()}
    split = {n: _power_of_tangent(v) for n, v in outputs.items()}
    scale = next((times for times, power, _ in split.values() if power), S.One)
    steps = [Step(_scale, scale, "")]
    falls = simplify(angle.diff(alpha)).could_extract_minus_sign()
    if falls and simplify(angle.subs(alpha, -alpha) - rest) == 0:
        lean, smaller = alpha, _angle
        least = _shares_taken_off(angle.subs(alpha, Abs(alpha)))
        steps += [Step(_angle, least, "half the smaller angle of the corner")]
    else:
        lean, smaller = _rest - _angle, Min(_angle, _rest)
        steps += [
            Step(_angle, _shares_taken_off(angle), "half the angle of the corner"),
            Step(_rest, _shares_taken_off(rest), "its difference from a right angle"),
        ]
    steps += [
        Step(_t, tan(smaller), ""),
        Step(near, _scale * _t, "distance from the corner to the nearer edge"),
        Step(far, _scale / _t, "distance from the corner to the farther edge"),
    ]
    outputs = {
        n: plain + (on_side(-power * lean, steps) if power else 0)
        for n, (_, power, plain) in split.items()
    }
    return replace(program, outputs=outputs).with_steps(*steps)


def _power_of_tangent(expr: Expr) -> tuple[Expr, int, Expr]:
    """(F, n, rest) of F t**n + rest, with n = 1 or -1; n = 0 for an expression of another form."""
    terms = Add.make_args(expand(expr))
    with_t = [term for term in terms if term.has(_t)]
    for power in (1, -1):
        if len(with_t) == 1 and not (times := cancel(with_t[0] / _t**power)).has(_t):
            return times, power, Add(*(term for term in terms if not term.has(_t)))
    return S.One, 0, expr


def on_side(lean: Expr, steps: list[Step]) -> Expr:
    """`far` where `lean` is positive and `near` where it is negative, without a branch.

    near <= far, and the two are equal where `lean` is zero.
    """
    if all(step.symbol != leaning for step in steps):
        steps.append(Step(leaning, sign(lean) * far, "the farther edge, with the sign of its side"))
        return Max(near, leaning)
    same = next(step.expr for step in steps if step.symbol == leaning) == sign(lean) * far
    return Max(near, leaning if same else -leaning)


def _shares_taken_off(product: Expr) -> Expr:
    """k (p - q)/p -> k - k q/p while q is small compared with p, which saves one rounding."""
    product = _signs_inside(product)
    for total in (f for f in Mul.make_args(product) if isinstance(f, Add)):
        outer = product / total
        for p in total.args:
            q = p - total
            if outer.subs(p, 1 / p) != outer and p.is_positive and not (outer * p).has(p):
                k = outer * p
                return Piecewise((k - k * Kept(q / p), Abs(q) < p / 2), (k * Kept(total / p), True))
    return product


def _signs_inside(product: Expr) -> Expr:
    """-k (p - q) -> k (q - p)."""
    if not product.could_extract_minus_sign():
        return product
    total = next(f for f in Mul.make_args(product) if isinstance(f, Add))
    return -(product / total) * -total
