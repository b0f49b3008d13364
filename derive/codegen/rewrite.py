r"""Formulas in forms that keep their digits in floating point.

In:  the outputs of one function, with the sheet's symbols.
Out: a Program in stable forms, compared with its source at 30 digits before it is used.

Each rule is one function with the identity it uses in its docstring; none knows any geometry.
"""

from collections.abc import Iterable
from dataclasses import replace

import mpmath
from sympy import (
    Abs,
    Add,
    Expr,
    Function,
    Max,
    Min,
    Mul,
    Piecewise,
    Poly,
    Pow,
    S,
    Symbol,
    asinh,
    atan2,
    cancel,
    count_ops,
    cse,
    factor,
    log,
    numbered_symbols,
    pi,
    simplify,
    sqrt,
    tan,
    together,
)

from derive.codegen.program import Program, Step
from derive.proof.points import Point, named, numeric
from derive.proof.verdict import WORKING, Comparison, Proof, numerical_proof
from derive.sheet import FormulaSheet
from derive.symbols import M, P, a, c, e, h, w, x
from derive.theory.frame import KinkFrame

_w = Symbol("w", nonnegative=True)
_h = Symbol("h", positive=True)
_base = Symbol("base", positive=True)
_ratio = Symbol("ratio", real=True)
_root = Symbol("root", positive=True)
_angle = Symbol("angle", positive=True)
_rest = Symbol("rest", positive=True)
_tangent = Symbol("tangent", positive=True)


def stable_program(sheet: FormulaSheet, outputs: dict[str, Expr], example: Point) -> Program:
    """The outputs in stable forms.

    `example` is any point of their assumptions; rules that need the sign of an argument take it there.
    """
    program = Program(outputs, tuple(_frame_steps(sheet)))
    program = angles_about_the_right_angle(program, sheet)
    program = logarithms_to_asinh(program)
    program = conjugate_roots(program)
    program = tangents_from_both_ends(program, example)
    program = program.with_step(Step(e, M / P, "lever arm of the load"))
    program = program.with_step(Step(_w, sqrt(Max(0, (a + x) * (c - x))), ""))
    program = program.mapped(lambda expr: expr.subs(w, _w))
    program = program.with_step(Step(_h, h, "contact width"))
    return shared_once(program).ordered()


def prove_equal(program: Program, source: dict[str, Expr], points: Iterable[Point]) -> Proof:
    """The program against the formulas that it was made from."""
    flat = program.flat()
    with mpmath.workdps(WORKING):
        return numerical_proof(
            "rewritten for floating point",
            (
                Comparison(numeric(expr)(point), numeric(source[name])(point), named(point))
                for point in points
                for name, expr in flat.items()
            ),
        )


def _frame_steps(sheet: FormulaSheet) -> list[Step]:
    steps = []
    for k in sheet.frame.kinks:
        at = f"the kink x = {k.kink.position}"
        steps += [
            Step(k.theta, k.angle, f"angle of the contact beyond {at}"),
            Step(k.w, k.root, f"root at {at}"),
            Step(k.L, k.logarithm, f"logarithm of {at}"),
        ]
    return steps


# ------------------------------------------------------------------ rules


def angles_about_the_right_angle(program: Program, sheet: FormulaSheet) -> Program:
    """q (pi/2 - theta_j) -> q atan2(v - u, 2 w_j) for theta_j = 2 atan2(sqrt u, sqrt v), u v =
    w_j**2; q (pi/2 - atan2(y, x)) -> q atan2(x, y) for y > 0; q (pi - theta_j) -> q theta_j of the other side.

    A tilt near zero is a difference of angles near pi/2; the difference of u and v is exact instead.
    """
    kinks = {k.theta: k for k in sheet.frame.kinks}

    def change(expr: Expr) -> Expr:
        angles = sorted((expr.free_symbols & kinks.keys()) | expr.atoms(atan2), key=str)
        for angle in angles:
            stand_in = Symbol("angle_stand_in")
            linear = expr.subs(angle, stand_in)
            if not linear.is_polynomial(stand_in) or Poly(linear, stand_in).degree() != 1:
                continue
            factor_of, rest = Poly(linear, stand_in).all_coeffs()
            if simplify(rest + factor_of * pi / 2) == 0:
                expr = simplify(-factor_of) * _complement(angle, kinks)
            elif angle in kinks and simplify(rest + factor_of * pi) == 0:
                expr = simplify(-factor_of) * _opposite(kinks[angle])
        return expr

    steps = tuple(s for s in program.steps)
    return replace(program, outputs={n: change(v) for n, v in program.outputs.items()}, steps=steps)


def _complement(angle: Expr, kinks: dict[Symbol, KinkFrame]) -> Expr:
    if isinstance(angle, atan2):
        y, along = angle.args
        return atan2(along, y)
    k = kinks[angle]
    return atan2(k.kink.side * simplify(k.left - k.right), 2 * k.w)


def _opposite(k: KinkFrame) -> Expr:
    y, along = k.angle.args[1].args
    return 2 * atan2(along, y)


