"""Statements of a display: how they are divided, what is read, and that nothing is dropped."""

import tomllib
from pathlib import Path

import pytest

from derive.check.draft import Draft, draft
from derive.check.lines import heads, with_lines
from derive.check.userfile import read_claims
from derive.check.verdict import check
from derive.command.errors import BadFormula
from derive.reading.displays import displays
from derive.reading.formula import Names, equation, unknown
from derive.reading.latex import Latex
from derive.reading.spellings import proposal, spellings
from derive.reading.statements import statements
from derive.reading.words import COMMANDS, FUNCTIONS


def drafted(folder: Path, body: str) -> Draft:
    path = folder / "paper.tex"
    path.write_text(rf"\begin{{document}}{body}\end{{document}}", encoding="utf-8")
    return draft(path)


def claims(folder: Path, body: str) -> list[dict[str, object]]:
    found: list[dict[str, object]] = tomllib.loads(drafted(folder, body).text())["claims"]
    return found


def understood(latex: str) -> str:
    found = []
    for one in statements("here", latex):
        assert not one.why, one.why
        found.append(Latex("here", one.latex, spellings(one.latex)).understood())
    return "; ".join(found)


@pytest.mark.parametrize(
    ("latex", "texts"),
    [
        # a line break in the source is not printed, and a row may end with a full stop
        (
            "g =\n\\begin{cases} 0, & x < b, \\\\ x - b, & x > b . \\end{cases}",
            "g = Piecewise((0, x < b), (x - b, x > b))",
        ),
        (r"c = \sin^{-1}\left(\frac{a}{b}\right)", "c = asin(a/b)"),
        (r"K_{N}^{\text{LHS}} = E^{*} a'(c)", "K_N_LHS = E_star*a_prime_at_c"),
        (
            r"P = \int_0^a\!\int_0^b p(x)\, dx\, ds",
            "P = integral(integral(p_at_x, x, 0, b), s, 0, a)",
        ),
        (r"u = -\!\!\!\int_0^1 \frac{ds}{s - x}", "u = pv(1/(s - x), s, 0, 1)"),
        (r"u = \mathrm{PV}\int_0^1 \frac{f\,{\rm d}s}{s - x}", "u = pv(f/(s - x), s, 0, 1)"),
        (r"\frac{dP}{da} = \frac{\partial p}{\partial x}", "dP_da = dp_dx"),
        (r"dP/da = \frac{d^2 u}{d x^2}", "dP_da = d2u_dx2"),
        (r"c = \lim_{x \to \infty} \frac{a}{x}", "c = limit(a/x, x, oo)"),
        (r"c = \bar{u} + \hat p_0", "c = u_bar + p_hat_0"),
        (r"c = \Gamma\left(\frac{3}{2}\right)", "c = gamma_function(3/2)"),
        (
            r"c = \begin{cases} a & \text{for } x<0 \\ b, & \text{otherwise} \end{cases}",
            "c = Piecewise((a, x < 0), (b, True))",
        ),
        (r"x_\pm = e \pm c", "x_plus = e + c; x_minus = e - c"),
        (r"K_{N,+} = x_{-}", "K_N_plus = x_minus"),
        (r"x_{1,2} = e \pm c", "x_1 = e + c; x_2 = e - c"),
        (r"h = \operatorname{arcosh}\left(\frac{x}{a}\right)", "h = acosh(x/a)"),
        (r"a = \left{ b + c \right}", "a = (b + c)"),
        (r"\boxed{a \stackrel{\mathrm{def}}{=} b}", "a = b"),
        (r"\left\{\begin{aligned} a &= b \\ c &= d \end{aligned}\right.", "a = b; c = d"),
        (r"p_m := \frac{P}{2a}", "p_m = P/(2*a)"),
        (r"E^\star = E^{\ast}_1", "E_star = E_star_1"),
        (r"\begin{array}{rcl} a &=& b c \\ d &=& 2 a \end{array}", "a = b*c; d = 2*a"),
        (r"y = 1{,}5 a + 0{,}125", "y = 1.5*a + 0.125"),
        (r"q = p(x;a) - p(x;c)", "q = p_at_x_a - p_at_x_c"),
        (r"a &= b & c &= d \\ e &= f", "a = b; c = d; e = f"),
        (r"a \quad = \quad b", "a = b"),
        (r"y = \mathrm{e}^{-x/a} + {\rm e}^{2}", "y = exp(-x/a) + exp(2)"),
        (r"y = e^2 + e^{3}", "y = e**2 + e**3"),
        (r"y = \log_{10} x", "y = log(x)/log(10)"),
        # a circular function ends where the next function begins
        (
            r"y = \sin\varphi\,\ln\left|\tan\frac{a}{2}\tan\frac{b}{2}\right|",
            "y = sin(varphi)*log(abs(tan(a/2)*tan(b/2)))",
        ),
        (r"y = b \sin 2\varphi_0 - \cos 2\pi x", "y = b*sin(2*varphi_0) - cos(2*pi*x)"),
        (r"y = \lambda_1 \int_0^1 \lambda\,d\lambda", "y = lam_1*integral(lam, lam, 0, 1)"),
        (r"P = 2\mathrm{K}(k) \int_0^a p\,\mathrm dx", "P = 2*K_at_k*integral(p, x, 0, a)"),
    ],
)
def test_what_is_read(latex: str, texts: str) -> None:
    assert understood(latex) == texts


