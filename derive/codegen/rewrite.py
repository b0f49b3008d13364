r"""Rewrites formulas into forms that do not lose digits in floating point.

In:  the outputs of one function, in the symbols of the sheet.
Out: a Program in stable forms, which is compared with its source to 30 digits before it is used.

Each rule is one function, whose docstring states the identity that it uses.  No rule depends on a
particular geometry.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace

import mpmath
from sympy import (
    Abs,
    Add,
    Dummy,
    Expr,
    Max,
    Min,
    Mul,
    Piecewise,
    Pow,
    S,
    Symbol,
    atan,
    atan2,
    cancel,
    count_ops,
    expand,
    factor,
    fraction,
    pi,
    powsimp,
    sign,
    simplify,
    sqrt,
    tan,
    together,
)

from derive.body.piece import vanishes
from derive.codegen.program import Kept, Program, Step
from derive.command.errors import NotProven
from derive.proof.points import Point, named, numeric, numeric_by_steps
from derive.proof.verdict import WORKING, Comparison, Proof, numerical_proof
from derive.sheet.formulas import FormulaSheet
from derive.symbols import M, P, a, alpha, c, e, h, w, x
from derive.theory.frame import KinkFrame
from derive.theory.ring import factored
from derive.theory.segments import kink_logarithm

_w = Symbol("w", nonnegative=True)
_h = Symbol("h", positive=True)
_half = Dummy("half", positive=True)
_base = Dummy("base", positive=True)
_root = Dummy("root", positive=True)
_scale = Dummy("scale", positive=True)
_angle = Dummy("angle", positive=True)
_rest = Dummy("rest", positive=True)
_t = Dummy("tangent", positive=True)
_near = Dummy("near", positive=True)
_far = Dummy("far", positive=True)
_leaning = Dummy("leaning", real=True)
_lean = Dummy("lean", real=True)
_reach = Dummy("reach", nonnegative=True)
_longer = Dummy("longer", positive=True)
_quotient = Dummy("quotient", nonnegative=True)


def stable_program(sheet: FormulaSheet, outputs: dict[str, Expr], example: Point) -> Program:
    """The outputs in stable forms.

    `example` is any point that meets their assumptions.  A rule that needs the sign of an argument
    evaluates the argument at this point.
    """
    program = Program(outputs, tuple(_frame_steps(sheet)))
    program = angles_about_the_right_angle(program, sheet)
    program = shares_of_the_half_circle(program, sheet)
    program = logarithms_to_log1p(program, sheet)
    program = conjugate_roots(program)
    program = roots_under_the_edges(program)
    program = program.with_steps(
        Step(e, M / P, "lever arm of the load"), Step(_h, h, "contact width")
    )
    program = lengths_of_one_sign(program, sheet)
    program = sums_term_by_term(program)
    program = half_width_once(program)
    program = tangents_from_both_ends(program, example)
    program = common_factor_once(program)
    return program.renamed(q.name for q in sheet.geometry.parameters).ordered()


def prove_equal(program: Program, source: dict[str, Expr], points: Iterable[Point]) -> Proof:
    """Compare the program numerically with the formulas that it was made from."""
    plain = program.in_mathematics()
    steps = [(step.symbol, step.expr) for step in plain.steps]
    values = {name: numeric_by_steps(steps, expr) for name, expr in plain.outputs.items()}
    with mpmath.workdps(WORKING):
        return numerical_proof(
            "rewritten for floating point",
            (
                Comparison(value(point), numeric(source[name])(point), named(point))
                for point in points
                for name, value in values.items()
            ),
        )


def demand_equal(
    words: str, program: Program, source: dict[str, Expr], points: Iterable[Point]
) -> None:
    """Raise NotProven, which calls the formulas `words`, unless the program agrees with them."""
    proof = prove_equal(program, source, points)
    if not proof.holds:
        raise NotProven(f"{words}: {proof}")


def _frame_steps(sheet: FormulaSheet) -> list[Step]:
    steps = []
    for k in sheet.frame.kinks:
        at = f"the kink x = {k.kink.position}"
        steps += [
            Step(k.theta, k.angle, f"angle of the contact beyond {at}"),
            Step(k.w, k.root, f"root at {at}"),
        ]
    return steps


# ------------------------------------------------------------------ angles


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

    return _outputs_changed(program, change)


def _angles(expr: Expr, kinks: dict[Symbol, KinkFrame]) -> list[Expr]:
    return sorted((expr.free_symbols & kinks.keys()) | expr.atoms(atan2), key=str)


def _outputs_changed(program: Program, change: Callable[[Expr], Expr]) -> Program:
    return replace(program, outputs={n: change(v) for n, v in program.outputs.items()})


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

    return _outputs_changed(program, change)


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
        Step(_near, _scale * _t, "distance from the corner to the nearer edge"),
        Step(_far, _scale / _t, "distance from the corner to the farther edge"),
    ]
    outputs = {
        n: plain + (_on_side(-power * lean, steps) if power else 0)
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


def _on_side(lean: Expr, steps: list[Step]) -> Expr:
    """`far` where `lean` is positive and `near` where it is negative, without a branch.

    near <= far, and the two are equal where `lean` is zero.
    """
    if all(step.symbol != _leaning for step in steps):
        steps.append(
            Step(_leaning, sign(lean) * _far, "the farther edge, with the sign of its side")
        )
        return Max(_near, _leaning)
    same = next(step.expr for step in steps if step.symbol == _leaning) == sign(lean) * _far
    return Max(_near, _leaning if same else -_leaning)


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


# ------------------------------------------------------------------ logarithms and roots


def logarithms_to_log1p(program: Program, sheet: FormulaSheet) -> Program:
    """(1/2) log |(sqrt u + sqrt v)/(sqrt u - sqrt v)| -> (1/2) log1p(z),
    z = 2 (min(u, v) + sqrt(u v))/|u - v|.

    u - v = h (x - x_j) is a product of exact differences; u and v are divided by h.  At an edge, z
    is exactly zero, and so is the logarithm.  Outside the contact, u v has no real root, and z is
    set to zero.

    This serves formulas that are printed unchanged.  Their only kink is a corner that every contact
    spans.
    """
    words = "twice the logarithm of the kink"
    for k in sheet.frame.kinks:
        number, place = k.kink.number, k.kink.position
        left, right = (Dummy(f"{side}_{number}", real=True) for side in ("left", "right"))
        twice = Dummy(f"logarithm_{number}", nonnegative=True)
        steps = (
            Step(left, Kept(2 * k.right / h) * (a + x), "zero at the left edge"),
            Step(right, Kept(2 * k.left / h) * (c - x), "zero at the right edge"),
            Step(
                twice,
                kink_logarithm(left, right, x - place),
                f"{words} x = {place}",
            ),
        )
        program = program.mapped(lambda expr, L=k.L, to=twice / 2: expr.xreplace({L: to}))  # type: ignore[misc]
        program = replace(program, steps=(*program.steps, *steps))
    return program


def conjugate_roots(program: Program) -> Program:
    """r + A and r - A of one root r = sqrt(A**2 + B**2), the smaller from their product B**2.

    far = r + |A| and near = B**2/far.  The root is the larger of B and |A| times sqrt(1 + q**2),
    where q is the quotient of the smaller and the larger.  It does not overflow and loses no digits
    when one of the two is much larger than the other.
    """
    pairs = {name: _conjugate(expr) for name, expr in program.outputs.items()}
    legs = {(pair.leg, pair.other) for pair in pairs.values() if pair}
    if len(legs) != 1:
        return program
    ((leg, other),) = legs
    steps = [
        Step(_base, other, "half-width without the moment"),
        Step(_lean, leg, ""),
        Step(_reach, Abs(_lean), "distance by which the moment shifts the contact"),
        Step(_longer, Max(_base, _reach), ""),
        Step(_quotient, Min(_base, _reach) / _longer, ""),
        Step(_root, _longer * sqrt(1 + _quotient**2), ""),
        Step(_far, _reach + _root, "the farther edge"),
        Step(_near, _base * Kept(_over(_far, other)), "the nearer edge"),
    ]
    outputs = {
        name: pair.rest + _on_side(pair.sign * _lean, steps) if (pair := pairs[name]) else expr
        for name, expr in program.outputs.items()
    }
    program = replace(program, outputs=outputs).mapped(
        lambda expr: _quotients_to(other, expr).subs(leg, _lean)
    )
    return replace(program, steps=(*program.steps, *steps))


def _quotients_to(other: Expr, expr: Expr) -> Expr:
    """atan(y/B), with B replaced by its step."""
    return expr.replace(
        lambda n: isinstance(n, atan) and (n.args[0] * other).count_ops() < n.args[0].count_ops(),
        lambda n: atan(n.args[0] * other / _base),
    )


@dataclass(frozen=True)
class _Conjugate:
    """rest + sign A + sqrt(A**2 + B**2), with A = leg of either sign and B = other > 0."""

    leg: Expr
    other: Expr
    sign: int
    rest: Expr


def _conjugate(expr: Expr) -> _Conjugate | None:
    for root in (t for t in Add.make_args(expr) if isinstance(t, Pow) and t.exp == S.Half):
        legs = [sqrt(term) for term in Add.make_args(root.base)]
        if len(legs) != 2:
            continue
        for leg, other in (legs, legs[::-1]):
            signed = leg.replace(Abs, lambda inner: inner)
            for sense in (1, -1):
                rest = expr - root - sense * signed
                if other.is_positive and count_ops(rest) < count_ops(expr - root):
                    return _Conjugate(signed, other, sense, rest)
    return None


def _over(divisor: Expr, quotient: Expr) -> Expr:
    """(p/q)/divisor as p/(divisor q), without the rounding error of p/q."""
    above, below = fraction(quotient)
    for f in Mul.make_args(below):
        divisor = Kept(divisor * f)
    return above / divisor


def lengths_of_one_sign(program: Program, sheet: FormulaSheet) -> Program:
    """sqrt(a c)/a -> sqrt(c/a) or c/sqrt(a c), where all contacts have a > 0 and c > 0."""
    conditions = set(sheet["load"].conditions)
    known = {s: Symbol(str(s), positive=True) for s in (a, c) if (s > 0) in conditions}
    if len(known) < 2 or x in set().union(*(v.free_symbols for v in program.flat().values())):
        return program
    if len(program.outputs) > 1:  # w_j/(a + x_j) = (c - x_j)/w_j: all outputs share one root
        over = {k.w: k.left * k.right / k.w for k in sheet.frame.kinks}
        roots = {k.w: k.root for k in sheet.frame.kinks}
        return program.mapped(
            lambda expr: factor(expr.xreplace(over)).xreplace(roots) if expr.has(*over) else expr
        )
    opened = {k.w: k.root.subs(known) for k in sheet.frame.kinks}
    outputs = {
        name: powsimp(v.xreplace(opened | known)).xreplace({new: old for old, new in known.items()})
        for name, v in program.outputs.items()
    }
    return replace(program, outputs=outputs)


def sums_term_by_term(program: Program) -> Program:
    """c (p a + q c)/(a h) -> p' c/a + q' c/h if all terms are positive and the sum is shorter."""
    return _outputs_changed(program, _term_by_term)


def _term_by_term(product: Expr) -> Expr:
    sums = (f for f in Mul.make_args(product) if isinstance(f, Add))
    for total in (f for f in sums if f.free_symbols <= {a, c}):
        powers = (product / total).as_powers_dict()
        edges = Mul(*(s ** sign(powers[s]) for s in (a, c, _h) if abs(powers[s]) >= 1))
        for edge, other in ((a, c), (c, a)):
            terms = expand(total.subs(edge, _h - other) * edges)
            positive = all(not t.could_extract_minus_sign() for t in Add.make_args(terms))
            if positive and count_ops(terms) < count_ops(total * edges):
                return product / (total * edges) * terms
    return product


def roots_under_the_edges(program: Program) -> Program:
    """sqrt((a + x)(c - x)) -> sqrt(max(0, (a + x)(c - x))), which is zero outside the contact."""
    if not any(expr.has(x) for expr in program.outputs.values()):
        return program
    program = program.mapped(lambda expr: expr.subs(w, _w))
    return program.with_steps(Step(_w, sqrt(Max(0, (a + x) * (c - x))), "root at x"))


# ------------------------------------------------------------------ terms shared by the outputs


def half_width_once(program: Program) -> Program:
    """a = half - mid and c = half + mid: compute the common term, half the width, once."""
    if not {"a", "c"} <= program.outputs.keys():
        return program
    left, right = ({*Add.make_args(program.outputs[edge])} for edge in ("a", "c"))
    half = Add(*(left & right))
    if half == 0 or not half.atoms(Pow):
        return program
    return replace(
        program,
        outputs=dict(program.outputs)
        | {"a": _half + Add(*(left - right)), "c": _half + Add(*(right - left))},
        steps=(*program.steps, Step(_half, half, "half the contact width")),
    )


def common_factor_once(program: Program) -> Program:
    """left = F u and right = F v: compute F once, unless that would split a root."""
    products = {n: v for n, v in program.outputs.items() if isinstance(v, Mul)}
    if len(products) < 2:
        return program
    common = _common_factor(list(products.values()))
    if any(_roots(v / common) for v in products.values()):
        common = Mul(*(f for f in Mul.make_args(common) if not _roots(f)))
    above, below = fraction(common)
    if common == 1 or common.is_Symbol or (above == 1 and below.is_Symbol):
        return program
    symbol, once = (_root, below) if above == 1 else (_scale, common)
    shared = symbol if above != 1 else 1 / symbol
    outputs = {n: v / common * shared if n in products else v for n, v in program.outputs.items()}
    return replace(program, outputs=outputs, steps=(*program.steps, Step(symbol, once, "")))


def _roots(expr: Expr) -> set[Expr]:
    return {p for p in expr.atoms(Pow) if p.exp.is_Rational and p.exp.q == 2}


def _common_factor(products: list[Expr]) -> Expr:
    """The common factor of all products, with the smallest power of each base."""
    first, *others = products
    if all(other == first for other in others):
        return first
    common = S.One
    for base, exponent in first.as_powers_dict().items():
        exponents = [exponent, *(p.as_powers_dict().get(base, S.Zero) for p in others)]
        if all(e.is_number and e * exponent > 0 for e in exponents):
            common *= base ** min(exponents, key=abs)
    return common
