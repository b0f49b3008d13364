"""LaTeX as it is printed: what is read, what is refused and why, and that nothing is dropped."""

import tomllib
from pathlib import Path

import pytest

from derive.check.draft import Draft, draft_claims
from derive.check.userfile import read_claims
from derive.check.verdict import check
from derive.command.errors import BadFormula
from derive.reading.displays import displays
from derive.reading.formula import Names, unknown
from derive.reading.latex import Latex
from derive.reading.spellings import spellings
from derive.reading.statements import statements
from derive.reading.words import COMMANDS, FUNCTIONS


def table(text: str) -> list[tuple[str, ...]]:
    """The rows of a table whose cells are separated by two colons."""
    return [tuple(cell.strip() for cell in row.split("::")) for row in text.strip().splitlines()]


def drafted(folder: Path, body: str) -> Draft:
    path = folder / "paper.tex"
    path.write_text(rf"\begin{{document}}{body}\end{{document}}", encoding="utf-8")
    return draft_claims(path)


def claims(folder: Path, body: str) -> list[dict[str, object]]:
    found: list[dict[str, object]] = tomllib.loads(drafted(folder, body).text)["claims"]
    return found


def understood(latex: str) -> str:
    found = []
    for one in statements("here", latex):
        assert not one.why, one.why
        found.append(Latex("here", latex, spellings(one.tokens)).read("equation", one.tokens))
    return "; ".join(found)