@pytest.mark.parametrize("command", COMMANDS)
def test_a_function_is_read_from_its_command(command: str) -> None:
    """And from its upright name, unless that begins with a capital letter."""
    name = COMMANDS[command]
    arguments = "(a, b)" if FUNCTIONS[name].most > 1 else "(a)"
    assert understood(rf"y = {command}{arguments}") == f"y = {name}{arguments}"
    if command.islower():
        assert understood(rf"y = \mathrm{{{command[1:]}}}{arguments}") == f"y = {name}{arguments}"


@pytest.mark.parametrize(
    ("latex", "why"),
    [
        (r"p_0 = 2\times10^{3}\quad\mathrm{MPa}", "the words 'MPa' are not understood"),
        (
            r"a = \sqrt{4\times10^5} = 0.105\ \mathrm{mm}",
            "numbers with the words 'mm' are an example",
        ),
        (r"\operatorname{div} u = 0", "the words 'div' are not understood"),
        (r"a = 5\,\mathrm{N}/\mathrm{m}", "the words 'N' are not understood"),
        (r"a = b, c, d = e", "c stands without a relation"),
        (r"y = 1{,}500 a", "whether this comma separates thousands"),
        (r"P = c [1 + O(a/R)]", "only understood as the last term"),
        (r"P = c + \mathcal{O}(a/R)", "the remainder of order a / R is not understood"),
        (r"P < c + O(a)", "an inequality with a remainder"),
        (r"P = c + o(a)", "a remainder o(...) has no order"),
        (r"P \propto a^2", r"\propto does not give the factor"),
        (r"a \ll R", r"\ll does not form an equation"),
        ("= b", "there is nothing to the left of ="),
        (r"y = e^{-x/a}", "whether e is a symbol here"),
        (r"y = \sin x y", "the end of the function's argument is unclear"),
        (r"y = \ln 2 a", "the end of the function's argument is unclear"),
        (r"y = 2P/\pi a", "whether this belongs to the denominator"),
        (r"g = \begin{cases} 0 & x < b \\ 1 \end{cases}", "this row has no condition"),
        (r"g = \begin{cases} 0 & \text{inside} \\ 1 & x > b \end{cases}", "the words 'inside'"),
        (r"A = \begin{array}{cc} a & b \end{array}", r"\begin{array} inside a display"),
    ],
)
def test_what_is_not_read_and_why(latex: str, why: str, tmp_path: Path) -> None:
    one = claims(tmp_path, rf"\[ {latex} \]")[0]
    assert "understood" not in one
    assert why in str(one["unchecked"])


@pytest.mark.parametrize(
    ("latex", "entries"),
    [
        (r"p \sim K\sqrt{s} \quad (s \to 0^+)", {"as": "s -> 0", "require": "s > 0"}),
        (r"p \sim K\sqrt{s}, \quad s \to a^{-}", {"as": "s -> a", "require": "s < a"}),
        (r"p \underset{s\to0}{\sim} K\sqrt{s}", {"as": "s -> 0"}),
        (r"{\displaystyle u\approx {\frac {Q}{a}}{\text{ as }}c\to a}", {"as": "c -> a"}),
        (r"e = \frac{a}{b} + O(a^2)", {"as": "a -> 0", "order": 2}),
        (r"a = b \quad |x| < a", {"require": "abs(x) < a"}),
        (r"a = b \text{ for } x > 0 \text{ and } y < 0", {"require": "x > 0 and y < 0"}),
        (r"a = b \text{ for } x > 0 \text{ or } x < -1", {"require": "x > 0 or x < -1"}),
        (r"a = b \quad\text{for } x > 0, y < 2", {"require": "x > 0 and y < 2"}),
        (r"a = b, \quad \nu \neq 0", {"require": "(nu < 0 or nu > 0)"}),
        (r"a = b \text{ for $x_{1} > 0$}", {"require": "x_1 > 0"}),
        (r"a = b \qquad\text{for moderate tension}", {"says": "for moderate tension"}),
        (r"\text{Hertz:}\quad a = b", {"says": "Hertz:"}),
    ],
)
def test_conditions_limits_and_words_are_kept(
    latex: str, entries: dict[str, object], tmp_path: Path
) -> None:
    (one,) = claims(tmp_path, rf"\[ {latex} \]")
    assert "understood" in one, one
    assert "unchecked" not in one
    assert {key: one[key] for key in ("as", "require", "order", "says") if key in one} == entries


