"""Four answers give the letters of a paper their standard meanings, in the letters of the paper."""

import sys
import tomllib
from pathlib import Path
from subprocess import run as run_process

import pytest

from tests.check.asking import claim, run, told, written

pytestmark = pytest.mark.usefixtures("unmended")

GOOD = {"holds", "numerical", "by definition"}

# Hertz: P = pi E* h**2/16 R, p_0 = E* h/4 R and K_N = E* sqrt(h)/2 R with h = a + c; the tilt is
# (a - c)/2 R.  Wedge: P = E* phi sqrt(a c).  Flat with rounded edges, flat -b < x < b:
# dP/da = (E* a/R) acos(b/a).
LAWS = {
    "body = 'hertz'\n[paper]\nsymmetric = true\n": (
        "P = pi*E_star*a**2/(4*R)",
        "p_0 = E_star*a/(2*R)",
        "p_max = 2*P/(pi*a)",
        "p_m = P/width",
        "p_at_m = p_0*sqrt(1 - m**2/a**2)",
        "p_at_0 = p_0",
        "K_N = p_0*sqrt(2/a)",
        "dP_da = pi*p_0",
        "P_prime = pi*p_0",
        "Q = f*P*(1 - m**2/a**2)",
        "Delta_Q = 2*Q_max",
        "dQ_dm = -2*f*P*m/a**2",
        "q_at_0 = f*p_0*(1 - m/a)",
        "m/a = sqrt(1 - Q/(f*P))",
    ),
    "body = 'hertz'\n[paper]\nsymmetric = true\nletters = { d = 'c', sigma = '\\sigma_B' }\n": (
        "c**2 = a**2*(1 - Q/(f*P))",
        "sigma_B = 4*f*p_0*e/a",
        "Delta_sigma_B = 2*sigma_B",
        "stick_width = 2*c",
        "m + n = 2*c",
    ),
    "body = 'hertz'\n[paper]\nsymmetric = true\nletters = { n = 'n' }\n": (
        "sigma = f*E_star*(n - m)/R",
        "e = (n - m)/2",
        "d_right = a - n",
    ),
    "body = 'hertz'\n[paper]\nsymmetric = false\nletters = { a = 'b', c = 'a' }\n": (
        "P = pi*E_star*(a + b)**2/(16*R)",
        "alpha = (b - a)/(2*R)",
        "M = P*(b - a)/2",
        "p_0 = E_star*(a + b)/(4*R)",
        "p_m = P/(a + b)",
        "K_N_b = E_star*sqrt(a + b)/(2*R)",
        "K_N_a = K_N_b",
        "sigma = f*E_star*(b - a - m + n)/R",
        "Q = f*P*(1 - (m + n)**2/(a + b)**2)",
        "d_right = a - n",
    ),
    "body = 'wedge'\n[paper]\nsymmetric = false\nletters = { phi = '\\varphi', P = 'W' }\n": (
        "W = E_star*varphi*sqrt(a*c)",
        "a_prime = a/c",
        "K_N_a/K_N_c = c/a",
        "W_prime = W/c",
    ),
    "body = 'flat_rounded'\n[paper]\nsymmetric = true\n"
    "letters = { b = 'a', a = 'b', m = 'c', f = 'mu', p = 's', E_star = 'E' }\n": (
        "dP_db = E*b/R*acos(a/b)",
        "dQ_dc = -mu*E*c/R*acos(a/c)",
        "K_N = 2*dP_db/(pi*sqrt(2*b))",
        "s = E/(pi*R)*integral(t*acos(a/t)/sqrt(t**2 - x**2), t, a, b)",
    ),
    "body = 'hertz'\n[paper]\nsymmetric = true\nmodulus = 'E and nu'\nletters = { E = 'Y' }\n": (
        "E_star = Y/(2*(1 - nu**2))",
        "P = pi*Y*a**2/(8*R*(1 - nu**2))",
    ),
    "body = 'hertz'\n[paper]\nsymmetric = true\nmodulus = 'E and nu, rigid'\n": (
        "P = pi*E*a**2/(4*R*(1 - nu**2))",
    ),
    "body = 'hertz'\n[paper]\nsymmetric = true\nmodulus = 'mu and kappa'\n": (
        "P = pi*mu*a**2/(R*(kappa + 1))",
    ),
    "body = 'hertz'\n[paper]\nsymmetric = true\nmodulus = 'mu and kappa, rigid'\n": (
        "P = 2*pi*mu*a**2/(R*(kappa + 1))",
    ),
}


