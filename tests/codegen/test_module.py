"""Modules as text: only of what is proven, the same every time, clean, standalone and right."""

import ast
import re
import warnings
from collections.abc import Callable, Iterable
from dataclasses import replace

import numpy as np
import pytest
from sympy import (
    Abs,
    Expr,
    Max,
    Piecewise,
    Rational,
    Symbol,
    exp,
    sqrt,
    tan,
)

from derive import Geometry, parameter, x
from derive.body.library import load_geometry
from derive.codegen.example import example_of
from derive.codegen.function import FunctionText
from derive.codegen.module import module_text
from derive.codegen.program import Program
from derive.codegen.trial import demand_right
from derive.command.errors import BadName, NotProven
from derive.command.limit import within
from derive.pipeline import GENERATED
from derive.proof.points import loads
from derive.proof.verdict import POINTS, Proof, Verdict
from derive.sheet.derivation import derive_sheet
from derive.symbols import RESERVED, a, c
from generated import hertz
from tests.codegen.made import STUCK, module_of, text_of_body
from tests.derive.bodies import assumed, sheet

pytestmark = pytest.mark.slow


def words(text: str) -> str:
    """A text without its line breaks."""
    return " ".join(text.split())


# ------------------------------------------------------------------ only what is proven


@pytest.mark.parametrize("proof", [None, *(Proof(v, "by a test") for v in list(Verdict)[2:])])
def test_one_formula_that_is_not_proven_stops_the_module(proof: Proof | None) -> None:
    of = assumed(sheet("hertz"))
    for name, formula in of.items():
        formulas = {**of.formulas, name: replace(formula, proof=proof)}
        with pytest.raises(NotProven, match=rf"{name} of 'hertz'"):
            module_text(replace(of, formulas=formulas), "hertz.py")


FALSE: dict[str, Callable[[Expr], Expr]] = {
    "another sign": lambda expr: -expr,
    "wrong in the sixth digit": lambda expr: expr * (1 + Rational(1, 10**6)),
    "wrong for a > c only": lambda expr: Piecewise((2 * expr, a > c), (expr, True)),
    "wrong for a < c only": lambda expr: Piecewise((2 * expr, a < c), (expr, True)),
    "zero": lambda expr: 0 * expr,
}
OF_AN_INVERSE = ("another sign", "wrong in the sixth digit", "zero")


