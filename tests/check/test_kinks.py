"""True equations with kinks hold, false ones fail, and what takes too long ends.

Integrals by hand, for |w| < 1:

    int_-1^1 |s - w|        = ((1 + w)**2 + (1 - w)**2)/2 = 1 + w**2
    int_-1^1 sign(s - w)    = (1 - w) - (1 + w) = -2 w
    int_-1^1 log|s - w|     = (1 - w) log(1 - w) + (1 + w) log(1 + w) - 2
    int_-1^1 sqrt|s - w|    = (2/3) ((1 - w)**(3/2) + (1 + w)**(3/2))
    int_0^3 sign(sin 5 s)   = (pi - pi + pi - pi + (15 - 4 pi))/5 = 3 - 4 pi/5
"""

from collections.abc import Callable
from pathlib import Path
from time import monotonic

import pytest

from derive.check.claim import Verdict
from derive.check.report import evidence
from derive.check.verdict import Finding
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
BAD = {Verdict.FAILS}
OPEN = {Verdict.UNCHECKED}


def judged(folder: Path, printed: str, head: str = HEAD) -> Finding:
    return asking.judged(folder, head + asking.claim(printed))


# ------------------------------------------------------------------ true and false

TRUE = (
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
    "tanh(a) < 1",  # nearer than any digits where a is large
)
FALSE = (
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
    "abs(x) > x",
    "a + 1/a > 2.000000001",
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
)
UNDECIDED = (
    "sin(x) < 1",  # equal at pi/2 alone
    "a/b + b/a > 2",
    "exp(exp(exp(exp(a*9)))) = 1",  # beyond all bounds
    "a = integral(exp(exp(exp(s))), s, 0, 10)",
)
TABLE = [(printed, GOOD, "") for printed in TRUE]
TABLE += [(printed, BAD, "") for printed in FALSE]
TABLE += [(printed, OPEN, "") for printed in UNDECIDED]
TABLE += [
    (f"integral({under}, s, -1, 1) = 0", OPEN, r"write pv, or \fint in LaTeX")
    for under in ("1/s**2", "1/(s - 0.3)")
]
TABLE += [  # a side that is not real is no counter-example
    (printed, GOOD, "one side is not real at ")
    for printed in (
        "integral(log(abs(x + 1.99)), s, 0, 1) = log(x + 1.99)",
        "log(abs(x + 1.99)) = log(x + 1.99)",
        "log(x**2) = 2*log(x)",
        # +pi i or -pi i away where a quotient is negative
        "log((1 - a)/(1 - b)) = log(1 - a) - log(1 - b)",
    )
]
TABLE += [
    ("a*sqrt(1 - b) = 2*a*sqrt(1 - b)", BAD, ""),
    ("a*sqrt(1 - b) = a*sqrt(1 - b)", {Verdict.HOLDS}, ""),
    ("sqrt(w - 2) = 2*sqrt(w - 2)", OPEN, "one side is not real at "),
    # a spike that a quadrature passes by
    ("integral(1 + exp(-(10**5*(s - 0.3777))**2), s, 0, 1) = 1", BAD | OPEN, ""),
]


@pytest.mark.usefixtures("unmended")
@pytest.mark.parametrize(("printed", "verdicts", "words"), TABLE)
def test_verdicts(tmp_path: Path, printed: str, verdicts: set[Verdict], words: str) -> None:
    finding = judged(tmp_path, printed)
    assert finding.verdict in verdicts
    assert words in evidence(finding)


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
    told = evidence(judged(tmp_path, "a*b + a = a*(b + 1)"))
    assert "points (a from " in told
    low, high = (float(n) for n in told.partition("a from ")[2].split(";")[0].split(" to "))
    assert low < 1e-3
    assert high > 1e2


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
    assert finding.verdict == Verdict.DEFINITION
    (k,) = (s for s in finding.judged.pairs[0].point if s.name == "k")
    assert all(0.1 <= pair.point[k] <= 0.9 for pair in finding.judged.pairs)


# ------------------------------------------------------------------ corrections and limits


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


def test_what_is_true_to_working_digits_is_not_taken_for_true(tmp_path: Path) -> None:
    """1 + tanh(10**6*(w - 1.6)) is below exp(-10**6) where w < 0.9, which is not zero."""
    finding = judged(tmp_path, "w + (1 + tanh(10**6*(w - 1.6)))/2 = w", "seconds = 1\n" + HEAD)
    assert finding.verdict == Verdict.UNCHECKED
    assert "has its limit at all examined points" in finding.judged.why


ONE = "integral(log(abs(sin(40*s) - w)), s, 0, a)"


def test_what_takes_too_long_ends(tmp_path: Path) -> None:
    began = monotonic()
    printed = f"{ONE} = {ONE.replace('abs(', '2*abs(')} - a*log(2)"
    finding = judged(tmp_path, printed, "seconds = 1\n" + HEAD)
    assert finding.verdict == Verdict.UNCHECKED
    assert "not finished within 1 s" in evidence(finding)
    assert monotonic() - began < 10


def test_a_search_that_takes_too_long_leaves_the_verdict(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def endless(claim: object, look: Callable[[], None]) -> None:
        while True:
            look()

    monkeypatch.setattr("derive.check.verdict.repaired", endless)
    finding = judged(tmp_path, "a = 2*a", "seconds = 1\n" + HEAD)
    assert finding.verdict == Verdict.FAILS
    assert "the search for a correction: not finished within 1 s" in evidence(finding)


@pytest.mark.parametrize("given", ["0", "-1", '"long"', "true", "1e9", "nan"])
def test_what_is_no_limit_is_refused(tmp_path: Path, given: str) -> None:
    with pytest.raises(
        BadClaimsFile, match=r"seconds = .* is not allowed; seconds must be a number"
    ):
        judged(tmp_path, "a = a", f"seconds = {given}\n" + HEAD)