READ = r"""
c = \sin^{-1}\left(\frac{a}{b}\right) :: c = asin(a/b)
K_{N}^{\text{LHS}} = E^{*} a'(c) :: K_N_LHS = E_star*a_prime_at_c
E_\star a = E_{\ast} c :: E_star*a = E_star*c
P = \int_0^a\!\int_0^b p(x)\, dx\, ds :: P = integral(integral(p_at_x, x, 0, b), s, 0, a)
u = -\!\!\!\int_0^1 \frac{ds}{s - x} :: u = pv(1/(s - x), s, 0, 1)
u = \mathrm{PV}\int_0^1 \frac{f\,{\rm d}s}{s - x} :: u = pv(f/(s - x), s, 0, 1)
u = \int_0^{1} 2 \frac{p(s)\,ds}{s} :: u = integral(2*p_at_s/s, s, 0, 1)
\frac{dP}{da} = \frac{\partial p}{\partial x} :: dP_da = dp_dx
dP/da = \frac{d^2 u}{d x^2} :: dP_da = d2u_dx2
c = \lim_{x \to \infty} \frac{a}{x} :: c = limit(a/x, x, oo)
c = \bar{u} + \hat p_0 :: c = u_bar + p_hat_0
c = \Gamma\left(\frac{3}{2}\right) :: c = gamma_function(3/2)
c = \begin{cases} a & x<0 \\ b, & \text{else} \end{cases} :: c = Piecewise((a, x < 0), (b, True))
x_\pm = e \pm c :: x_plus = e + c; x_minus = e - c
K_{N,+} = x_{-} :: K_N_plus = x_minus
x_{1,2} = e \pm c :: x_1 = e + c; x_2 = e - c
h = \operatorname{arcosh}\left(\frac{x}{a}\right) :: h = acosh(x/a)
a = \left{ b + c \right} d :: a = (b + c)*d
\boxed{a = b} :: a = b
\left\{\begin{aligned} a &= b \\ c &= d \end{aligned}\right. :: a = b; c = d
p_m := \frac{P}{2a} :: p_m = P/(2*a)
E^\star = E^{\ast}_1 :: E_star = E_1_star
\begin{array}{rcl} a &=& b c \\ d &=& 2 a \end{array} :: a = b*c; d = 2*a
y = 1{,}5 a + 0{,}125 :: y = 1.5*a + 0.125
q = p(x;a) - p(x;c) :: q = p_at_x_a - p_at_x_c
a &= b & c &= d \\ e &= f :: a = b; c = d; e = f
a \quad = \quad b :: a = b
\mathrm{d}Q = \int_0^1 q\,\mathrm{d}s :: dQ = integral(q, s, 0, 1)
y = \mathrm{e}^{-x/a} + {\rm e}^{2} :: y = exp(-x/a) + exp(2)
y = e^2 + e^{3} :: y = e**2 + e**3
y = \log_{10} x :: y = log(x)/log(10)
y = \sin a\,\ln\left|\tan\frac{a}{2}\tan b\right| :: y = sin(a)*log(abs(tan(a/2)*tan(b)))
y = b \sin 2\varphi_0 - \cos 2\pi x :: y = b*sin(2*varphi_0) - cos(2*pi*x)
y = \lambda_1 \int_0^1 \lambda\,d\lambda :: y = lam_1*integral(lam, lam, 0, 1)
P = 2\mathrm{K}(k) \int_0^a p\,\mathrm dx :: P = 2*K_at_k*integral(p, x, 0, a)
a = b = c :: a = b; a = c
a \leq b = c. :: a <= b; b = c
a > 0,\quad b > 0 :: a > 0; b > 0
m < a,\quad n < c :: m < a; n < c
x > b,\quad x < a :: x > b; x < a
a = b \quad\text{and}\quad c = d; :: a = b; c = d
a \pm b = \mp c :: a + b = -c; a - b = c
a = {b \over c} :: a = b/c
\begin{split} a &= b \\ &+ c \end{split} :: a = b + c
q = -f p \mathop{\mathrm{sgn}}(x) + \mathop{\rm sgn}\nolimits a :: q = -f*p*sign(x) + sign(a)
u = \fint_0^1 \frac{ds}{s} + \dashint_0^1 s\,ds :: u = pv(1/s, s, 0, 1) + pv(s, s, 0, 1)
u = \mathop{\mathrm{p.v.}}\!\int_0^1 \frac{ds}{s - x} :: u = pv(1/(s - x), s, 0, 1)
y = \cos\frac{1}{2}(\theta + \theta_0) \sin x :: y = cos(1/2*(theta + theta_0))*sin(x)
y = \sinh\tfrac12\left[a - b\right] :: y = sinh(1/2*(a - b))
y = \sin 2(\theta-\phi) + \sin\frac{3}{2}\theta :: y = sin(2*(theta - phi)) + sin(3/2*theta)
y = \ln\tan\frac{\phi_0}{2} - \ln\cot^2 x :: y = log(tan(phi_0/2)) - log(cot(x)**2)
y = \tan\arccos\frac{c}{a} + b\,\mathrm{ctg}\,x :: y = tan(acos(c/a)) + b*cot(x)
y = \frac{\sec x}{\cot x} + \coth x :: y = sec(x)/cot(x) + coth(x)
y = \sec^{-1} x + \operatorname{arsech} x :: y = asec(x) + asech(x)
y = \operatorname{sech}^2 x + \mathrm{arccoth}\,x :: y = sech(x)**2 + acoth(x)
y = c^2_{\text{stick}} - K^{*}_N :: y = c_stick**2 - K_N_star
u_x^{(1)} = u_x^{(2)} + x^{(k)} :: u_x_upper1 = u_x_upper2 + x_upperk
y = f_{,x} - f_x :: y = f_comma_x - f_x
\mathcal{P}(x) = \ddot{u} + \check v :: P_cal_at_x = u_ddot + v_check
y = \begin{cases} 1 & x = 0 \end{cases} :: y = Piecewise((1, (x <= 0 and x >= 0)))
\begin{split} a &= 2 \left( b + \right. \\ & \left. c \right) \end{split} :: a = 2*(b + c)
c = \frac12 a + |a| + |P||f| :: c = 1/2*a + abs(a) + abs(P)*abs(f)
c = \sqrt aP + {a}^{2} :: c = sqrt(a)*P + a**2
"""


@pytest.mark.parametrize(("latex", "text"), table(READ))
def test_what_is_read(latex: str, text: str) -> None:
    """A line break in the source is not printed."""
    assert understood(latex.replace(r" \\", "\n\\\\")) == text


@pytest.mark.parametrize("command", COMMANDS)
def test_a_function_is_read_from_its_command(command: str) -> None:
    """And from its upright name, unless that begins with a capital letter."""
    name = COMMANDS[command]
    arguments = "(a, b)" if FUNCTIONS[name].most > 1 else "(a)"
    assert understood(rf"y = {command}{arguments}") == f"y = {name}{arguments}"
    if command.islower():
        assert understood(rf"y = \mathrm{{{command[1:]}}}{arguments}") == f"y = {name}{arguments}"


