"""True equations with kinks hold, false ones fail, and what takes too long ends.

Integrals by hand, for |w| < 1:

    int_-1^1 |s - w|        = ((1 + w)**2 + (1 - w)**2)/2 = 1 + w**2
    int_-1^1 sign(s - w)    = (1 - w) - (1 + w) = -2 w
    int_-1^1 log|s - w|     = (1 - w) log(1 - w) + (1 + w) log(1 + w) - 2
    int_-1^1 sqrt|s - w|    = (2/3) ((1 - w)**(3/2) + (1 + w)**(3/2))
    int_0^3 sign(sin 5 s)   = (pi - pi + pi - pi + (15 - 4 pi))/5 = 3 - 4 pi/5
"""

from pathlib import Path
from time import monotonic

import pytest

from derive.check.claim import Verdict
from derive.check.report import evidence
from derive.check.verdict import Finding, is_carried
from derive.command.errors import BadClaimsFile
from tests.check import asking

pytestmark = pytest.mark.slow

HEAD = """
[variables]
a = "a length"
b = "another"
w = { low = -0.9, high = 0.9 }
v = { low = -3, high = 3 }
y = { low = -3, high = 3 }
"""
GOOD = {Verdict.HOLDS, Verdict.NUMERICAL}


def judged(folder: Path, printed: str, head: str = HEAD) -> Finding:
    return asking.judged(folder, head + asking.claim(printed))


# ------------------------------------------------------------------ true and false


@pytest.mark.parametrize(
    "printed",
    [
        "integral(abs(s - w), s, -1, 1) = 1 + w**2",
        "integral(sign(s - w), s, -1, 1) = -2*w",
        "integral(log(abs(s - w)), s, -1, 1) = (1 - w)*log(1 - w) + (1 + w)*log(1 + w) - 2",
        "integral(sqrt(abs(s - w)), s, -1, 1) = 2*((1 - w)**(3/2) + (1 + w)**(3/2))/3",
        "integral(sign(sin(5*s)), s, 0, 3) = 3 - 4*pi/5",
        "integral(1/sqrt(abs(s)), s, -1, 4) = 6",
        "pi = integral(2*sqrt(1 - s**2), s, -1, 1)",
        "integral(elliptic_k(s), s, 0, 1) = 2",
        "abs(v - y - 6) = 6 - v + y",
        "abs((v - 1)**2 + 0.00001) = (v - 1)**2 + 0.00001",
        "acos(cos(w)) = abs(w)",
        "atan(a) + atan(1/a) = pi/2",
        "a**2 + b**2 >= 2*a*b",
    ],
)
def test_what_is_true_is_found_true(tmp_path: Path, printed: str) -> None:
    assert judged(tmp_path, printed).verdict in GOOD


@pytest.mark.usefixtures("unmended")
@pytest.mark.parametrize(
    "printed",
    [
        "abs(x - 1.999) = 1.999 - x",
        "atan(x) + atan(1/x) = pi/2",
        "integral(abs(s - w), s, -1, 1) = 1 + w**2 + 1/10**20",
        # the derivative of both sides is the same
        "atan((1 + x)/(1 - x)) = atan(x) + pi/4",  # for x < 1 only, else less pi
        "a = a + 1/10**31",
        "a = a*(1 + 1/10**50)",
        "tanh(40 + a) = 1",
        # true of moderate sizes alone
        "abs(a - 1000) = 1000 - a",
        "a < 100000",
        "a > 0.0001",
        "w < 0.8999",
        # spikes between the points
        "a = a + exp(-(10**6*(a - 1.7))**2)",
        "a = a + exp(-(10**6*(a - b))**2)",
        "a = a + 1/(1 + (10**20*(a - 17))**2)",
        "integral(1 + exp(-(1000*(s - 0.3))**2), s, 0, 1) = 1",
        # false in a corner alone
        "abs(v - y - 5.9) = 5.9 - v + y",  # for v - y > 5.9: one corner of four
        "abs(v + y + 5.99) = v + y + 5.99",
        "integral(abs(s - a), s, 0, 10) = 50 - 10*a + a**2",  # for a > 10
        "integral(abs(s - v), s, -2.9, 2.9) = 8.41 + v**2",  # for |v| > 2.9
        "abs((v - 1)**2 - 0.00001) = (v - 1)**2 - 0.00001",  # for |v - 1| < 0.0032
        "abs(sin(v) - 0.99999) = 0.99999 - sin(v)",
        "abs((v - 1)**2 + (y + 0.7)**2 - 0.00001) = (v - 1)**2 + (y + 0.7)**2 - 0.00001",
        # nested deep
        "a = " + "sin(" * 39 + "a" + ")" * 39,
    ],
)
def test_what_is_false_is_found_false(tmp_path: Path, printed: str) -> None:
    assert judged(tmp_path, printed).verdict == Verdict.FAILS


