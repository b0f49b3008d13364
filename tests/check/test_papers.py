"""From LaTeX to verdicts: papers in miniature, of which some equations are wrong on purpose.

Each is drafted by the command, its symbols are filled in as a person would, all readings are
accepted, and what is judged is compared with what is known of the formulas by hand.
"""

import re
from dataclasses import dataclass, field
from pathlib import Path

import pytest

from tests.check.asking import claim, run, told

PAPERS = Path(__file__).parent / "papers"

GOOD = {"holds", "numerical", "by definition"}


@dataclass(frozen=True)
class Filled:
    """What a person writes into a draft: lines of [variables], symbols, and what is expected.

    wrong: labels of false equations -> a part of the correction or of the diagnosis
    """

    head: str
    variables: str
    symbols: dict[str, str]
    wrong: dict[str, str]
    units: set[str] = field(default_factory=set)
    given: dict[str, str] = field(default_factory=dict)


FILLED = {
    # P = pi E* a**2/(4 R), p_0 = E* a/(2 R), dP/da = pi E* a/(2 R)
    "hertz": Filled(
        'body = "hertz"\n',
        "a = { meaning = 'half-width', unit = 'm' }\n",
        {
            "P": "load(a, a)",
            "p_at_x": "pressure(x, a, a)",
            "p_0": "pressure(0, a, a)",
            "dP_da": "diff(P, a)",
        },
        {"peak2": "E_star*a/(2*R)", "line 22": "pi*E_star*a/(2*R)"},
    ),
    # Q = f P (1 - c**2/a**2): shear is f times the pressure of a less that of c
    "cattaneo": Filled(
        'body = "hertz"\n',
        "a = { meaning = 'half-width', unit = 'm' }\n"
        "k = { meaning = 'c/a', low = 0.05, high = 0.95, unit = '-' }\n",
        {
            "c": "k*a",
            "P": "load(a, a)",
            "Q": "f*(load(a, a) - load(c, c))",
            "p_0": "2*P/(pi*a)",
            "q_at_x": "f*(pressure(x, a, a) - pressure(x, c, c))",
        },
        {"stick": "sqrt(1 - Q/(P*f))", "sum": " - "},
    ),
    # K = E* sqrt(2 a)/(2 R); the principal value of 1/(x - s) is log((a + x)/(a - x))
    "johnson": Filled(
        'body = "hertz"\n',
        "a = { meaning = 'half-width', unit = 'm' }\n",
        {
            "p_at_x": "pressure(x, a, a)",
            "p_at_s": "pressure(s, a, a)",
            "K": "K_N_left(a, a)",
        },
        {"edgefactor": "E_star*sqrt(2*a)/(2*R)", "pole": "-log("},
    ),
    # M = -int p x dx = (E* phi/4) sqrt(a c) (a - c); dP/dc at fixed a is E* phi sqrt(a/c)/2
    "wedge": Filled(
        'body = "wedge"\n',
        "a = { meaning = 'left', unit = 'm' }\nc = { meaning = 'right', unit = 'm' }\n",
        {
            "P": "load(a, c)",
            "M": "moment(a, c)",
            "alpha": "tilt(a, c)",
            "P_c": "diff(load(a, c), c)",
        },
        {"moment": "", "(4)": "E_star*phi*sqrt(a/c)/2"},
    ),
    # E* = E/(2 (1 - nu**2)) = 2 G (1 + nu)/(2 (1 - nu) (1 + nu)) = G/(1 - nu)
    "cycle": Filled(
        "",
        "nu = { low = -0.9, high = 0.5, unit = '-' }\nG = { meaning = 'modulus', unit = 'Pa' }\n",
        {"E": "2*G*(1 + nu)", "E_star": "G/(1 - nu)"},
        {"wrong": "2*G/(2 - 2*nu)"},
        given={"follows": '["modulus", "shearmodulus"]', "wrong": '["modulus", "shearmodulus"]'},
    ),
}