@pytest.mark.parametrize(
    ("latex", "why"),
    [
        (r"p = \frac{Qs}{L}, \quad s \ll L", r"its condition s \ll L could not be read"),
        (r"a = b \quad \text{otherwise}", "its condition"),
        (r"a \sim b, x \to 0, c \to 1", "it holds in several limits"),
        (r"a = b + O(x^2), \quad c \to 0", "its remainder tends to zero with x"),
        (r"a = b + \ldots", "it is an approximation"),
    ],
)
def test_what_is_read_but_not_judged(latex: str, why: str, tmp_path: Path) -> None:
    (one,) = claims(tmp_path, rf"\[ {latex} \]")
    assert "understood" in one
    assert why in str(one["unchecked"])


def test_what_follows_from_a_condition_is_not_read(tmp_path: Path) -> None:
    first, second = claims(tmp_path, r"\[ x > 0 \Rightarrow a = b \]")
    assert first["understood"] == "x > 0"
    assert "it follows from a condition" in str(second["unchecked"])
    both = claims(tmp_path, r"\[ a = b \iff c = d \]")
    assert all("may both be false" in str(each["unchecked"]) for each in both)
    assert not any("understood" in each for each in both)


def test_an_unread_statement_keeps_its_limit_and_condition(tmp_path: Path) -> None:
    latex = r"\[ P \simeq \unknown{b} \quad\text{as } b\to 0 \text{ for } a > b \]"
    (one,) = claims(tmp_path, latex)
    assert (one["as"], one["require"]) == ("b -> 0", "a > b")
    assert "unchecked" in one and "understood" not in one


def test_macros_are_not_glued_to_their_neighbours_and_eqno_gives_the_number(tmp_path: Path) -> None:
    head = (
        r"\newcommand{\Estar}{E^{*}} \newcommand{\slope}{x} \newcommand{\twice}[1]{2\pi#1}"
        r"\newcommand{\both}[2]{#2 - #1}"
    )
    path = tmp_path / "paper.tex"
    body = r"$$ \pi\Estar a = \alpha\slope + \twice{y} + \both{#2}{z} \eqno(4.3) $$"
    path.write_text(rf"{head}\begin{{document}}{body}\end{{document}}", encoding="utf-8")
    (one,) = displays(path).found
    assert one.latex.startswith(r"\pi E^{*} a = \alpha x + 2\pi y + z - #2")
    assert one.number == "4.3"


def test_rows_have_their_own_labels(tmp_path: Path) -> None:
    rows = (
        "\\begin{align} P &= a \\notag\\\\\n &= b = e \\label{law}\\\\\n"
        "&= c \\label{lawb} \\end{align}"
    )
    labels = [one["label"] for one in claims(tmp_path, rows)]
    assert labels == ["line 1", "law/1", "law/2", "lawb"]


def test_bound_variables_are_no_symbols(tmp_path: Path) -> None:
    """The t of the first equation is bound, and the r of the last one also stands outside."""
    made = drafted(
        tmp_path,
        r"\[ y = \int_b^a \frac{t}{\sqrt{t^2-x^2}}\,dt \] \[ z = \sum_{k=1}^{3} k a \]"
        r"\[ w = r \int_0^a r p(r)\,dr \]",
    )
    names = set(tomllib.loads(made.text())["symbols"])
    assert names == {"y", "b", "a", "z", "w", "r", "p_at_r"}
    assert made.understood == 3


def test_a_bound_variable_is_unknown_outside() -> None:
    assert unknown("t = integral(t, t, 0, 1)", Names("", {}, {})) == ["t"]
    assert unknown("integral(t, t, 0, b) = 1", Names("", {}, {})) == ["b"]


