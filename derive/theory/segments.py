r"""Functions of the angle that a part of a contact spans, by which its integrals are computed.

A part spans an angle t on the half circle x = mid - (h/2) cos(theta).  For a part between an edge
and a kink, int w ds is the area of a segment of a circle,

    int w ds = (h**2/8) segment(t),    segment(t) = t - sin(t) cos(t).

generated/runtime/segments.py evaluates these functions.
"""

from collections.abc import Iterable

from sympy import (
    Abs,
    Expr,
    Function,
    Max,
    Piecewise,
    S,
    Symbol,
    atan2,
    cos,
    log,
    sin,
    sqrt,
    symbols,
)
from sympy.printing.latex import LatexPrinter


class Named(Function):
    """A real function that the formulas call by its name."""

    letters: tuple[Symbol, ...] = ()
    """Arguments in its definition."""

    definition: Expr = S.NaN
    """The function of these letters in terms of elementary functions."""

    @classmethod
    def class_key(cls) -> tuple[int, int, str]:
        """The place in the order of terms: behind SymPy's own functions."""
        return 4, 10000, cls.__name__

    @property
    def written_out(self) -> Expr:
        """The value in terms of elementary functions."""
        return self.definition.xreplace(dict(zip(self.letters, self.args, strict=True)))

    def _eval_is_extended_real(self) -> bool:
        return True

    def _latex(self, printer: LatexPrinter, exp: str | None = None) -> str:
        name = type(self).__name__.replace("_", r"\_")
        power = f"^{{{exp}}}" if exp else ""
        arguments = ", ".join(map(printer.doprint, self.args))
        return rf"\operatorname{{{name}}}{power}{{\left({arguments} \right)}}"


_t, _near, _far, _across = symbols("t near far across", real=True)
_sine, _cosine, _start, _end = symbols("u v start end", positive=True)
_ends = _u_1, _v_1, _u_2, _v_2 = symbols("u_1 v_1 u_2 v_2", positive=True)
_A, _B, _d = symbols("A B d", real=True)


def _level(p: Expr, q: Expr) -> Expr:
    """L of two points, from products of a sine and a cosine."""
    return log(Abs((p + q) / (p - q))) / 2


class segment(Named):
    """t - sin(t) cos(t): the area of a segment of the unit circle with the angle 2 t."""

    letters = (_t,)
    definition = _t - sin(_t) * cos(_t)


class involute(Named):
    """sin(t) - t cos(t): the second coordinate of the involute of the unit circle."""

    letters = (_t,)
    definition = sin(_t) - _t * cos(_t)


class edge_angle(Named):
    """2 atan2(sqrt(A), sqrt(B)), where negative A and B count as zero.

    It is the angle of a part that ends at an edge; A and B are the distances of the part's other
    end from both edges.
    """

    of_a_quotient = True
    letters = (_A, _B)
    definition = 2 * atan2(sqrt(Max(0, _A)), sqrt(Max(0, _B)))


class part_area(Named):
    """int w ds divided by h**2/8, for a part between two kinks.

    across: sine of half the sum of the angles of its ends.
    """

    letters = (_t, _across)
    definition = _t - sin(_t) + 2 * sin(_t) * _across**2


class part_arm(Named):
    """int w (s - mid) ds divided by h**3/24, for a part between two kinks."""

    letters = (_t, *_ends)
    definition = (
        8
        * sin(_t / 2)
        * (_u_1 * _u_2 - _v_1 * _v_2)
        * ((_u_1 * _v_1) ** 2 + _u_1 * _v_1 * _u_2 * _v_2 + (_u_2 * _v_2) ** 2)
    )


class part_weight(Named):
    """int w/A ds/h, for a part between two kinks; B instead of A for the right edge.

    far: product of the cosines of half the angles of its ends; product of the sines for B.
    """

    letters = (_t, _far)
    definition = segment(_t / 2).written_out + 2 * sin(_t / 2) * _far


class root_ratio(Named):
    """sqrt(A/B), or zero unless both are positive."""

    of_a_quotient = True
    letters = (_A, _B)
    definition = Piecewise((sqrt(_A / _B), (_A > 0) & (_B > 0)), (S.Zero, True))


class kink_logarithm(Named):
    """log(1 + (sqrt(A B) + Min(A, B))/Abs(d)), or zero if A or B is negative.

    The definition holds inside the contact; it contains no Min, which would compare its arguments.
    """

    of_a_quotient = True
    letters = (_A, _B, _d)
    definition = log(1 + (sqrt(_A * _B) + (_A + _B - Abs(_A - _B)) / 2) / Abs(_d))


class second_term(Named):
    """int (sin(v)**2 + 2 tan(v)**2) dv over the half angles of a part; 0 if it ends at the edge.

    In its definition, sin(t/2)/far is the difference of the tangents.
    """

    letters = (_t, _near, _far)
    definition = Piecewise(
        (2 * sin(_t / 2) / _far - 3 * _t / 4 + sin(_t / 2) * (_near - _far) / 2, _far > 0),
        (S.Zero, True),
    )


class end_pressure(Named):
    """int L ds/h over a part between an edge and a kink; u and v are sine and cosine of x."""

    letters = (_t, _sine, _cosine)
    definition = _t / 2 * _sine * _cosine + (
        (sin(_t / 2) * _cosine) ** 2 - (cos(_t / 2) * _sine) ** 2
    ) * _level(sin(_t / 2) * _cosine, cos(_t / 2) * _sine)


class part_pressure(Named):
    """int L ds/h over a part between two kinks; u, v: sines and cosines of the kinks and of x."""

    letters = (_t, _start, _end, *_ends, _sine, _cosine)
    definition = (
        _t / 2 * _sine * _cosine
        + _end * _level(_u_2 * _cosine, _v_2 * _sine)
        - _start * _level(_u_1 * _cosine, _v_1 * _sine)
    )


FUNCTIONS = (
    *(edge_angle, segment, involute, part_area, part_arm, part_weight, root_ratio),
    *(kink_logarithm, second_term, end_pressure, part_pressure),
)
"""All named functions; the runtime contains each of them under the same name."""


def written_out(expr: Expr) -> Expr:
    """`expr` with every named function written in elementary functions."""
    return expr.replace(lambda e: isinstance(e, Named), lambda e: e.written_out)


def definitions_of(exprs: Iterable[Expr]) -> dict[Expr, Expr]:
    """Definitions of the named functions that expressions contain."""
    held = {type(node) for expr in exprs for node in expr.atoms(Named)}
    return {f(*f.letters): f.definition for f in FUNCTIONS if f in held}
