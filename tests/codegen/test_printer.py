"""Printed text means what the expression means; what has no NumPy code is refused."""

from itertools import product

import mpmath
import numba
import numpy as np
import pytest
from sympy import (
    ITE,
    Abs,
    Add,
    Basic,
    Catalan,
    E,
    EulerGamma,
    Expr,
    Float,
    Function,
    GoldenRatio,
    Heaviside,
    I,
    Integer,
    Integral,
    Max,
    Min,
    Mul,
    Piecewise,
    Pow,
    Rational,
    Symbol,
    TribonacciConstant,
    acos,
    acosh,
    asin,
    asinh,
    atan,
    atan2,
    atanh,
    ceiling,
    cos,
    cosh,
    exp,
    floor,
    lambdify,
    log,
    nan,
    pi,
    sec,
    sign,
    sin,
    sinh,
    sqrt,
    symbols,
    tan,
    tanh,
    zeta,
    zoo,
)

from derive.codegen.printer import CannotPrint, NumPyPrinter
from generated.runtime import elementary, kernels

x, y, z = symbols("x y z", real=True)
p, q = symbols("p q", positive=True)
t = Symbol("t", real=True)
n = Symbol("n", integer=True)

# All exact in binary; p and q are positive, t lies between -1 and 1, n is whole.
POINTS = {
    x: (0.75, -1.5, 2.25),
    y: (-1.25, 0.5, 3.0),
    z: (2.5, -0.375, 2.0),
    p: (0.625, 3.0, 1.5),
    q: (3.0, 0.25, 1.75),
    t: (0.5, -0.75, 0.125),
    n: (2.0, 3.0, -1.0),
}

TOLERANCE = 1e-15  # a few units in the last place


def held(kind: type[Expr], *args: Expr | int) -> Expr:
    """An expression as it stands."""
    return kind(*args, evaluate=False)


SUMS = [
    *(x + y, x - y, -x - y, -x, x - Rational(1, 2), Rational(1, 3) - x, x + 2 * y - 3 * z),
    *(held(Add, x, held(Add, y, z)), held(Add, x, held(Mul, -1, held(Add, y, z)))),
    *(held(Add, -x, -y), held(Mul, -1, x + y)),
    held(Mul, -1, held(Add, x, -y)),
]
PRODUCTS = [
    *(x * y, x * (y + z), 2 * x * (y + z) / 3, x / y, x / (y * z), x / y / z, -x / y, -2 * x),
    *(-x * (y - z), Rational(-3, 7) * x, Rational(5, 2) / x, pi * x, x / pi, pi**2 * x),
    *(Integer(10) ** 30 * x, held(Mul, x, Rational(1, 2), Rational(1, 3)), held(Mul, -1, -1, x)),
    *(held(Mul, -x, -y), held(Mul, x, -1), held(Mul, 2, held(Mul, x, y))),
    *(held(Mul, x, Pow(held(Mul, y, z), -1)), x * (y + z), x / (y + z)),
    *(1 / Max(x, y), 2 * Piecewise((x, x > y), (y, True)) / z),
]
POWERS = [
    *(x**2, x**3, -(x**2), x**-2, 1 / x, (x + y) ** 2, (x + y) ** -2, 1 / (x + y), (x * y) ** 2),
    *(held(Pow, -x, 2), held(Pow, -x, 3), held(Pow, x**2, 3), p**x, p**-x, p ** (q**x)),
    *(held(Pow, p**x, y), 2**x, 2**-x, 3 ** (x + 1), Rational(2, 3) ** x, Integer(-2) ** n),
    *(held(Pow, 2, 64), held(Pow, -2, 2) * x, held(Pow, -2, 3) * x),
    *(p ** Rational(1, 3), p ** Rational(-1, 3), p ** Rational(5, 3)),
    (x + y) ** 2,
]
ROOTS = [
    *(sqrt(p), 1 / sqrt(p), p ** Rational(3, 2), p ** Rational(-3, 2)),
    *(p ** Rational(3, 2) / q ** Rational(5, 2), sqrt(2) * x, x / sqrt(2), sqrt(pi) * x),
    *(sqrt(p * q), sqrt(p / q), x * sqrt(p) / sqrt(q), sqrt(p) * sqrt(q), sqrt(p + q), -sqrt(p)),
    *(sqrt(x**2 + y**2), sqrt(1 - t**2)),
    *((x**2 + y**2) ** Rational(3, 2), 1 / sqrt(x**2 + y**2)),
]
FUNCTIONS = [
    *(Abs(x), Abs(x * y) - x, sign(y) * x, asinh(x), atan(x / y), atan2(y, x), atan2(-y, x - z)),
    *(sin(x) * cos(y), tan(x), log(p / q), log(Abs(x)), Max(x, y), Max(x, y, z), Max(0, x)),
    *(Min(x, y, 1), Min(1, x) * Max(y, -3), exp(x), asin(t), acos(t), atanh(t), acosh(p + 1)),
    *(sinh(x), cosh(x), tanh(x)),
]
CHOICES = [
    *(Piecewise((x, x > 0), (y, True)), Piecewise((x, x > 0), (y, y > 0), (z, True))),
    Piecewise((x, (x > 0) & (y > 0)), (y, (x < 0) | (z > 3)), (z, True)),
    Piecewise((x, x >= Rational(3, 4)), (y, x <= -1), (0, True)),
    Piecewise((-x - y, x > y), (x - y - z, True)),
    *(1 - 2 * Piecewise((x, x > y), (y, True)), Piecewise((1, x > 0), (0, True))),
]

VARYING = [(), (x,), (y, p), tuple(POINTS)]
"""Which symbols are arrays is told to the printer; it must not change what is computed."""