@pytest.mark.parametrize("head", LAWS)
def test_standard_meanings_are_those_of_the_theory(head: str, tmp_path: Path) -> None:
    """Each law holds, and fails if one side is doubled."""
    text = head
    for number, law in enumerate(LAWS[head]):
        require = "require = 'abs(x) < a'\n" * ("x**2" in law)
        for name, printed in ((law, law), (f"not {law}", f"{law} + {law.partition(' = ')[2]}")):
            text += claim(printed, require).replace('"it"', f"{str([number, name])!r}")
    for it in told(tmp_path, text):
        is_law = "not " not in it["label"]
        assert it["verdict"] in (GOOD if is_law else {"fails"}), (it["label"], it["reason"])
        assert not it["units"], it


@pytest.mark.parametrize(
    ("lines", "law"),
    [
        ("[symbols]\np_0 = 'P/a'\n", "p_0 = pi*E_star*a/(4*R)"),
        ("[symbols]\np_0 = { unit = 'Pa' }\n", "p_0 = E_star*a/(2*R)"),
        ("[symbols]\np_at_b = 'P/a'\n", "p_at_0 = E_star*a/(2*R)"),
        (
            "[symbols]\nm = 'k*a'\n[variables]\nk = { low = 0.1, high = 0.9 }\n",
            "Q = f*P*(1 - k**2)",
        ),
        ("[variables]\nQ = { unit = 'N/m' }\n", "Q + P = pi*E_star*a**2/(4*R) + Q"),
    ],
)
def test_a_line_of_the_user_beats_the_standard_meaning(
    lines: str, law: str, tmp_path: Path
) -> None:
    head = "body = 'hertz'\n[paper]\nsymmetric = true\n"
    (it,) = told(tmp_path, head + lines + claim(law))
    assert it["verdict"] in GOOD, it["reason"]


@pytest.mark.parametrize(
    ("answers", "name", "why"),
    [
        ("symmetric = true", "M", "the contact is symmetric"),
        ("symmetric = true\nletters = { a = 'l' }", "K_N_l", "the contact is symmetric"),
        ("symmetric = false", "K_N", "the contact is not symmetric"),
        ("symmetric = true", "sigma", "the stick zone is given by its half-width alone"),
        ("symmetric = true\nletters = { d = 'd' }", "n", ""),
        ("symmetric = true", "nu", "the elastic constants are E_star"),
        ("symmetric = true\nmodulus = 'E and nu'", "mu", "the elastic constants are E and nu"),
        ("symmetric = true", "h", ""),
    ],
)
def test_why_a_letter_has_no_standard_meaning(
    answers: str, name: str, why: str, tmp_path: Path
) -> None:
    (it,) = told(tmp_path, f"body = 'hertz'\n[paper]\n{answers}\n{claim(f'{name} = 1')}")
    is_told = f"; {name} has no standard meaning, because {why}" in it["reason"]
    assert is_told == bool(why), it["reason"]


@pytest.mark.parametrize(
    ("printed", "require", "verdict"),
    [
        ("q_at_x = f*p_at_x", "m < x < a", "numerical"),
        ("q_at_x = 2*f*p_at_x", "m < x < a", "fails"),
        ("q_at_x = f*p_0*(sqrt(1 - x**2/a**2) - sqrt(m**2 - x**2)/a)", "-m < x < m", "numerical"),
    ],
)
def test_shear_is_at_the_friction_limit_where_it_slips(
    printed: str, require: str, verdict: str, tmp_path: Path
) -> None:
    """p(x) - p_s(x) within the stick zone, p(x) = p_0 sqrt(1 - x**2/a**2) beside it."""
    head = "body = 'hertz'\n[paper]\nsymmetric = true\n"
    (found,) = told(tmp_path, head + claim(printed, f"require = '{require}'" if require else ""))
    assert found["verdict"] == verdict


