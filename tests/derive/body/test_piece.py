"""One piece of a profile."""

from sympy import S, oo, sqrt, symbols

from derive.body.piece import Piece, step
from derive.symbols import x


def test_the_step_of_the_slope_where_a_power_meets_a_line() -> None:
    """g = x**k/(k L**(k - 1)) rises by (b/L)**(k - 1) at b: 27 at b = 3 L and k = 4."""
    k, L, b, phi = symbols("k L b phi", positive=True)
    curve, line = Piece(S.Zero, b, x**k / (k * L ** (k - 1))), Piece(b, oo, phi * x)
    jump = step(curve, line, (k > 1,))
    assert jump.free_symbols == {k, L, b, phi}
    assert jump.subs({k: 4, L: 2, b: 6, phi: 30}) == 3
    assert jump.subs({k: S(3) / 2, L: 2, b: 4, phi: 3}) == 3 - sqrt(2)