def checked(name: str, folder: Path) -> dict[str, dict[str, str]]:
    """Every claim of a paper by its label, after one draft, one acceptance and one run."""
    filled = FILLED[name]
    new = folder / f"{name}.toml"
    paper = PAPERS / f"{name}.tex"
    run(paper, "--draft", new)
    text = new.read_text()
    for symbol in [*filled.symbols, *re.findall(r"^(\w+) =", filled.variables, re.MULTILINE)]:
        text = re.sub(rf"(?m)^{symbol} = .*\n", "", text, count=1)
    lines = "".join(f'{symbol} = "{formula}"\n' for symbol, formula in filled.symbols.items())
    text = text.replace("\n[variables] ", f"\n{filled.head}[variables] ", 1)
    text = text.replace("\n[symbols]\n", f"\n{filled.variables}\n[symbols]\n{lines}", 1)
    for label, given in filled.given.items():
        text = text.replace(f"label = '{label}'\n", f"label = '{label}'\ngiven = {given}\n")
    new.write_text(text)
    run(new, "--accept", answers="y\n" * 40)
    return {claim["label"]: claim for claim in told(folder, new.read_text())}


@pytest.mark.slow
@pytest.mark.enough("cattaneo", "cycle")
@pytest.mark.parametrize("name", FILLED)
def test_a_paper_from_latex_to_verdicts(name: str, tmp_path: Path) -> None:
    found = checked(name, tmp_path)
    wrong = FILLED[name].wrong
    for label, it in found.items():
        if label in wrong:
            assert it["verdict"] == "fails", f"{label}: {it['reason']}"
            mended = f"{it['corrected'] or ''} {it['diagnosis'] or ''}"
            assert wrong[label].replace(" ", "") in mended.replace(" ", ""), f"{label}: {mended}"
            assert mended.strip(), label
        else:
            assert it["verdict"] in GOOD, f"{label}: {it['verdict']}, {it['reason']}"
        assert not it["units"], f"{label}: {it['units']}"
    assert wrong.keys() <= found.keys()


UNITS = """
body = "hertz"
[variables]
a = { unit = "m" }
k = { unit = "-" }
[symbols]
P = { unit = "N/m" }
Q = { unit = "N/m" }
p_0 = { unit = "Pa" }
K = { unit = "Pa/sqrt(m)" }
sigma = { unit = "Pa" }
e = { unit = "m" }
"""
FITTING = (
    ("a**2", "4*P*R/(pi*E_star)"),
    ("p_0", "sqrt(P*E_star/(pi*R))"),
    ("P", "integral(p_0*sqrt(1 - s**2/a**2), s, -a, a)"),
    ("K", "E_star/(2*R)*sqrt(2*a)"),
    ("e", "-R*sigma/(4*f*E_star)"),
    ("Q", "f*P*(1 - k**2)"),
    ("sigma", "4*E_star*f/R*(a - sqrt(a**2 - 2*R*Q/(pi*E_star*f)))"),
    ("p_0/sigma", "log(a/R) + atan(P/(Q + E_star*a))"),
)


@pytest.mark.parametrize(("left", "right"), FITTING)
def test_a_factor_with_a_unit_that_is_dropped_or_doubled_is_named(
    left: str, right: str, tmp_path: Path
) -> None:
    """What is printed right cannot be judged: its symbols have units, and no meaning."""
    factors = ("a", "R", "E_star", "P", "p_0", "sqrt(a)", "K")
    printed = [f"{left} = {right}"]
    printed += [f"{left} = ({right}){sign}{factor}" for factor in factors for sign in "*/"]
    claims = "".join(
        f"[[claims]]\nlabel = '{n}'\nprinted = '{text}'\n" for n, text in enumerate(printed)
    )
    first, *others = told(tmp_path, UNITS + claims)
    assert first["units"] is None
    assert all(claim["units"] for claim in others)
    assert first["verdict"] == "unchecked"


@pytest.mark.parametrize("more", ["", "require = '('", "ranges = { Q = [0, 1] }"])
def test_the_term_that_does_not_fit_is_named(tmp_path: Path, more: str) -> None:
    (it,) = told(tmp_path, UNITS + claim("Q = f*P + f*P*a", more))
    assert "P*a*f in P*a*f + P*f is Pa*m**2, but must be Pa*m" in it["units"]