@pytest.mark.parametrize(
    ("answers", "why"),
    [
        ("symmetric = true", "it needs a body"),
        ("modulus = 'E_star'", "there is no symmetric"),
        ("symmetric = 'yes'", "symmetric must be true or false"),
        ("symmetric = true\nmodulus = 'G'", "write one of 'E_star', 'E and nu'"),
        ("symmetric = true\nletters = { c = 'b' }", "'c' is not one of our letters"),
        ("symmetric = true\nletters = { m = 'a' }", "a would stand for a and for m"),
        ("symmetric = true\nletters = { m = 'b c' }", "'b c' cannot be the name"),
        (
            "symmetric = true\nmodulus = 'mu and kappa'\nletters = { f = 'mu' }",
            "mu would stand for f and for mu",
        ),
    ],
)
def test_answers_that_are_refused(answers: str, why: str, tmp_path: Path) -> None:
    head = "" if "needs" in why else "body = 'hertz'\n"
    done = run(written(tmp_path, f"{head}[paper]\n{answers}\n{claim('P = P')}"))
    assert (done.exit_code, why in done.output) == (2, True), done.output


PAPER = r"""
\begin{document}
\begin{equation} P = \frac{E^* b^2}{4R}(\pi - 2\phi_0 - \sin 2\phi_0) \end{equation}
where \[ \phi_0 = \arcsin(a/b) \] and $k = 3$ is not read.
\begin{equation} \sin\psi_0 = a/c, \quad f := \frac{Q}{\mu P} \end{equation}
\begin{equation} K_N = \frac{2 E^*\sqrt{2b}}{\pi R}\arccos\frac{a}{b} \end{equation}
\begin{equation} t = \frac{u}{b}, \quad x > 0 \end{equation}
\end{document}
"""
ANSWERS = "flat_rounded\ny\nE_star\nb = a, a = b, m = c, f = \\mu\n"


def test_a_paper_in_ten_minutes(tmp_path: Path) -> None:
    """One draft, one acceptance and one run; what the paper defines is proposed with its place."""
    paper, new = written(tmp_path, PAPER, "paper.tex"), tmp_path / "new.toml"
    drafted = run(paper, "--draft", new, answers=ANSWERS).output
    assert "meaning: P = load(b, b)" in drafted and "meaning: Q = mu*(load(b, b)" in drafted
    data = tomllib.loads(new.read_text())
    assert data["paper"]["letters"]["f"] == r"\mu"
    proposed = {
        n: (said["proposal"], said["meaning"]) for n, said in data["symbols"].items() if said
    }
    assert proposed == {
        "phi_0": ("asin(a/b)", "paper.tex:4"),
        "psi_0": ("asin(a/c)", "eq. (2), statement 1, paper.tex:5"),
        "f": ("Q/(mu*P)", "eq. (2), statement 2, paper.tex:5"),
    }
    assert {n for n, said in data["symbols"].items() if not said} == {"t", "u"}
    waiting = run(new)
    assert waiting.exit_code == 1 and "unexpected" not in waiting.output
    assert "--accept" in waiting.output and "t, u" in waiting.output
    shown = run(new, "--accept", answers="y\nn\ny\nall\n").output
    assert "standard meaning: P = load(b, b), normal load" in shown
    assert "1 of 3: phi_0\n  defined at  paper.tex:4\n  means       asin(a/b)" in shown
    assert "8 accepted, 1 left" in shown
    found = [(it["verdict"], it["rests_on"]) for it in told(tmp_path, new.read_text())]
    assert [verdict for verdict, _ in found] == [
        *("numerical", "by definition", "unchecked", "by definition", "fails", "unchecked")
    ]


def test_a_wrong_answer_is_asked_again(tmp_path: Path) -> None:
    """Each question, and each answer that does not come from a terminal, stands in a line."""
    paper, new = written(tmp_path, PAPER, "paper.tex"), tmp_path / "new.toml"
    answers = "cone\nhertz\nmaybe\nn\nG\nE_star\nm = a\nm = k, n = l\n"
    command = [sys.executable, "-m", "derive", "check", str(paper), "--draft", str(new)]
    output = run_process(command, input=answers, capture_output=True, text=True, check=True).stdout
    assert "'cone' is not one of" in output and "a would stand for a and for m" in output
    assert "(E_star; E and nu; E and nu, rigid; mu and kappa; mu and kappa, rigid)" in output
    for line in ("1. Body", "2. Symm", "3. Elas", "4. Lett", "Error: 'G'"):
        assert f"\n{line}" in output
    assert tomllib.loads(new.read_text())["paper"] == {
        "symmetric": False,
        "modulus": "E_star",
        "letters": {"m": "k", "n": "l"},
    }
