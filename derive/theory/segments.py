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

    @staticmethod
    def definition(*_: Expr) -> Expr:
        """The function in terms of elementary functions."""
        raise NotImplementedError

    @property
    def written_out(self) -> Expr:
        """The value in terms of elementary functions."""
        return self.definition(*self.args)

    def _eval_is_extended_real(self) -> bool:
        return True

    def _latex(self, printer: LatexPrinter, exp: str | None = None) -> str:
        name = type(self).__name__.replace("_", r"\_")
        power = f"^{{{exp}}}" if exp else ""
        arguments = ", ".join(map(printer.doprint, self.args))
        return rf"\operatorname{{{name}}}{power}{{\left({arguments} \right)}}"


_t, _near, _far, _across = symbols("t near far across", real=True)
_sine, _cosine, _start, _end = symbols("u v start end", positive=True)
_ends = symbols("u_1 v_1 u_2 v_2", positive=True)
_A, _B, _d = symbols("A B d", real=True)


class segment(Named):
    """t - sin(t) cos(t): the area of a segment of the unit circle with the angle 2 t."""

    nargs = 1
    letters = (_t,)

    @staticmethod
    def definition(t: Expr) -> Expr:
        """The definition in elementary functions."""
        return t - sin(t) * cos(t)


class involute(Named):
    """sin(t) - t cos(t): the second coordinate of the involute of the unit circle."""

    nargs = 1
    letters = (_t,)

    @staticmethod
    def definition(t: Expr) -> Expr:
        """The definition in elementary functions."""
        return sin(t) - t * cos(t)


class edge_angle(Named):
    """2 atan2(sqrt(A), sqrt(B)), where negative A and B count as zero.

    It is the angle of a part that ends at an edge; A and B are the distances of the part's other
    end from both edges.
    """

    nargs = 2
    of_a_quotient = True
    letters = (_A, _B)

    @staticmethod
    def definition(within: Expr, beyond: Expr) -> Expr:
        """The definition in elementary functions."""
        return 2 * atan2(sqrt(Max(0, within)), sqrt(Max(0, beyond)))


class part_area(Named):
    """int w ds divided by h**2/8, for a part between two kinks.

    across: sine of half the sum of the angles of its ends.
    """

    nargs = 2
    letters = (_t, _across)

    @staticmethod
    def definition(t: Expr, across: Expr) -> Expr:
        """The definition in elementary functions."""
        return t - sin(t) + 2 * sin(t) * across**2


class part_arm(Named):
    """int w (s - mid) ds divided by h**3/24, for a part between two kinks."""

    nargs = 5
    letters = (_t, *_ends)

    @staticmethod
    def definition(t: Expr, *halves: Expr) -> Expr:
        """The definition in elementary functions."""
        sine_1, cosine_1, sine_2, cosine_2 = halves
        first, last = sine_1 * cosine_1, sine_2 * cosine_2
        squares = first**2 + first * last + last**2
        return 8 * sin(t / 2) * (sine_1 * sine_2 - cosine_1 * cosine_2) * squares


class part_weight(Named):
    """int w/A ds/h, for a part between two kinks; B instead of A for the right edge.

    far: product of the cosines of half the angles of its ends; product of the sines for B.
    """

    nargs = 2
    letters = (_t, _far)

    @staticmethod
    def definition(t: Expr, far: Expr) -> Expr:
        """The definition in elementary functions."""
        return segment(t / 2).written_out + 2 * sin(t / 2) * far


class root_ratio(Named):
    """sqrt(A/B), or zero unless both are positive."""

    nargs = 2
    of_a_quotient = True
    letters = (_A, _B)

    @staticmethod
    def definition(above: Expr, below: Expr) -> Expr:
        """The definition in elementary functions."""
        return Piecewise((sqrt(above / below), (above > 0) & (below > 0)), (S.Zero, True))


class kink_logarithm(Named):
    """log(1 + (sqrt(A B) + Min(A, B))/Abs(d)), or zero if A or B is negative.

    A fourth argument is a lower bound on |d|.
    """

    nargs = (3, 4)
    of_a_quotient = True
    letters = (_A, _B, _d)

    @staticmethod
    def definition(left: Expr, right: Expr, offset: Expr, *_: Expr) -> Expr:
        """The definition inside the contact, where |d| is above its lower bound."""
        nearer = (left + right - Abs(left - right)) / 2  # not Min, which compares its arguments
        return log(1 + (sqrt(left * right) + nearer) / Abs(offset))


class second_term(Named):
    """int (sin(v)**2 + 2 tan(v)**2) dv over the half angles of a part; 0 if it ends at the edge."""

    nargs = 3
    letters = (_t, _near, _far)

    @staticmethod
    def definition(t: Expr, near: Expr, far: Expr) -> Expr:
        """The definition in elementary functions; `rise` is the difference of the tangents."""
        rise = sin(t / 2) / far
        found = 2 * rise - 3 * t / 4 + sin(t / 2) * (near - far) / 2
        return Piecewise((found, far > 0), (S.Zero, True))


class end_pressure(Named):
    """int L ds/h over a part between an edge and a kink; u and v are sine and cosine of x."""

    nargs = 3
    letters = (_t, _sine, _cosine)

    @staticmethod
    def definition(t: Expr, sine: Expr, cosine: Expr) -> Expr:
        """The definition in elementary functions."""
        p, q = sin(t / 2) * cosine, cos(t / 2) * sine
        return t / 2 * sine * cosine + (p**2 - q**2) * _level(p, q)


class part_pressure(Named):
    """int L ds/h over a part between two kinks; u, v: sines and cosines of the kinks and of x."""

    nargs = 9
    letters = (_t, _start, _end, *_ends, _sine, _cosine)

    @staticmethod
    def definition(t: Expr, start: Expr, end: Expr, *halves: Expr) -> Expr:
        """The definition in elementary functions; zero if the part is empty."""
        sine_1, cosine_1, sine_2, cosine_2, sine, cosine = halves
        first = _level(sine_1 * cosine, cosine_1 * sine)
        second = _level(sine_2 * cosine, cosine_2 * sine)
        return t / 2 * sine * cosine + end * second - start * first


def _level(p: Expr, q: Expr) -> Expr:
    """L of two points, from products of a sine and a cosine."""
    return log(Abs((p + q) / (p - q))) / 2


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
    return {f(*f.letters): f.definition(*f.letters) for f in FUNCTIONS if f in held}
