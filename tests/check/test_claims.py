"""What a claim may say beside its equation: where it is true or tends, what it follows from."""

from pathlib import Path
from typing import Any

import pytest
from sympy import Symbol, symbols

from derive.check.claim import Claim, Verdict
from derive.check.judge import Judged
from derive.check.report import explanation
from derive.check.schema import Entry
from derive.check.verdict import Finding
from derive.command.files import MARK
from derive.reading.formula import Names, equation
from derive.reading.units import Units, parse_unit
from tests.check import asking

HEAD = """
body = "hertz"
[variables]
a = { meaning = "half-width", unit = "m" }
b = { low = 0.1, high = 5 }
w = { low = 0.1, high = 5 }
nu = { low = -0.9, high = 0.5 }
R = { low = 2, high = 3 }
[symbols]
P = "load(a, a)"
p = "pressure(x, a, a)"
p_0 = "2*P/(pi*a)"
K = "K_N_left(a, a)"
E = ""
G = ""
t = ""
"""


def told(folder: Path, printed: str, more: str = "", before: str = "") -> dict[str, Any]:
    """The last claim of a file."""
    return asking.told(folder, HEAD + before + asking.claim(printed, more))[-1]


# By hand: p = p_0 sqrt(1 - x**2/a**2) is p_0 sqrt(2 t/a) (1 - t/(4 a) ...) at t from an edge.
# The sum of 1/k**2 is pi**2/6; the principal value of 1/(s - x) over [-3, 3] is
# log((3 - x)/(3 + x)), and that of p(s)/(x - s) over the contact pi E* x/(2 R).
@pytest.mark.slow
@pytest.mark.usefixtures("unmended")
@pytest.mark.parametrize(
    ("printed", "more", "verdict"),
    [
        # what tends where
        ("p ~ K*sqrt(a + x)", "as = 'a + x -> 0'", "numerical"),
        ("p ~ p_0*sqrt(2*(a - x)/a)", "as = 'x -> a'", "numerical"),
        ("p ~ 2*K*sqrt(a + x)", "as = 'a + x -> 0'", "fails"),
        ("p = K*sqrt(a + x)", "as = 'x -> -a'\norder = 1.5", "numerical"),
        ("p = K*sqrt(a + x)", "as = 'x -> -a'\norder = 2.5", "fails"),
        ("sqrt(x**2 + a**2) ~ x", "as = 'x -> oo'", "numerical"),
        ("sin(b) ~ b", "as = 'b -> 0'", "numerical"),
        ("log(1/b) ~ 1/b", "as = 'b -> 0'", "fails"),
        # where and of what it is said
        ("sqrt((w - b)**2) = w - b", "require = 'b < w'", "numerical"),
        ("sqrt((w - b)**2) = w - b", "", "fails"),
        ("sqrt((w - b)**2) = b - w", "require = ['b > w']", "numerical"),
        ("abs(x) = x", "require = 'P > 0 and x > 0'", "numerical"),
        ("p = p_0*sqrt(1 - x**2/a**2)", "", "holds"),  # at |x| < a, where the pressure is
        ("stick_m(P, 0, b, 0) = sqrt(4*R*(P - b/(2*f))/(pi*E_star))", "", "holds"),
        ("load(a, c) = P", "symbols = { c = 'a' }", "by definition"),
        ("P = load(a, a)", "", "by definition"),
        ("load(a, w) = E_star*phi*sqrt(a*w)", "body = 'wedge'", "holds"),
        (
            "load(a, a) = pi*E_star*a**2/(2*R)",
            "body = { g = 'x**2/R', units = { R = 'm' } }",
            "holds",
        ),
        (
            "sinh(w)**2 + 1 = cosh(w)**2",
            "body = 'none'\nsymbols = { P = '1', p = '1', K = '1' }",
            "holds",
        ),
        # what papers say
        ("diff(P, a) = pi*E_star*a/(2*R)", "", "holds"),
        ("limit(abs(x)/x, x, 0) = 1", "", "unchecked"),  # -1 from the left
        ("sum(1/k**2, k, 1, oo) = pi**2/6", "", "holds"),
        ("Piecewise((x, x > 0), (-x, True)) = abs(x)", "", "numerical"),
        ("integral(exp(t), t, -oo, 1) = exp(1)", "", "numerical"),
        ("integral(t/(1 + t**2), t, -oo, oo) = 0", "", "unchecked"),
        ("limit(atan(x), x, -oo) = -pi/2", "", "holds"),
        ("pv(1/(s - x), s, -3, 3) = log((3 - x)/(3 + x))", "", "numerical"),
        ("pv(1/(s - x), s, -3, 3) = log((3 + x)/(3 - x))", "", "fails"),
        ("pv(pressure(s, a, a)/(x - s), s, -a, a) = pi*E_star*x/(2*R)", "", "numerical"),
        ("pv(s, s, -a, a) = 0", "", "unchecked"),
        ("p_0 = 0.564*sqrt(P*E_star/R)", "", "numerical"),  # 1/sqrt(pi) = 0.56419
        ("p_0 = 0.565*sqrt(P*E_star/R)", "", "fails"),
    ],
)
def test_what_is_said_beside_an_equation(
    tmp_path: Path, printed: str, more: str, verdict: str
) -> None:
    found = told(tmp_path, printed, more)
    assert found["verdict"] == verdict, found["reason"]