@pytest.mark.parametrize("under", ["1/s**2", "1/(s - 0.3)"])
def test_a_pole_inside_is_named_and_decides_nothing(tmp_path: Path, under: str) -> None:
    finding = judged(tmp_path, f"integral({under}, s, -1, 1) = 0")
    assert finding.verdict == Verdict.UNCHECKED
    assert "pole at s = " in evidence(finding)


@pytest.mark.enough("A = l-*")
@pytest.mark.usefixtures("unmended")
@pytest.mark.parametrize(
    ("true", "false"), [("A = l", "A = r"), ("C = r", "C = l"), ("T = alpha", "T = -alpha")]
)
def test_the_contact_from_the_loads_is_the_contact(tmp_path: Path, true: str, false: str) -> None:
    head = """
    body = "unequal_wedge"
    [variables]
    l = "left half-width"
    r = "right half-width"
    [symbols]
    A = "contact_a(load(l, r), moment(l, r))"
    C = "contact_c(load(l, r), moment(l, r))"
    T = "contact_alpha(load(l, r), moment(l, r))"
    alpha = "tilt(l, r)"
    """
    assert judged(tmp_path, true, head).verdict in GOOD
    assert judged(tmp_path, false, head).verdict == Verdict.FAILS


def test_how_far_was_looked_is_told(tmp_path: Path) -> None:
    told = evidence(judged(tmp_path, "a*b < a*b + a"))
    assert "points (a from " in told
    low, high = (float(n) for n in told.partition("a from ")[2].split(";")[0].split(" to "))
    assert low < 1e-3
    assert high > 1e2


def test_a_spike_that_a_quadrature_passes_by_decides_nothing(tmp_path: Path) -> None:
    finding = judged(tmp_path, "integral(1 + exp(-(10**5*(s - 0.3777))**2), s, 0, 1) = 1")
    assert finding.verdict in (Verdict.UNCHECKED, Verdict.FAILS)


@pytest.mark.parametrize(
    ("printed", "verdict"),
    [
        ("tanh(a) < 1", Verdict.NUMERICAL),  # nearer than any digits where a is large
        ("abs(x) > x", Verdict.FAILS),
        ("sin(x) < 1", Verdict.UNCHECKED),  # equal at pi/2 alone
        ("a/b + b/a > 2", Verdict.UNCHECKED),
        ("a + 1/a > 2.000000001", Verdict.FAILS),
    ],
)
def test_strict_inequalities_where_the_sides_touch(
    tmp_path: Path, printed: str, verdict: Verdict
) -> None:
    assert judged(tmp_path, printed).verdict == verdict


@pytest.mark.parametrize(
    "printed",
    [
        "integral(log(abs(x + 1.99)), s, 0, 1) = log(x + 1.99)",
        "log(abs(x + 1.99)) = log(x + 1.99)",
        "log(x**2) = 2*log(x)",
    ],
)
def test_a_side_that_is_not_real_is_no_counter_example(tmp_path: Path, printed: str) -> None:
    finding = judged(tmp_path, printed)
    assert finding.verdict in GOOD
    assert "one side is not real at " in evidence(finding)