NOT_READ = r"""
p_0 = 2\times10^{3}\quad\mathrm{MPa} :: the words 'MPa' are not understood
\operatorname{div} u = 0 :: the words 'div' are not understood
a = 5\,\mathrm{N}/\mathrm{m} :: the words 'N' are not understood
a = b \text{ unless } x = c ::  the words 'unless' are not understood
a = b \text{ in plane strain} :: the words 'in plane strain' are not understood
a = b, c, d = e :: c stands without a relation
y = 1{,}500 a :: cannot be read from here on
P = c [1 + O(a/R)] :: only understood as the last term
P < c + O(a) :: only understood as the last term
P = c + o(a) :: only understood as the last term
P \propto a^2 :: \propto does not form an equation
a \ll R :: \ll does not form an equation
a \stackrel{!}{=} b :: \stackrel does not form an equation
= b :: cannot be read from here on
y = e^{-x/a} :: whether e is a symbol here
y = \sin x y :: the end of the function's argument is unclear
y = 2P/\pi a :: whether this belongs to the denominator
y = \sum_{k=1}^3 k a + b :: whether this belongs to the sum or limit before it, at `+ b`
y = \lim_{x \to 0} x + 1 :: whether this belongs to the sum or limit before it, at `+ 1`
y = \sin(a, b) :: sin takes 1 argument
y = \sin + a :: complete it as in \sin(a)
y = \sum_k a :: complete it as in \sum_{k=1}^{n} k
y = \frac{d}{dx} p(x) :: at `d}{dx} p(x)`
g = \begin{cases} 0 & x < b \\ 1 \end{cases} :: complete it as in \begin{cases} a & x < b
g = \begin{cases} 0 & x \\ 1 & x < b \end{cases} :: this is not a condition
g = \begin{cases} 0 & x < b \text{ or } x > c, b > 0 \end{cases} :: joined by `or`, and others by
g = \begin{cases} 0 & \text{inside} \\ 1 & x > b \end{cases} :: the words 'inside'
y = \cos\frac{\theta}{2}(1 + b) :: mean cos(theta/2*(1 + b)) or cos(theta/2)*(1 + b), at `(1 + b)`
y = \sin^2 n\theta :: it may mean sin(n*theta)**2 or sin(n)**2*theta, at `\theta`
y = \ln\sin x\cos x :: it may mean log(sin(x)*cos(x)) or log(sin(x))*cos(x)
y = \cos a / b :: it may mean cos(a/b) or cos(a)/b
y = \sin(a)^2 :: it may mean sin((a)**2) or sin(a)**2
y = \cot^{-1} x :: index or power of \cot is unclear
y = \sum_{k=1}^{3} b_k k :: b_k differs in each term of a sum, at `b_k k`
y = \lim_{x\to a^-} p :: a limit from one side is not read, at `a^-} p`
y = \int_{x=0}^{a} x\,dx :: complete it as in \int_{a}^{b}
y = x^{(k+1)} :: whether the parentheses hold an exponent or an index, at `(k+1)}`
y = \max p :: it is unclear over what \max of one quantity is taken
\left.\frac{dp}{dx}\right|_{x=a} = 0 :: a value at a point, or between two, is not read, at `|_{x
\begin{array}{c|cc} n & A_n & B_n \\ 0 & 1.1 & 2.2 \end{array} :: \begin{array} is a table
\begin{pmatrix} u \\ v \end{pmatrix} = 0 :: \begin{pmatrix} is a table or a matrix
a = \frac{b}{c} + \star d :: at `\star d`
y = a \quad\over b = c :: \over divides the whole display
K_{\beginh} = a :: \beginh
a = (b :: not closed
a = b) :: matches nothing
\boxed{a = b) :: this { is not closed
"""


@pytest.mark.parametrize(("latex", "why"), table(NOT_READ))
def test_what_is_not_read_and_why(latex: str, why: str, tmp_path: Path) -> None:
    one = claims(tmp_path, rf"\[ {latex} \]")[0]
    assert "understood" not in one
    assert why in str(one["unchecked"])


CONDITIONS = r"""
p \sim K\sqrt{s} \quad (s \to 0^+) :: as = 's -> 0', require = 's > 0'
p \sim K\sqrt{s}, \quad s \to a^{-} :: as = 's -> a', require = 's < a'
{\displaystyle u\approx {\frac {Q}{a}}{\text{ as }}c\to a} :: as = 'c -> a'
e = \frac{a}{b} + O(a^2) :: as = 'a -> 0', order = 2
a = b \quad |x| < a :: require = 'abs(x) < a'
|q| \le f p,\quad |x| < a :: require = 'abs(x) < a'
q \le f p, \quad -a < x < c :: require = '-a < x < c'
a = b \text{ for } x > 0 \text{ and } y < 0 :: require = 'x > 0 and y < 0'
a = b \text{ for } x > 0 \text{ or } x < -1 :: require = 'x > 0 or x < -1'
a = b \quad\text{for } x > 0, y < 2 :: require = 'x > 0 and y < 2'
a = b, \quad \nu \neq 0 :: require = '(nu < 0 or nu > 0)'
a = b \text{ for $x_{1} > 0$} :: require = 'x_1 > 0'
a = b \qquad\text{for moderate tension} :: says = 'for moderate tension'
\text{Hertz:}\quad a = b :: says = 'Hertz:'
"""