def test_latex_with_an_apostrophe_stays_legible(tmp_path: Path) -> None:
    text = drafted(tmp_path, r"\[ y = \frac{f'(r)}{2} \]").text()
    assert "latex = '''\n\\frac" not in text
    assert "latex = '''\ny = \\frac{f'(r)}{2}'''" in text


def test_a_plain_integral_over_a_pole_is_noted(tmp_path: Path) -> None:
    made = drafted(tmp_path, r"\[ y = \int_{-a}^{a} \frac{p(s)}{x-s}\,ds \]")
    assert "write \\fint for \\int" in made.notes[0]
    assert "# \\int may run over a pole at s = x" in made.text()
    made = drafted(tmp_path, r"\[ y = \int_{0}^{a} \frac{p(s)}{s}\,ds \]")
    assert not made.notes


@pytest.mark.parametrize(
    ("name", "words", "text", "told"),
    [
        ("F", "force", "the flat punch $F$", ("", "force", "")),
        ("F_at_x", "", "superposed flat punches of weight $F(x)$", ("", "weight of the", "Pa")),
        ("m", "", "put $m$ in", ("", "", "")),
        ("m", "", "the stick zone $[-m, n]$", ("", "left end of", "m")),
        ("P", "compressive force", "", ("load(a, c)", "compressive force", "N/m")),
        ("P", "perimeter", "", ("", "perimeter", "")),
    ],
)
def test_proposals_fit_the_words(
    name: str, words: str, text: str, told: tuple[str, str, str]
) -> None:
    found = proposal(name, words, text)
    assert found.meaning.startswith(told[1])
    assert (found.formula, found.unit) == (told[0], told[2])


@pytest.mark.parametrize(
    ("text", "meaning"),
    [
        ("a material of shear strength $k$ yields", "shear strength"),
        ("the coefficient of friction $k$", "coefficient of friction"),
        ("pressed into the half-plane to the depth $k$", "depth"),
        ("moves the stick zone by $k$", None),
        ("$k$ is the largest pressure, which", "largest pressure"),
    ],
)
def test_meanings_end_where_the_words_end(text: str, meaning: str | None, tmp_path: Path) -> None:
    made = drafted(tmp_path, rf"{text} \[ k = 2 \]")
    known = tomllib.loads(made.text())["symbols"]["k"]
    assert (known["meaning"] if known else None) == meaning


def test_the_place_of_an_error_is_told(tmp_path: Path) -> None:
    (one,) = claims(tmp_path, r"\[ a = \frac{b}{c} + \star d \]")
    assert r"at `\star d`" in str(one["unchecked"])


@pytest.mark.parametrize(("text", "why"), [("a = (b", "not closed"), ("a = b)", "matches nothing")])
def test_brackets_that_do_not_fit_are_refused(text: str, why: str) -> None:
    with pytest.raises(BadFormula, match=why):
        statements("here", text)


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("integral(s, s, oo, 0) = 1", "wrong order"),
        ("pv(1/(s - 1), s, 0, oo) = 1", "an end of this principal value is infinite"),
    ],
)
def test_ends_that_no_integral_may_have(text: str, why: str) -> None:
    with pytest.raises(BadFormula, match=why):
        equation(text, Names("", {}, {}))


def test_a_line_of_latex_that_looks_like_a_table_does_not_hinder_the_acceptance() -> None:
    text = "[[claims]]\nlabel = 'a'\nlatex = '''\na = b\n[[claims]]\n [c]'''\naccepted = false\n"
    assert heads(text, 1) == [1]
    new = with_lines(text, 1, {1: "a = b"})
    assert new == f'{text.replace("false", "true")}understood = "a = b"\n'


def test_the_condition_of_a_display_is_not_forgotten(tmp_path: Path) -> None:
    path = tmp_path / "claims.toml"
    text = (
        "[variables]\na = 'x'\n[symbols]\nb = 'Abs(a - 1) + 1'\n[[claims]]\nlabel = 'x'\n"
        "latex = 'b = a \\text{ for } a > 1'\npart = 1\nunderstood = 'b = a'\n"
    )
    path.write_text(text)
    (claim,) = read_claims(path).claims
    assert check(claim).verdict == "unchecked"
    assert "also says a > 1" in claim.unchecked
    path.write_text(f"{text}require = 'a > 1'\n")
    assert check(read_claims(path).claims[0]).judged.good