GEOMETRY = """
from derive import Geometry, parameter, x
open("executed", "w").close()
half = parameter("half", "half the radius", unit="m")
geometry = Geometry("own", g=x**2 / (4 * half))
"""


def test_a_geometry_file_is_a_body_and_is_not_executed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """g = x**2/(4 half) is a cylinder of radius 2 half: P = pi E* a**2/(4 R)."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "own.py").write_text(GEOMETRY)
    head = 'body = "own.py"\n[variables]\na = "half-width"\n'
    (it,) = asking.told(tmp_path, head + asking.claim("load(a, a) = pi*E_star*a**2/(8*half)"))
    assert it["verdict"] == "holds"
    assert not (tmp_path / "executed").exists()


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("geometry = 3", "does not have exactly one `geometry = Geometry"),
        ("(", "is not valid Python"),
        (
            GEOMETRY.replace('"half"', '"b"'),
            "it does not define half = parameter('half', ..., unit=...)",
        ),
        (GEOMETRY.replace('"m"', "{[]: 1}"), "it does not define half = parameter('half',"),
        (GEOMETRY.replace('"half",', "{[]: 1},"), "it does not define half = parameter('half',"),
        (GEOMETRY.replace("x**2", "__import__('os').getcwd()"), "__import__"),
    ],
)
def test_a_geometry_file_that_is_none(tmp_path: Path, text: str, why: str) -> None:
    (tmp_path / "own.py").write_text(text)
    done = asking.run(asking.written(tmp_path, 'body = "own.py"\n' + asking.claim("f = f")))
    assert done.exit_code == 2
    assert why in done.output


@pytest.mark.parametrize("given", ["../own.py", "./own.py", "inner/own.py"])
def test_a_geometry_file_lies_in_the_same_folder(tmp_path: Path, given: str) -> None:
    done = asking.run(asking.written(tmp_path, f"body = '{given}'\n" + asking.claim("f = f")))
    assert done.exit_code == 2
    assert "nor a geometry file in the same folder" in done.output


MODULI = """
[[claims]]
label = "(8)"
printed = "E = 2*G*(1 + nu)"
[[claims]]
label = "(9)"
printed = "G = w/(1 + nu)"
[[claims]]
label = "(10)"
printed = "G < w"
[[claims]]
label = "(11)"
printed = "p_0 = E_star*a/R"
symbols = { p_0 = "E_star*a/R" }
[[claims]]
label = "(12)"
printed = "p_0 = 4*P/(pi*a)"
[[claims]]
label = "(13)"
printed = "P = p_0*pi*a/4"
given = ["(12)"]
"""


@pytest.mark.usefixtures("unmended")
@pytest.mark.parametrize(
    ("printed", "given", "verdict"),
    [
        ("G = E/(2*(1 + nu))", '["(8)"]', "holds: rests on given (8) (unchecked)"),
        ("P = p_0*pi*a/4", '["(12)"]', "holds: rests on given (12) (fails)"),
        (
            "p_0 = 4*P/(pi*a)",
            '["(13)"]',
            "holds: given (13) (holds, rests on given (12) (fails))",
        ),
        ("E = G", '["(10)"]', "unchecked: of the form symbol = ..."),
        ("p_0*R = E_star*a", '["(11)"]', "unchecked: no symbols, body or cases of its own"),
        ("G = E/(1 + nu)", '["(8)"]', "fails"),
        ("E = 2*w", '["(8)", "(9)"]', "holds"),
        ("E = 2*w", '["(9)"]', "fails"),
        ("E = 4*G*(1 + nu)*integral(t, t, 0, 1)", '["(8)"]', "numerical"),
        ("E = G", '["it"]', "unchecked"),
        ("E = G", '["(14)"]', "unchecked"),
        ("E = G", '"(8)"', "unchecked"),
    ],
)
def test_what_follows(tmp_path: Path, printed: str, given: str, verdict: str) -> None:
    found = told(tmp_path, printed, f"given = {given}", MODULI)
    wanted, _, words = verdict.partition(": ")
    assert found["verdict"] == wanted, found["reason"]
    assert "given" in found["reason" if wanted == "unchecked" else "evidence"]
    assert words in f"{found['reason']} {found['evidence']}"


# By hand: a = (2/sqrt(pi)) sqrt(P R/E*), P = pi E* a**2/(4 R), and 29*4 is 116.
@pytest.mark.parametrize(
    ("printed", "key", "part"),
    [
        ("a = sqrt(P*R/(29*E_star))", "diagnosis", "the ratio left/right is 2*sqrt(29/pi) at"),
        ("P = E_star*a/R", "diagnosis", "the ratio left/right is pi*a/4 at"),
        ("p_0 = P*E_star/(pi*R)", "corrected", "p_0 = sqrt(E_star*P/(pi*R))"),
    ],
)
def test_by_what_both_sides_differ(tmp_path: Path, printed: str, key: str, part: str) -> None:
    found = told(tmp_path, printed)
    assert found["verdict"] == "fails"
    assert part in (found[key] or "")


def test_units_of_symbols_that_nobody_knows() -> None:
    """t is in metres by the first equation, so that the second one does not fit."""
    a, t, p = symbols("a t p")
    names = Names("here", {"a": a, "t": t, "p": p, "s": Symbol("s")}, {})
    units = Units({a: parse_unit("m"), p: parse_unit("Pa")}, {}, {})
    fits = ("t = 2*a", "p = integral(p/t, s, 0, a)", "t/a = sin(t/a)")
    for text in fits:
        left, _, right = equation(text, names)
        assert units.mismatch(left, right) == ""
    for text in ("p = p*t", "a = 1 + t", "exp(a) = 2", "p = integral(p, s, 0, a)"):
        left, _, right = equation(text, names)
        assert units.mismatch(left, right)


def test_the_page_shows_formulas_but_runs_nothing(tmp_path: Path) -> None:
    claims = (
        '[[claims]]\nlabel = "<script>"\n'
        "latex = 'p_0 = \\frac{P}{\\pi a} \\href{javascript:x}{a} \\text{<script>}'\n"
        'printed = "x"\nunchecked = "not yet"\n'
        '[[claims]]\nlabel = "wrong"\nprinted = "P = E_star*a**2/(5*R)"\n'
    )
    page = asking.run(asking.written(tmp_path, HEAD + claims), "--format", "html").stdout
    assert "<script" not in page and 'href="j' not in page
    assert page.count("<mtext>&lt;script&gt;</mtext>") == 1
    assert MARK in page  # another run may replace it
    assert "<dt>printed</dt><dd><math" in page
    assert "5*pi/4" in page


# The worse of two claims of one equation counts.  (1) is from the body, (2) by definition,
# (3) from (2), (4) false, (5) and (6) without a meaning, one claim of (7) is not accepted yet, and
# (8), a table, and the condition of (9) were not read.
COVERED = """
[[claims]]
label = "(1)"
printed = "P = pi*E_star*a**2/(4*R)"
[[claims]]
label = "(2)"
printed = "p_0 = 2*P/(pi*a)"
[[claims]]
label = "(3)"
given = ["(2)"]
printed = "P = pi*a*p_0/2"
[[claims]]
label = "(4)"
printed = "G = p_0"
symbols = { G = "2*p_0" }
[[claims]]
label = "(5)"
printed = "t = b"
[[claims]]
label = "(6)"
printed = "E = 2*G"
[[claims]]
label = "(7a)"
equation = "(7)"
latex = 'P = \\frac{\\pi}{4} \\frac{E^* a^2}{R}'
accepted = false
[[claims]]
label = "(7b)"
equation = "(7)"
printed = "P = load(a, a)"
[[claims]]
label = "(8)"
place = "table 1, paper.tex:90"
latex = 'a_1 & <b>0.3</b>'
unchecked = "a table is not read"
[[claims]]
label = "(9)"
latex = 'P = p_0, \\quad b \\ll a'
understood = "P = p_0"
accepted = false
unchecked = "its condition was not read"
[latex]
"E^*" = "E_star"
"""


@pytest.mark.usefixtures("unmended")
def test_every_form_counts_the_same_equations(tmp_path: Path) -> None:
    path = asking.written(tmp_path, HEAD + COVERED)
    before = (HEAD + COVERED).partition('label = "(7a)"')[0]
    line_of_7 = before.count("\n")  # the line of its head, [[claims]]
    line = (
        "9 equations: 1 held from the body, 1 held from your definitions, 1 held from given claims,"
        " 1 failed, 2 not read, 2 unchecked, 1 to be accepted"
    )
    for form in ("table", "markdown", "latex", "html"):
        document = asking.run(path, "--format", form).stdout
        assert line in document
        assert "a table is not read" in document
        assert form == "table" or "table 1, paper.tex:90" in document
        assert "<b>0.3" not in document or form in ("latex", "markdown")
        at = [document.index(part) for part in ("(4)", "(8)", "(6)", "(1)", "(3)")]
        assert at == sorted(at)
        for part in ("E has no meaning yet", f"claims.toml:{line_of_7}: accepted = true"):
            assert form == "table" or part in document
    told = {each["label"]: each for each in asking.told(tmp_path, HEAD + COVERED)}
    assert list(told) == ["(1)", "(2)", "(3)", "(4)", "(5)", "(6)", "(7a)", "(7b)", "(8)", "(9)"]
    assert told["(8)"]["coverage"] == "not read"
    assert told["(7a)"]["coverage"] == "to be accepted"
    known = {"P": "load(a, a)", "p_0": "2*P/(pi*a)"}
    assert told["(2)"]["symbols"] == known
    assert told["(4)"]["symbols"] == {"G": "2*p_0", **known}


# P is a load, but k is a length; both sides are the same by definition.
WORDS = """
[[claims]]
label = "it"
printed = "k = P/2"
"""


@pytest.mark.parametrize("form", ["table", "markdown", "latex", "html", "explain"])
def test_words_of_the_user_are_kept_and_units_that_do_not_fit_are_told(
    tmp_path: Path, form: str
) -> None:
    own = 'k = { is = "P/2", unit = "m", meaning = "half of the load" }\n'
    path = asking.written(tmp_path, HEAD + own + WORDS)
    asked = ("--explain", "it") if form == "explain" else ("--format", form)
    document = asking.run(path, *asked).stdout
    assert "by definition (units do not fit)" in document
    assert form == "table" or ("half of the load" in document and "half-width" in document)
    (it,) = asking.told(tmp_path, HEAD + own + WORDS)
    assert it["meanings"] == {"a": "half-width", "k": "half of the load"}
    assert it["verdict"] == "by definition" and it["units"]


@pytest.mark.parametrize(
    ("form", "printed"),
    [
        ("markdown", r"&lt;script&gt; \| \_a\_ \\input"),
        ("latex", r"<script> | \_a\_ \textbackslash input"),
        ("html", "&lt;script&gt; | _a_ \\input"),
    ],
)
def test_text_of_a_claim_is_only_text_in_a_document(
    tmp_path: Path, form: str, printed: str
) -> None:
    told = "says = '<script> | _a_ \\input'"
    text = HEAD + asking.claim(
        "P = 2*load(a, a)", f"{told}\nconsequence = '<script> | _a_ \\input'"
    )
    document = asking.run(asking.written(tmp_path, text), "--format", form).stdout
    assert document.count(printed) == 3
    assert form == "latex" or "<script" not in document


@pytest.mark.parametrize(
    ("label", "number", "name"),
    [("eqn:Knc/1", "", "eq. (8), here"), ("m/n", "(8)", "eq. (8), here"), ("area", "", "area")],
)
def test_readers_see_the_number_of_an_equation_and_no_latex(
    label: str, number: str, name: str
) -> None:
    claim = Claim(Entry(label, "eq. (8), here", "so", number))
    assert claim.name == name
    explained = str(explanation(Finding(claim, Judged(Verdict.HOLDS, ""))))
    assert claim.name == label or label not in explained
    assert claim.is_called(label) and claim.is_called(name) and not claim.is_called("(9)")
    assert claim.is_called("(8)") and claim.is_called("eq. (8)") and claim.is_called("8")