@pytest.mark.parametrize(("latex", "entries"), table(CONDITIONS))
def test_conditions_limits_and_words_are_kept(latex: str, entries: str, tmp_path: Path) -> None:
    (one,) = claims(tmp_path, rf"\[ {latex} \]")
    assert "understood" in one and "unchecked" not in one, one
    found = {key: one[key] for key in ("as", "require", "order", "says") if key in one}
    assert found == tomllib.loads(f"it = {{{entries}}}")["it"]


NOT_JUDGED = r"""
p = \frac{Qs}{L}, \quad s \ll L :: its condition s \ll L could not be read
a = b \quad \text{otherwise} :: its condition
a \sim b, x \to 0, c \to 1 :: it holds in several limits
a = b + O(x^2), \quad c \to 0 :: it holds in several limits, c -> 0, x -> 0
a = b + \ldots :: it is an approximation
"""


@pytest.mark.parametrize(("latex", "why"), table(NOT_JUDGED))
def test_what_is_read_but_not_judged(latex: str, why: str, tmp_path: Path) -> None:
    (one,) = claims(tmp_path, rf"\[ {latex} \]")
    assert "understood" in one
    assert why in str(one["unchecked"])


def test_no_equation_follows_from_an_inequality_with_a_remainder(tmp_path: Path) -> None:
    found = claims(tmp_path, r"\[ a < b + O(c) = P \]")
    assert not any("understood" in each for each in found)


def test_what_follows_from_a_condition_is_not_read(tmp_path: Path) -> None:
    first, second = claims(tmp_path, r"\[ x > 0 \Rightarrow a = b \]")
    assert first["understood"] == "x > 0"
    assert "it follows from a condition" in str(second["unchecked"])
    for joint, why in ((r"\iff", "may both be false"), (r"\text{ or }", "only one may hold")):
        both = claims(tmp_path, rf"\[ a = b {joint} c = d \]")
        assert all(why in str(each["unchecked"]) for each in both)
        assert not any("understood" in each for each in both)


def test_an_unread_statement_keeps_its_limit_and_condition(tmp_path: Path) -> None:
    latex = r"\[ P \simeq \unknown{b} \quad\text{as } b\to 0 \text{ for } a > b \]"
    (one,) = claims(tmp_path, latex)
    assert (one["as"], one["require"]) == ("b -> 0", "a > b")
    assert "unchecked" in one and "understood" not in one


# ------------------------------------------------------------------ a single equation of a claim

SPELLINGS = {"a": "a", "c": "c", "P": "P", "f": "f", "Q": "Q", "E^*": "E_star", r"\Delta Q": "dQ"}


def read_one(latex: str) -> str:
    (one,) = statements("here", latex)
    return Latex("here", latex, SPELLINGS).read("equation", one.tokens)


REFUSED = r"""
c = a \gamma :: \gamma is neither a declared symbol :: 6
c = a -- P :: cannot be read :: 7
c = 1/a^{2} Q :: belongs to the denominator :: 12
c = {a + P}^2 :: not printed :: 4
c = \frac123 :: two numbers :: 11
c = {|a}| :: not closed :: 5
c = \int_0^1 a :: complete it as in \int_{a}^{b} :: 14
c = \sin(a) Q :: the end of the function's argument :: 12
c = \sin^{-2} Q :: index or power of \sin is unclear :: 4
c = \log_2^2 a :: index or power of \log is unclear :: 4
c = \sin :: complete it as in \sin(a) :: 8
c = \sqrt 12 :: one character :: 10
c = a^{Q}^{2} :: cannot be read from here on :: 9
c = 2 3 a :: two numbers :: 6
c = 3\frac12 :: two numbers :: 5
c = a^{Q :: not closed :: 6
"""


@pytest.mark.parametrize(
    ("latex", "part", "column"), [*table(REFUSED), ("c = " + "a" * 2500, "5003 characters", "0")]
)
def test_what_cannot_be_read_is_shown(latex: str, part: str, column: str) -> None:
    with pytest.raises(BadFormula) as caught:
        read_one(latex)
    assert part in caught.value.message
    assert caught.value.column == int(column)


def test_the_place_is_shown_in_its_line() -> None:
    with pytest.raises(BadFormula) as caught:
        read_one("c =\n a Q^12 + f")
    assert (caught.value.given, caught.value.column) == (" a Q^12 + f", 5)


# ------------------------------------------------------------------ the file


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


