"""log(1 + q) of what is not negative, however small: in steps that NumPy takes many at once.

NumPy computes log1p many elements at once where there is AVX-512, and one by one elsewhere, two to
three times as slowly as its log.  Of long arrays a table is quicker there, three times; of some
hundred elements it is not.  With q_0 = q cut to a few binary digits,

    log(1 + q) = log(1 + q_0) + 2 artanh(s),    s = (q - q_0)/(2 + q + q_0),

log(1 + q_0) stands in the table, and s < 2**-(DIGITS + 1).  Numbers, short and long arrays get the
same bits, within 1.1 units in the last place: half of one in the table, half in the last sum.
"""

from functools import cache
from math import frexp, ldexp
from typing import Any

import numpy as np
from numpy.lib.introspect import opt_func_info

DIGITS = 10
"""Binary digits that are kept behind the leading one: the table has 2**DIGITS numbers an octave."""

BEYOND = 64
"""2**BEYOND and what is larger stands in no table: adding one is lost in rounding."""

NORMAL = 2.0**-1022
"""Below this NumPy may tell of underflow."""

_FIRST, _THIRD = 1.999999999999993, 0.6666667858759775
"""2 artanh(s) = s (_FIRST + _THIRD s**2), to 1e-18 where s < 2**-(DIGITS + 1)."""

_FAR, _NEAR = 2.0**BEYOND, 2.0**-54
"""Between these log(1 + q) is neither log(q) nor q to the last digit."""

_KEPT = 2.0 ** (DIGITS + 1)
"""Cut numbers are whole ones below this, times powers of two."""

_BIAS = 1021
"""Where the table has them: octave by octave, these so many after the smallest."""

# Between an array and these NumPy has nothing to convert, which short arrays would feel.
_CUT, _TWO, _ONCE, _CUBED = map(np.array, (np.uint64(52 - DIGITS), 2.0, _FIRST, _THIRD))


def _log1p_is_slow() -> bool:
    """Whether NumPy's log1p takes elements one by one, though it knows better ways elsewhere.

    So it is on Linux without AVX-512.
    """
    ways = opt_func_info(func_name="^log1p$", signature="float64").get("log1p", {}).get("dd", {})
    current = ways.get("current", "")
    return current.startswith("baseline") and ways.get("available", "") != current


BY_TABLE = _log1p_is_slow()
"""Whether log1p is computed by the table, of numbers and of NumPy's arrays."""


def log1p(value: Any, out: Any = None, free: Any = None) -> Any:
    """log(1 + value), in arrays and of a number.

    out, free: two arrays of the same shape, to be used up; the result lies in `out`.
    """
    if type(value) is not np.ndarray or not value.ndim:
        return np.float64(plain_log1p(value)) if isinstance(value, float) else np.log1p(value)
    return _by_table(value, out, free) if BY_TABLE else np.log1p(value, out=out)


def plain_log1p(value: float) -> float:
    """log(1 + value) of a number, as one of Python's."""
    if not BY_TABLE:
        return abs(value) if value < NORMAL else float(np.log1p(value))
    if not NORMAL <= value < _FAR:
        with np.errstate(all="ignore"):
            return float(_by_table(np.array([value]), None, None)[0]) if value else 0.0
    fraction, exponent = frexp(value)
    kept = int(fraction * _KEPT)
    cut = ldexp(kept, exponent - DIGITS - 1)
    s = (value - cut) / (cut + 2.0 + value)
    found: float = _table().item((exponent + _BIAS << DIGITS) + kept)
    return (s * s * _THIRD + _FIRST) * s + found


def _by_table(value: Any, out: Any, free: Any) -> Any:
    """log(1 + value); positive float64 are in the order of their bits, read as whole numbers."""
    whole = None if free is None else free.view(np.uint64)
    place = np.right_shift(value.view(np.uint64), _CUT, out=whole)
    odd, table = None, _table()
    try:
        found = table.take(place.view(np.int64))
    except IndexError:  # none stands there that is negative, no number, or too large
        odd = place >= table.size
        found = table.take(place.view(np.int64), mode="clip")
    cut = np.left_shift(place, _CUT, out=place).view(np.float64)
    s = np.subtract(value, cut, out=out)
    cut += _TWO
    cut += value
    s /= cut
    square = np.multiply(s, s, out=cut)
    square *= _CUBED
    square += _ONCE
    square *= s
    found = np.add(square, found, out=s)
    if odd is not None:
        found[odd] = np.log(value[odd] + (value[odd] == 0))  # one is lost beside 2**BEYOND
    return found


@cache
def _table() -> Any:
    """log(1 + q_0) of every q_0 from zero on, rounded once where long double has more digits."""
    places = np.arange((1023 + BEYOND) << DIGITS, dtype=np.uint64)
    table = np.left_shift(places, _CUT, out=places).view(np.float64)
    near = table.searchsorted(_NEAR)
    with np.errstate(all="ignore"):
        table[near:] = np.log1p(table[near:].astype(np.longdouble))
    return table