def test_branches_where_neither_side_is_real_do_not_count(tmp_path: Path) -> None:
    """log of a negative quotient is +pi i or -pi i away; where it is real both sides agree."""
    finding = judged(tmp_path, "log((1 - a)/(1 - b)) = log(1 - a) - log(1 - b)")
    assert finding.verdict == Verdict.NUMERICAL
    assert "one side is not real at " in evidence(finding)
    assert len(finding.judged.pairs) >= 20
    assert judged(tmp_path, "a*sqrt(1 - b) = 2*a*sqrt(1 - b)").verdict == Verdict.FAILS
    assert judged(tmp_path, "a*sqrt(1 - b) = a*sqrt(1 - b)").verdict == Verdict.HOLDS
    hidden = judged(tmp_path, "sqrt(w - 2) = 2*sqrt(w - 2)")
    assert hidden.verdict == Verdict.UNCHECKED
    assert "one side is not real at " in evidence(hidden)


def test_a_range_is_kept_where_its_variable_cancels(tmp_path: Path) -> None:
    """sqrt(1 - k) is real for k < 1 alone, and drops out of A - B."""
    head = """
    [variables]
    a = "a length"
    k = { low = 0.1, high = 0.9 }
    [symbols]
    A = "a + sqrt(1 - k)"
    B = "sqrt(1 - k) - a"
    """
    finding = judged(tmp_path, "A - B = 2*a", head)
    assert finding.verdict == Verdict.HOLDS
    (k,) = (s for s in finding.judged.pairs[0].point if s.name == "k")
    assert all(0.1 <= pair.point[k] <= 0.9 for pair in finding.judged.pairs)


# ------------------------------------------------------------------ corrections


@pytest.mark.parametrize(
    "printed",
    [
        "sign(a - 1/100000) = 1",  # 1 = 1
        "abs(x) = x",
        "a > a",  # a = a
        "x = sqrt(abs(x))**2",  # x = x, |x| = |x|
    ],
)
def test_what_says_nothing_is_no_correction(tmp_path: Path, printed: str) -> None:
    finding = judged(tmp_path, printed)
    assert (finding.verdict, finding.repair) == (Verdict.FAILS, None)


def test_what_is_true_to_working_digits_is_no_correction(tmp_path: Path) -> None:
    """1 + tanh(10**6*(w - 1.6)) is below exp(-10**6) where w < 0.9, which is not zero."""
    finding = judged(tmp_path, "w + (1 + tanh(10**6*(w - 1.6)))/2 = w", "seconds = 1\n" + HEAD)
    assert finding.verdict == Verdict.NUMERICAL
    claim = finding.claim
    assert not is_carried(claim, claim.meant.left, claim.meant.right, finding.judged)


# ------------------------------------------------------------------ limits and errors


def test_a_verdict_that_takes_too_long_is_none(tmp_path: Path) -> None:
    one = "integral(log(abs(sin(40*s) - w)), s, 0, a)"
    slow = f"{one} = {one.replace('abs(', '2*abs(')} - a*log(2)"
    began = monotonic()
    finding = judged(tmp_path, slow, "seconds = 1\n" + HEAD)
    assert finding.verdict == Verdict.UNCHECKED
    assert "not finished within 1 s" in evidence(finding)
    assert monotonic() - began < 6


def test_a_search_that_takes_too_long_leaves_the_verdict(tmp_path: Path) -> None:
    began = monotonic()
    printed = "integral(sign(sin(5*s)), s, 0, 3) = 18*pi/5 - 3 - 12*pi/5 - pi"
    finding = judged(tmp_path, printed, "seconds = 1\n" + HEAD)
    assert finding.verdict == Verdict.FAILS
    assert "the search for a correction: not finished within 1 s" in evidence(finding)
    assert monotonic() - began < 10


@pytest.mark.parametrize("given", ["0", "-1", '"long"', "true", "1e9", "nan"])
def test_what_is_no_limit_is_refused(tmp_path: Path, given: str) -> None:
    with pytest.raises(BadClaimsFile, match="is not a valid time limit"):
        judged(tmp_path, "a = a", f"seconds = {given}\n" + HEAD)


@pytest.mark.parametrize(
    "printed", ["exp(exp(exp(exp(a*9)))) = 1", "a = integral(exp(exp(exp(s))), s, 0, 10)"]
)
def test_numbers_beyond_all_bounds_decide_nothing(tmp_path: Path, printed: str) -> None:
    assert judged(tmp_path, printed).verdict == Verdict.UNCHECKED
