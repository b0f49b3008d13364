"""How formulas are written: what is printed says the same as the expression."""

import re

import pytest
from rich.console import Console
from sympy import Expr, Symbol, parse_expr, symbols

from derive.command.view import formulas
from derive.reading.latex import Latex
from derive.reading.statements import statements
from derive.sheet.notation import latex_name, latex_of, text_of
from derive.symbols import QUANTITIES
from tests.derive.bodies import VALUES, close, number, sheet

pytestmark = pytest.mark.slow

p, q, r = symbols("p q r", positive=True)
LOADS = {"a": 2, "c": 1, "x": 0.375, "dQ": 0.5, "dsigma": -0.25, "dP": 0.25, "dM": 0.125}
LOADS |= {"f": 0.5, "P": 0.75, "M": 0.125, "e": 0.125 / 0.75, "alpha": 0.125}


LATEX = {
    **{"E_star": "E^{*}", "alpha": r"\alpha", "dQ": r"\Delta Q", "dsigma": r"\Delta\sigma"},
    **{"K_N_left": r"K_{N,\mathrm{left}}", "q_left_2": r"q_{\mathrm{left},2}"},
    **{"theta_1": r"\theta_{1}", "P_prime": "P'", "L_T_left": r"L_{T,\mathrm{left}}"},
    **{"S_right": r"S_{\mathrm{right}}", "d_exact_left": r"d_{\mathrm{exact},\mathrm{left}}"},
    **{"Delta_K_T": r"\Delta K_{T}", "Delta_sigma_th": r"\Delta \sigma_{\mathrm{th}}"},
    **{"Delta_1": r"\Delta_{1}", "radius": r"\mathrm{radius}", "alpha_a": r"\alpha_{a}"},
    **{"dP_prime_db": r"\frac{\mathrm{d}P'}{\mathrm{d}b}", "dQ_d": r"\Delta Q_{d}"},
    **{"d2g_dx2": r"\frac{\mathrm{d}^{2}g}{\mathrm{d}x^{2}}"},
    **{"dP_dQ": r"\frac{\mathrm{d}P}{\mathrm{d}Q}", "cos_1": r"\cos_{1}", r"\chi": r"\chi"},
}


@pytest.mark.parametrize("name", LATEX)
def test_symbols_are_set_as_the_theory_writes_them(name: str) -> None:
    quantity = QUANTITIES.get(name)
    assert latex_of(quantity.symbol if quantity else Symbol(name)) == LATEX[name]


def from_latex(expr: Expr) -> Expr:
    """An expression from its LaTeX, by the reader of papers, which refuses braces that hide."""
    text = latex_of(expr).replace(r" \right)}", r"\right)")
    text = re.sub(r"(\\(?!sqrt|frac)[a-z]+){\\left\(", r"\1\\left(", text)
    text = text.replace(r"\left|{", r"\left|").replace(r"}\right|", r"\right|")
    local = {s.name: s for s in expr.atoms(Symbol)}
    spellings = {latex_name(name): name for name in local} | {"q_{0}": "q_0"}
    latex = f"q_{{0}} = {text}"
    (statement,) = statements("here", latex)
    understood = Latex("here", latex, spellings).read("equation", statement.tokens)
    return parse_expr(understood.removeprefix("q_0 = "), local_dict=local)


@pytest.mark.parametrize("name", ["hertz", "wedge", "two_radii", "flat_rounded"])
def test_the_latex_of_a_formula_reads_back_to_the_same_number(name: str) -> None:
    """Except for functions that papers do not have, such as the angle of two arguments."""
    body, read = sheet(name), 0
    for key in body:
        if r"\operatorname" not in latex_of(body.shown(key)):
            again, read = from_latex(body.shown(key)), read + 1
            frame = {s.name: 0.25 + len(s.name) / 8 for s in body.shown(key).free_symbols}
            numbers = frame | VALUES | LOADS
            assert close(number(again, **numbers), number(body.shown(key), **numbers)), key
    assert read > 20


@pytest.mark.parametrize("name", ["hertz", "wedge", "two_radii", "flat_rounded"])
def test_a_printed_formula_reads_back_to_the_same_number(name: str) -> None:
    """The text is what a user copies: it must be the formula, not something like it."""
    body = sheet(name)
    local = {s.name: s for key in body for s in body.flat(key).free_symbols}
    for formula in body:
        expr = body.flat(formula)
        again = parse_expr(text_of(expr), local_dict=local)
        assert close(number(again, **LOADS), number(expr, **LOADS)), formula


@pytest.mark.parametrize("name", ["hertz", "wedge", "flat_rounded"])
def test_a_sheet_prints_every_formula_and_every_definition(name: str) -> None:
    """As LaTeX, too: one row for each."""
    body, lines = sheet(name), [line.strip() for line in str(sheet(name)).splitlines()]
    assert lines[0] == f"{name}: g(x) = {text_of(body.geometry.g)}"
    for key, formula in body.items():
        assert lines.count(body.equation(key)) == 1
        assert any(formula.meaning in line for line in lines)
        assert any(formula.source in line for line in lines)
    for symbol, definition in body.definitions.items():
        assert f"{symbol} = {text_of(definition)}" in lines
    first, *rows, last = body.latex.splitlines()
    assert (first, last) == (r"\begin{aligned}", r"\end{aligned}")
    assert len(rows) == 1 + len(body) + len(body.definitions | body.computed_definitions)
    assert all(row.count("&=") == 1 for row in rows)


@pytest.mark.parametrize("name", ["hertz", "wedge", "flat_rounded"])
def test_every_symbol_of_a_printed_sheet_is_told(name: str) -> None:
    """As the lever arm e, which no formula defines."""
    body, printed = sheet(name), str(sheet(name))
    terminal = Console(width=400)
    with terminal.capture() as shown:
        terminal.print(formulas(body))
    held = set().union(*({*f.arguments, *body.shown(key).free_symbols} for key, f in body.items()))
    held = held.union(*(of.free_symbols for of in body.definitions.values()))
    told = {q.name: q.meaning for q in body.quantities}
    for symbol in held - set(body.definitions):
        assert f"    {symbol}: {told[str(symbol)]} [" in printed
        assert re.search(rf"^{symbol} +{re.escape(told[str(symbol)])} \[", shown.get(), re.M)
    assert name != "hertz" or "    e: lever arm M/P" in printed
