"""Rewrites closed formulas for floating point.

In:  the outputs of one function, in the symbols of the sheet.
Out: a Program.  `trial` compares what it gives with the sheet.

Each rule is one function, whose docstring states the identity that it uses.  No rule depends on a
particular geometry.
"""

from collections.abc import Iterable, Mapping
from dataclasses import replace

from sympy import (
    Abs,
    Add,
    Dummy,
    Expr,
    Max,
    Piecewise,
    S,
    Symbol,
    atan2,
    expand,
    factor,
    pi,
    simplify,
    sqrt,
    tan,
    together,
)

from derive.body.piece import vanishes
from derive.codegen.program import Program
from derive.proof.points import Point, numeric
from derive.sheet.formulas import FormulaSheet
from derive.symbols import M, P, a, alpha, c, e, h, w, x
from derive.theory.frame import Frame
from derive.theory.parts import Definition, parts_of
from derive.theory.segments import kink_logarithm

_w = Symbol("w", nonnegative=True)
_h = Symbol("h", positive=True)
_base, _reach = (Dummy(name, positive=True) for name in ("base", "reach"))
_tangent = Dummy("tangent", real=True)


def stable_program(sheet: FormulaSheet, outputs: Mapping[str, Expr], example: Point) -> Program:
    """The outputs in stable forms; `example` is any point that meets their assumptions."""
    frame = sheet.frame
    steps: list[Definition] = []
    for k in frame.kinks:
        at = f"the kink x = {k.kink.position}"
        steps.append(Definition(k.theta, k.angle, f"angle of the contact beyond {at}"))
        steps.append(Definition(k.w, k.root, f"root at {at}"))
    program = Program(outputs, tuple(steps)).with_outputs(
        lambda expr: logarithms_to_log1p(angles_about_the_right_angle(expr, frame), frame)
    )
    program = roots_under_the_edges(sums_without_difference(program)).with_steps(
        Definition(e, M / P, "lever arm of the load"), Definition(_h, h, "contact width")
    )
    program = tangents_from_both_ends(program, example)
    return program.renamed(q.name for q in sheet.geometry.parameters).ordered()


def summed_program(sheet: FormulaSheet, fields: Iterable[tuple[str, str | Symbol]]) -> Program:
    """The formulas of `fields` as sums over the parts of a contact, whose terms have one sign."""
    outputs = {field: sheet[str(name)].computed for field, name in fields}
    program = Program(outputs, parts_of(sheet.frame).definitions)
    return program.ordered().renamed(q.name for q in sheet.geometry.parameters)


# ------------------------------------------------------------------ kinks


def angles_about_the_right_angle(expr: Expr, frame: Frame) -> Expr:
    """Apply two identities, with theta_j = 2 atan2(sqrt u, sqrt v) and u v = w_j**2.

        q (pi/2 - theta_j)     -> q atan2(v - u, 2 w_j)
        q (pi/2 - atan2(y, x)) -> q atan2(x, y) for y > 0

    A tilt near zero is a small difference of angles near pi/2.  The difference of u and v, in
    contrast, is exact.
    """
    complements = {angle: atan2(*reversed(angle.args)) for angle in expr.atoms(atan2)}
    for k in frame.kinks:
        complements[k.theta] = atan2(k.kink.side * simplify(k.left - k.right), 2 * k.w)
    for angle, complement in complements.items():
        times = expand(expr).coeff(angle)
        if times != 0 and vanishes(expr.xreplace({angle: pi / 2})):
            expr = simplify(-times) * complement
    return expr


def logarithms_to_log1p(expr: Expr, frame: Frame) -> Expr:
    """(1/2) log |(sqrt u + sqrt v)/(sqrt u - sqrt v)| -> (1/2) log1p(z),
    z = 2 (min(u, v) + sqrt(u v))/|u - v|.

    u - v = h (x - x_j) is a product of exact differences; u and v are divided by h.  At an edge, z
    is exactly zero, and so is the logarithm.  Outside the contact, u v has no real root, and z is
    set to zero.
    """
    return expr.xreplace(
        {
            k.L: kink_logarithm(2 * k.u / h, 2 * k.v / h, x - k.kink.position) / 2
            for k in frame.kinks
        }
    )


# ------------------------------------------------------------------ sums and tangents


def sums_without_difference(program: Program) -> Program:
    """A + sqrt(A**2 + B**2) -> B**2/(sqrt(A**2 + B**2) - A) where A < 0, for one B > 0."""
    steps: tuple[Definition, ...] = ()

    def change(expr: Expr) -> Expr:
        nonlocal steps
        for root in (t for t in Add.make_args(expr) if t.is_Pow and t.exp == S.Half):
            leg = expr - root
            other = sqrt(factor(root.base - expand(leg**2)))
            if other.is_positive:
                steps = (
                    Definition(_base, other, "half-width without the moment"),
                    Definition(_reach, sqrt(leg**2 + _base**2), "half-width with the moment"),
                )
                return Piecewise((leg + _reach, leg > 0), (_base**2 / (_reach - leg), True))
        return expr

    return program.with_outputs(change).with_steps(*steps)


def tangents_from_both_ends(program: Program, example: Point) -> Program:
    """tan z -> -1/tan(z - pi/2) where z > pi/4, and the same for -z.

    Next to pi/2, the angle z - pi/2 is an exact small difference, but z is not.  Tangents of
    parameters alone are not changed.
    """
    of_tilt = {t for v in program.outputs.values() for t in v.atoms(tan) if t.has(alpha)}
    if len(of_tilt) != 1:
        return program
    (tangent,) = of_tilt
    (angle,) = tangent.args
    right = pi / 2 if numeric(angle)(example) > 0 else -pi / 2
    rest = factor(together(angle - right))
    both = Piecewise((tangent, Abs(angle) < pi / 4), (-1 / tan(rest), True))
    program = program.with_outputs(lambda expr: expr.xreplace({tangent: _tangent}))
    step = Definition(_tangent, both, "from the nearer of 0 and a right angle")
    return replace(program, steps=(*program.steps, step))


# ------------------------------------------------------------------ roots and factors


def roots_under_the_edges(program: Program) -> Program:
    """sqrt((a + x)(c - x)) -> sqrt(max(0, (a + x)(c - x))), which is zero outside the contact."""
    if not any(expr.has(x) for expr in program.outputs.values()):
        return program
    program = program.mapped(lambda expr: expr.subs(w, _w))
    return program.with_steps(Definition(_w, sqrt(Max(0, (a + x) * (c - x))), "root at x"))