def logarithms_to_asinh(program: Program) -> Program:
    """(1/2) log |(sqrt u + sqrt v)/(sqrt u - sqrt v)| -> asinh( sqrt(min(u, v)) / sqrt|u - v| ).

    The difference u - v is factored, so that it is a product of exact differences; at an edge
    min(u, v) vanishes instead of a logarithm of one, and far from it nothing overflows before the root is taken.
    """

    def change(expr: Expr) -> Expr:
        return expr.replace(log, lambda argument: _asinh(argument) or log(argument))

    return program.mapped(change)


def _asinh(argument: Expr) -> Expr | None:
    quotient = argument.args[0] if isinstance(argument, Abs) else argument
    top, bottom = quotient.as_numer_denom()
    if not (isinstance(top, Add) and len(top.args) == 2):
        return None
    first, second = top.args
    if simplify(bottom - (first - second)) != 0 and simplify(bottom + (first - second)) != 0:
        return None
    if not all(isinstance(r, Pow) and r.exp == S.Half for r in (first, second)):
        return None
    u, v = first.base, second.base
    gap = Mul.make_args(factor(u - v))
    smaller = Max(0, Min(u, v))
    return 2 * asinh(sqrt(smaller) / Mul(*(_root_of(f) for f in gap if f != -1)))


def _root_of(factor_of_gap: Expr) -> Expr:
    return sqrt(
        factor_of_gap if factor_of_gap.is_positive or factor_of_gap == h else Abs(factor_of_gap)
    )


def conjugate_roots(program: Program) -> Program:
    """+-A + sqrt(A**2 + B**2) -> B (r +- t) or, where that would cancel, B/(r -+ t); t = A/B, r = sqrt(1 + t**2).

    A and B are never squared alone, so that neither overflows.
    """
    steps: list[Step] = []

    def change(expr: Expr) -> Expr:
        if not isinstance(expr, Add):
            return expr
        for root in [r for r in expr.args if isinstance(r, Pow) and r.exp == S.Half]:
            legs = [sqrt(term) for term in Add.make_args(root.base)]
            if len(legs) != 2:
                continue
            for leg, other in (legs, legs[::-1]):
                signed = _plain(leg)
                for sign in (1, -1):
                    rest = expr - root - sign * signed
                    if count_ops(rest) < count_ops(expr - root) and other.is_positive:
                        return rest + _conjugate(signed, other, sign, steps)
        return expr

    outputs = {name: change(expr) for name, expr in program.outputs.items()}
    program = replace(program, outputs=outputs)
    if steps:
        base, ratio, _ = steps[:3]
        of_loads = ratio.expr.subs(_base, base.expr)
        program = program.mapped(lambda expr: expr.subs(of_loads, _ratio))
    for step in steps:
        program = program.with_step(step)
    return program


def _plain(leg: Expr) -> Expr:
    """2 |e| -> 2 e: the rule asks for the sign of its leg."""
    return leg.replace(Abs, lambda inner: inner)


def _conjugate(leg: Expr, other: Expr, sign: int, steps: list[Step]) -> Expr:
    steps += [
        Step(_base, other, "half-width without the moment"),
        Step(_ratio, leg / _base, "eccentricity of the load"),
        Step(_root, sqrt(1 + _ratio**2), ""),
    ]
    signed = sign * _ratio
    safe = signed >= 0
    return _base * Piecewise((_root + signed, safe), (1 / (_root - signed), True))


def tangents_from_both_ends(program: Program, example: Point) -> Program:
    """tan z -> tan z up to pi/4 and 1/tan(pi/2 - z) beyond, the rest pi/2 - z in factored form.

    Near pi/2 the rest is the exact small difference, and z is not.
    """
    tangents = sorted({t for v in program.outputs.values() for t in v.atoms(tan)}, key=str)
    if len(tangents) != 1:
        return program
    (tangent,) = tangents
    sign = 1 if numeric(tangent.args[0])(example) > 0 else -1
    angle = factor(together(sign * tangent.args[0]))
    rest = factor(together(pi / 2 - angle))
    safe = Piecewise((tan(_angle), _angle <= pi / 4), (1 / tan(_rest), True))
    outputs = {n: cancel(v.subs(tangent, sign * _tangent)) for n, v in program.outputs.items()}
    program = replace(program, outputs=outputs)
    steps = (
        Step(_angle, angle, "half the angle of the corner"),
        Step(_rest, rest, "what it lacks of a right angle"),
        Step(_tangent, safe, ""),
    )
    return replace(program, steps=(*program.steps, *steps))


def shared_once(program: Program) -> Program:
    """What several outputs share is computed once, if it holds a root or a function."""
    shared, _ = cse(list(program.outputs.values()), symbols=numbered_symbols("shared_", start=1))
    for symbol, expr in shared:
        costly = expr.atoms(Function) or any(
            p.exp.is_Rational and p.exp.q > 1 for p in expr.atoms(Pow)
        )
        alone = expr in program.outputs.values()
        if costly and not alone and not expr.free_symbols & {s for s, _ in shared}:
            program = program.with_step(Step(symbol, expr, ""))
    return program
