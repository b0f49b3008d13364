r"""Rewrites formulas into forms that do not lose digits in floating point.

In:  the outputs of one function, in the symbols of the sheet.
Out: a Program in stable forms, which is compared with its source to 30 digits before it is used.

Each rule is one function, whose docstring states the identity that it uses.  No rule depends on a
particular geometry.
"""

from collections.abc import Iterable
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
    Pow,
    S,
    Symbol,
    atan,
    count_ops,
    expand,
    factor,
    fraction,
    powsimp,
    sign,
    sqrt,
)

from derive.codegen.angles import (
    angles_about_the_right_angle,
    far,
    near,
    on_side,
    shares_of_the_half_circle,
    tangents_from_both_ends,
)
from derive.codegen.program import Kept, Program, Step
from derive.proof.points import Point, named, numeric, numeric_by_steps
from derive.proof.verdict import WORKING, Comparison, Proof, numerical_proof
from derive.sheet.formulas import FormulaSheet
from derive.symbols import M, P, a, c, e, h, w, x
from derive.theory.segments import kink_logarithm

_w = Symbol("w", nonnegative=True)
_h = Symbol("h", positive=True)
_half, _base, _root, _scale, _longer = (
    Dummy(name, positive=True) for name in ("half", "base", "root", "scale", "longer")
)
_reach, _quotient = (Dummy(name, nonnegative=True) for name in ("reach", "quotient"))
_lean = Dummy("lean", real=True)


def stable_program(sheet: FormulaSheet, outputs: dict[str, Expr], example: Point) -> Program:
    """The outputs in stable forms.

    `example` is any point that meets their assumptions.  A rule that needs the sign of an argument
    evaluates the argument at this point.
    """
    steps: list[Step] = []
    for k in sheet.frame.kinks:
        at = f"the kink x = {k.kink.position}"
        steps.append(Step(k.theta, k.angle, f"angle of the contact beyond {at}"))
        steps.append(Step(k.w, k.root, f"root at {at}"))
    program = Program(outputs, tuple(steps))
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
            Step(twice, kink_logarithm(left, right, x - place), f"{words} x = {place}"),
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
        Step(far, _reach + _root, "the farther edge"),
        Step(near, _base * Kept(_over(far, other)), "the nearer edge"),
    ]
    outputs = {
        name: pair.rest + on_side(pair.sign * _lean, steps) if (pair := pairs[name]) else expr
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
    if len(known) < 2 or any(x in expr.free_symbols for expr in program.ordered().exprs):
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
    return program.with_outputs(_term_by_term)


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