EXACT = [
    *(E, 1 / E, exp(2), exp(Rational(-7, 10)), sqrt(E), exp(E), exp(sqrt(2)), E - 1, 1 - E),
    *(E - Rational(271828, 100000), pi, pi**2, pi**-3, pi ** Rational(1, 3), pi - 3, 1 + pi),
    *(sqrt(2), 2 ** Rational(1, 3), 2**pi, 2 ** sqrt(2), 1 + sqrt(2), log(2), log(3) - 1),
    *(sin(1), cos(2), asin(Rational(1, 3)), cosh(1), tanh(Rational(1, 7)), asinh(3)),
    *(EulerGamma, GoldenRatio, Catalan, TribonacciConstant, zeta(3)),
]
"""Numbers that SymPy keeps as they are."""

NODES = [*SUMS, *PRODUCTS, *POWERS, *ROOTS, *FUNCTIONS, *CHOICES]
NODES += [
    *(E * x, x / E, x - E, -E * x, p**E, E**x, GoldenRatio * x, x / GoldenRatio, x / (1 - E)),
    *(exp(Rational(-7, 10)) * x + y, x * (E - 1) ** y, held(Pow, x**2, E), sqrt(pi * p)),
    *(p**pi, p ** (pi - 2), p ** (1 - pi), p ** (3 - pi), p ** (pi - 4), p**-pi, sin(1) * cos(2)),
    *(Max(0, x - E), Min(x, sqrt(2)), x - cos(2), Piecewise((x, x > log(2)), (pi * y, True))),
    *(sqrt(p / E), sqrt(1 + sqrt(2)) * x, 1 / sqrt(p + E), 2 * (E - 1) * x),
]

UNKNOWN: list[Basic] = [
    *(sec(x), floor(x), ceiling(x), Heaviside(x), Float(0.1), ITE(x > 0, y > 1, z > 2)),
    *(I, nan, zoo, zeta(p), Function("g")(x), Function("sinc_of_mine")(x), Integral(x**x, x)),
    *(Piecewise((x, x > 0)), Piecewise((x, x > 0), (y, y > 0))),
]


def computed(expr: Expr, varying: tuple[Symbol, ...], arrays: bool) -> list[float]:
    """The printed text, evaluated at all points: in one go, or point by point."""
    text = NumPyPrinter(varying).doprint(expr)
    names = {"np": np, "where": kernels.where} | vars(elementary)
    columns = {str(s): np.array(values) for s, values in POINTS.items()}
    if arrays:
        value = eval(text, names, columns)  # noqa: S307
        return [float(v) for v in np.broadcast_to(value, 3)]
    rows = ({name: v[i] for name, v in columns.items()} for i in range(3))
    return [float(eval(text, names, row)) for row in rows]  # noqa: S307


def meant(expr: Expr) -> list[mpmath.mpf]:
    """The expression at all points, in mpmath at 30 digits."""
    function = lambdify(list(POINTS), expr, modules="mpmath")
    with mpmath.workdps(30):
        return [mpmath.mpf(function(*map(mpmath.mpf, row))) for row in zip(*POINTS.values())]  # noqa: B905


def agrees(got: float, wanted: mpmath.mpf) -> bool:
    return bool(got == wanted or abs(got - wanted) <= TOLERANCE * abs(wanted))


@pytest.mark.parametrize("expr", NODES, ids=str)
def test_text_evaluates_to_the_expression(expr: Expr) -> None:
    wanted = meant(expr)
    for varying, arrays in product(VARYING, (False, True)):
        got = computed(expr, varying, arrays)
        assert all(map(agrees, got, wanted)), (NumPyPrinter(varying).doprint(expr), got, wanted)


@pytest.mark.skipif(not kernels.COMPILED, reason="numba does not compile here")
def test_numba_compiles_every_function_and_choice() -> None:
    """A body is tried as plain Python before it is written; its users' kernels are compiled."""
    nodes = [*FUNCTIONS, *CHOICES, *SUMS[:3], *POWERS[:9], *ROOTS[:4]]
    lines = [f"    out[{i}] = {NumPyPrinter().doprint(node)}" for i, node in enumerate(nodes)]
    names = {"np": np, "where": kernels.where}
    text = "\n".join([f"def evaluated({', '.join(map(str, POINTS))}, out):", *lines])
    exec(text, names)  # noqa: S102
    compiled, got = numba.njit(names["evaluated"]), np.empty((3, len(nodes)))
    for row, values in zip(got, zip(*POINTS.values(), strict=True), strict=True):
        compiled(*values, row)
    for node, column in zip(nodes, got.T, strict=True):
        assert all(map(agrees, column, meant(node))), (node, column)


@pytest.mark.parametrize("number", EXACT, ids=str)
def test_an_exact_number_is_rounded_once(number: Expr) -> None:
    """mpmath's 40 digits, rounded to float64: the last digit is right, whatever cancels."""
    with mpmath.workdps(40):
        wanted = float(lambdify([], number, modules="mpmath")())
    assert eval(NumPyPrinter().doprint(number), {"np": np}) == wanted  # noqa: S307


@pytest.mark.parametrize("number", [exp(1000), exp(-1000), -exp(1000), pi**1000], ids=str)
def test_a_number_beyond_float64_is_refused(number: Expr) -> None:
    with pytest.raises(CannotPrint, match="no finite, nonzero value in float64"):
        NumPyPrinter().doprint(number * x)


@pytest.mark.parametrize("expr", UNKNOWN, ids=lambda expr: f"{type(expr).__name__}: {expr}")
def test_what_is_unknown_is_refused(expr: Basic) -> None:
    with pytest.raises(CannotPrint):
        NumPyPrinter().doprint(expr)