@pytest.mark.parametrize(
    ("body", "name", "field", "changes"),
    [
        *(("hertz", "K_N", "right", FALSE), ("wedge", "tilt", "", FALSE)),
        *(("wedge", "pressure", "", FALSE), ("flat_rounded", "moment", "", FALSE)),
        *(("wedge", "contact", field, OF_AN_INVERSE) for field in ("a", "c", "alpha")),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_a_rewritten_form_that_is_false_is_not_written(
    body: str, name: str, field: str, changes: Iterable[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    true, of = FunctionText._made, assumed(sheet(body))
    for what in changes:

        def falsified(self: FunctionText, change: Callable[[Expr], Expr] = FALSE[what]) -> Program:
            program = true(self)
            outputs = dict(program.outputs)
            if self.function.name == name:
                outputs[field] = change(outputs[field])
            return replace(program, outputs=outputs)

        monkeypatch.setattr(FunctionText, "_made", falsified)
        with pytest.raises(NotProven, match=f"of '{body}': the generated code returned"):
            demand_right(of, module_text(of, f"{body}.py"), STUCK)


def test_a_tangent_of_a_parameter_is_a_number() -> None:
    """Also under a tilt, where the edges hold the tangent of the kink's angle as well."""
    phi = parameter("phi", "an angle", unit="rad")
    of = assumed(derive_sheet(Geometry("steep", g=tan(phi / 2) * Abs(x))))
    demand_right(of, module_text(of, "steep.py"), STUCK)


# ------------------------------------------------------------------ header and docstrings


def parsed(text: str) -> ast.Module:
    """Without a warning."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        return ast.parse(text)


WORDS = (
    *("Balls & springs: α ≤ φ, 100 %", 'He called it "round"', "one\nand two lines"),
    *(r"Profile with \alpha, \rho, \nu and \x in it", "{braces} and {0} and %s"),
    *("Three quotes " + '"""' + " and three " + "'''", "goes on and on " * 9),
    "Ends in a backslash\\",
)


def test_any_title_and_any_meaning_is_kept_word_by_word() -> None:
    """All but the first letter, which may become a capital; a title and a meaning of each."""
    lengths = [parameter(f"R_{i}", said) for i, said in enumerate(WORDS)]
    body = Geometry("body", g=x**2 / sum(lengths)).described(words(" ".join(WORDS)))
    text = module_text(assumed(derive_sheet(body)), "body.py")
    tree = parsed(text)
    with module_of(text) as module:
        for docstring in (module.__doc__, module.load.__doc__, module.stick_zone.__doc__):
            assert all(words(said)[1:] in words(str(docstring)) for said in WORDS)
    assert words(str(ast.get_docstring(tree))).startswith(words(" ".join(WORDS)))


OF_MATHEMATICS = {"Abs", "Max", "Min", "Piecewise", "True", "pi"}
OF_MATHEMATICS |= {"atan2", "cos", "log", "sin", "sqrt", "tan"}


def equations(docstring: str) -> dict[str, tuple[set[str], str]]:
    """Of each that a docstring prints, by its name: letters of its own, and its right side."""
    found = {}
    for line in re.findall(r"^ {4}(\w+(?:\(.*?\))? = .*(?:\n {8}.*)*)", docstring, re.MULTILINE):
        left, right = words(line).split(" = ", 1)
        name, _, letters = left.rstrip(")").partition("(")
        found[name] = ({*letters.split(", ")}, right)
    return found


@pytest.mark.parametrize("body", ["flat_rounded", "rounded_wedge", "wedge_parabola", "wedge"])
def test_every_symbol_that_a_docstring_prints_is_defined_there_or_in_the_module(body: str) -> None:
    """In the docstring of the module only what the function names as defined there."""
    tree = ast.parse((GENERATED / f"{body}.py").read_text(encoding="utf-8"))
    named = {n.name: n for n in tree.body if isinstance(n, ast.FunctionDef)}
    common = equations(str(ast.get_docstring(tree)))
    for node in (named[name] for name in ("tilt", "load", "moment", "pressure", "K_N", "L_N")):
        docstring = str(ast.get_docstring(node))
        own = equations(docstring)
        assert own, node.name
        referred = re.search(r"^ {4}([\w, ]+): see the docstring of the\s+module$", docstring, re.M)
        there = {*referred[1].split(", ")} if referred else set()
        assert there <= {*common}, node.name
        own |= {name: common[name] for name in there}
        arguments = {argument.arg for argument in (*node.args.args, *node.args.kwonlyargs)}
        known = {*own, *arguments, *OF_MATHEMATICS}
        for letters, right in own.values():
            assert {*re.findall(r"[A-Za-z]\w*", right)} <= known | letters, node.name


# ------------------------------------------------------------------ names


def names_in(body: str) -> set[str]:
    """Every name that a generated module binds, and that a parameter may bear."""
    tree = ast.parse((GENERATED / f"{body}.py").read_text())
    stored = {n.id for n in ast.walk(tree) if isinstance(n, ast.Name) and n.id.isidentifier()}
    bound = {a.asname or a.name for n in ast.walk(tree) if isinstance(n, ast.alias) for a in (n,)}
    own = {q.name for q in load_geometry(body).parameters}
    return {name for name in stored | bound if not name.startswith("_")} - RESERVED - own


def may_be_a_parameter(name: str) -> bool:
    try:
        return bool(parameter(name, "anything"))
    except BadName:
        return False


def test_parameters_may_bear_the_names_of_local_variables() -> None:
    """A cylinder whose radius is a product of parameters of every such name."""
    first, *others = names = sorted(filter(may_be_a_parameter, names_in("hertz")))
    radius = parameter(first, "a factor", unit="m")
    for name in others:
        radius *= parameter(name, "a factor", unit="-")
    with within(60):
        text = text_of_body(x**2 / (2 * radius))
    factors = dict.fromkeys(names, 1.0) | {first: 0.5}
    with module_of(text) as module:
        for function, given in (
            *(("contact", (2.0, 0.25)), ("contact_at_tilt", (2.0, 0.125))),
            *(("pressure", (0.25, 2.0, 1.0)), ("load", (2.0, 1.0))),
            *(("K_N", (2.0, 1.0)), ("L_N", (2.0, 1.0))),
        ):
            got = getattr(module, function)(*given, E_star=1.25, **factors)
            wanted = getattr(hertz, function)(*given, E_star=1.25, R=0.5)
            assert np.allclose(got, wanted, rtol=1e-14, atol=0), function


# ------------------------------------------------------------------ right


def test_an_example_lies_between_a_kink_and_the_end_of_the_body() -> None:
    """A flat base, its edges rounded by quarters of a circle."""
    flat = 3
    R, b = parameter("R", "a radius", unit="m"), parameter("b", "half the base", unit="m")
    g = R - sqrt(R**2 - Max(0, Abs(x) - flat * b) ** 2)
    of = assumed(derive_sheet(Geometry("base", g=g)))
    point = example_of(of, of["pressure"].conditions)
    radius, kink = point[Symbol("R", positive=True)], flat * point[Symbol("b", positive=True)]
    assert kink < max(point[a], point[c]) < kink + radius


L, width = (parameter(name, "a length", unit="m") for name in ("L", "b"))


@pytest.mark.usefixtures("short_docstrings")
@pytest.mark.enough("b*exp*")
@pytest.mark.parametrize("g", [10**24 * x**4 / L**3, width * exp(exp(x / width))], ids=str)
def test_a_steep_body_is_tried_where_float64_holds_it(g: Expr) -> None:
    """Of the first float64 holds alpha, some 1e24, to 1e8; the second carries 1e572 N/m on a
    contact of some ten b, and most are narrower."""
    of = assumed(derive_sheet(Geometry("steep", g=g)))
    demand_right(of, module_text(of, "steep.py"), STUCK)


def test_a_body_that_float64_does_not_hold_is_told_so() -> None:
    of = assumed(derive_sheet(Geometry("wall", g=10**200 * x**2 / width)))
    with pytest.raises(NotProven, match=r"below 1e\+150 at only 0 of 8 .* rises less steeply$"):
        demand_right(of, module_text(of, "wall.py"), STUCK)


@pytest.mark.usefixtures("short_docstrings")
def test_a_body_convex_for_some_parameters_gives_nothing_for_the_others() -> None:
    """g'' = 12 x^2/L^3 - 6 x/(10 L^2) + 2/R is nowhere negative where 3 R <= 800 L."""
    R = parameter("R", "a radius", unit="m")
    calls: dict[str, tuple[float, ...]] = {
        **{"contact": (1.0, 0.0), "contact_at_tilt": (1.0, 0.0), "pressure": (0.1, 0.5, 0.5)},
        **dict.fromkeys(("load", "moment", "K_N", "L_N"), (0.5, 0.5)),
    }
    with module_of(text_of_body(x**4 / L**3 - x**3 / (10 * L**2) + x**2 / R)) as module:
        for name, given in calls.items():
            function = getattr(module, name)
            for radius, exists in ((1.0, True), (266.0, True), (267.0, False), (1e5, False)):
                result = np.array(function(*given, E_star=1.0, L=1.0, R=radius))
                assert np.all(np.isnan(result) != exists), (name, radius)
        assert "are positive, L >= 3*R/800 and" in words(module.__doc__)


# ------------------------------------------------------------------ bodies that stand only leaning


@pytest.mark.thorough
def test_a_corner_both_of_whose_flanks_rise_to_one_side() -> None:
    """Flanks of slopes psi and psi + phi: it closes at tilts from -psi - phi to -psi alone.

    A corner whose slope jumps by phi is half of a wedge: P = E* (phi/2) sqrt(a c).  At a = c half
    of the angle lies on either side, so that alpha = -(psi + phi/2), and a = c = 2 P/(E* phi).
    """
    phi = parameter("phi", "rise of the slope at the corner", unit="rad")
    psi = parameter("psi", "slope of the left flank", unit="rad")
    of = derive_sheet(Geometry("leaning", g=psi * x + phi * Max(0, x)))
    for formula in of.formulas.values():
        if formula.name.startswith("contact"):
            assert len(list(loads(of, formula))) == POINTS, formula.name
    given = {"E_star": 2.0, "phi": 0.25, "psi": 0.5}
    with module_of(module_text(assumed(of), "leaning.py")) as module:
        a, c, alpha = module.contact(3.0, 0.0, **given)
        assert [a, c, alpha] == pytest.approx([12.0, 12.0, -0.625], rel=1e-14)
        a, c, _ = module.contact_at_tilt(3.0, -0.625, **given)
        assert [a, c] == pytest.approx([12.0, 12.0], rel=1e-14)
        tilts = np.array([-0.76, -0.75, -0.5, -0.49, 0.0, 0.2])
        assert np.isnan(module.contact_at_tilt(3.0, tilts, **given).a).all()
        assert np.isfinite(module.contact_at_tilt(3.0, np.array([-0.749, -0.501]), **given).a).all()