def test_a_table_outside_displays_is_told_and_hides_no_display(tmp_path: Path) -> None:
    rows = r"n & 1 & 2 \\ $A_n$ & 0.5 & 0.7 \\ & \multicolumn{2}{c}{$$ a = b $$}"
    head = r"\begin{tabular}{cc} name & material \end{tabular}"
    made = drafted(tmp_path, f"\n{head} \\begin{{tabular}}{{c|cc}} {rows} \\end{{tabular}}")
    assert (made.environments, made.understood) == (1, 1)
    (told,) = made.unread
    assert told.startswith(
        r"paper.tex:2: \begin{tabular} is a table or a matrix, which is not read"
    )


@pytest.mark.parametrize(
    "latex", ["K = p(a - s)", "p(-x) = K", r"p(\sin y) = K", "K = P, x > p(2a)"]
)
def test_a_function_is_no_factor(latex: str, tmp_path: Path) -> None:
    """Here p is printed as a function, and never alone; p_0 is none."""
    *_, one = claims(tmp_path, rf"\[ p(x) = p_0 \] \[ {latex} \]")
    assert str(one["unchecked"]).startswith("p is a function elsewhere, so it is unclear whether")
    *_, one = claims(tmp_path, r"\[ p(x) = p_0 \] \[ p = p_0(a - s) \]")
    assert one["understood"] == "p = p_0*(a - s)"


DEFINED = r"""
x = b\sin\phi :: phi = asin(x/b)
x = e + a\cos\theta :: theta = acos((-e + x)/a)
s = a\cosh u, \quad u > 0 ::
s = a\cosh u :: u = acosh(s/a)
\tan\psi_0 = a/b :: psi_0 = atan(a/b)
b = a\sin\phi :: b = a*sin(phi)
y = b\cot\phi :: y = b*cot(phi)
x = b\sin\phi + c\phi ::
x = b\sin^2\phi ::
c = d \] The width \[ c = 2 d :: c = d
w = c/2 \] With it, where \[ c = 2 d :: w = c/2, c = 2*d
c^2 = d \] and \[ c = 2 d ::
"""


@pytest.mark.parametrize(("latex", "defined"), table(DEFINED))
def test_what_a_paper_defines_is_proposed(latex: str, defined: str, tmp_path: Path) -> None:
    """A letter alone on the left; the angle of a substitution, by its principal value.

    A letter that occurred before is defined only after "where".
    """
    made = drafted(tmp_path, rf"\[ {latex} \]")
    found = [f"{n} = {said['proposal']}" for n, said in made.open.items() if said]
    assert found == [each for each in defined.split(", ") if each]


def test_rows_have_their_own_labels(tmp_path: Path) -> None:
    rows = (
        "\\begin{align} P &= a \\notag\\\\\n &= b = e \\label{law}\\\\\n"
        "&= c \\label{lawb} \\end{align}"
    )
    labels = [one["label"] for one in claims(tmp_path, rows)]
    assert labels == ["law, lawb", "law/1", "law/2", "lawb"]


def test_bound_variables_are_no_symbols(tmp_path: Path) -> None:
    """The t of the first equation is bound, and the r of the last one also stands outside."""
    made = drafted(
        tmp_path,
        r"\[ y = \int_b^a \frac{t}{\sqrt{t^2-x^2}}\,dt \] \[ z = \sum_{k=1}^{3} k a \]"
        r"\[ w = r \int_0^a r p(r)\,dr \]",
    )
    names = set(tomllib.loads(made.text)["symbols"])
    assert names == {"y", "b", "a", "z", "w", "r", "p_at_r"}
    assert made.understood == 3
    assert unknown("t = integral(t, t, 0, 1)", Names("", {}, {})) == ["t"]
    assert unknown("integral(t, t, 0, b) = 1", Names("", {}, {})) == ["b"]


def test_latex_with_an_apostrophe_stays_legible(tmp_path: Path) -> None:
    text = drafted(tmp_path, r"\[ y = \frac{f'(r)}{2} \]").text
    assert "latex = '''y = \\frac{f'(r)}{2}'''" in text


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


def test_no_statement_of_a_chain_with_words_inside_is_read(tmp_path: Path) -> None:
    found = claims(tmp_path, r"\[ a = b \text{ unless } x = c \]")
    assert len(found) == 2 and not any("understood" in each for each in found)


def test_a_chain_with_a_remainder_goes_on_from_its_first_side(tmp_path: Path) -> None:
    """A later equality is an approximation, too."""
    found = claims(tmp_path, r"\[ q \simeq f [b + \ldots] = c \]")
    assert [each["understood"] for each in found] == ["q ~ f*b", "q ~ c"]
