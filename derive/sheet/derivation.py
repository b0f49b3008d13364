"""From a body to its formula sheet: the stages of the theory in order; each formula has a source.

In:  Geometry.
Out: FormulaSheet without proofs.
"""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from functools import partial
from types import ModuleType

from sympy import Expr, Symbol, pi, sqrt
from sympy.logic.boolalg import Boolean
from sympy.polys.polyerrors import BasePolynomialError

from derive.body.geometry import Geometry
from derive.command.limit import DEFAULT, LimitReached, within
from derive.reading.units import NUMBER, check, dimension_of
from derive.sheet.formulas import (
    Formula,
    FormulaSheet,
    contact_conditions,
    inside_contact,
    load_conditions,
    tilt_conditions,
)
from derive.symbols import E_star, M, P, a, alpha, c, dM, dP, dQ, dsigma, f, h, m, mid, n, x
from derive.theory import contact_law, equilibrium, slip, stick, superposition
from derive.theory.algebra import tidy
from derive.theory.closed_forms import NoRule, closed_forms
from derive.theory.edges import Edge, pressure_series
from derive.theory.frame import Frame
from derive.theory.parts import has_parts, parts_of
from derive.theory.pressure import pressure

Stage = Callable[[FormulaSheet], Iterator[Formula]]
"""Function that derives formulas from those already on a sheet."""

_PAPER = "Andresen, Fleury, Moore & Hills 2020"
_CLASSIC = "singular integral equation of the half-plane, pressure bounded at both edges"


def derive_sheet(geometry: Geometry) -> FormulaSheet:
    """Derive all formulas that the theory provides for one body; nothing is proven yet.

    Parameters
    ----------
    geometry : Geometry
        The body.

    Returns
    -------
    FormulaSheet
        The formulas by name, with their meanings, units, conditions and sources.

    Examples
    --------
    >>> from derive.body.library import load_geometry
    >>> sheet = derive_sheet(load_geometry("wedge"))
    >>> sheet.flat("load")
    E_star*phi*sqrt(a*c)
    """
    return _by_parts(_derived(geometry, _CLOSED if geometry.slope.is_polynomial else _SUPERPOSED))


def derive_law(geometry: Geometry) -> FormulaSheet:
    """Derive load, moment and tilt, and the contact from the loads where a formula exists."""
    return _derived(geometry, _LAW if geometry.slope.is_polynomial else (_superposed,))


def with_closed_forms(sheet: FormulaSheet, seconds: float = DEFAULT) -> FormulaSheet:
    """Add the closed forms of the integrals, if the rules find them in time.

    Each closed form follows its integral, under a name such as load_closed, and the sheet's remark
    states the result.  A body whose formulas are already closed is returned unchanged.

    >>> from derive.body.library import load_geometry
    >>> sheet = with_closed_forms(derive_sheet(load_geometry("catenary")))
    >>> sheet["load_closed"].expr
    pi*E_star*b*(a + c)*cosh((a - c)/(2*b))*besseli(1, (a + c)/(2*b))/(4*R)
    """
    if sheet.geometry.slope.is_polynomial:
        return sheet
    try:
        with within(seconds) as look:
            found = closed_forms(sheet.frame, look)
    except LimitReached:
        return replace(sheet, remark=f"{NONE_IN_TIME} {seconds:g} s; {_REMAIN}")
    except NoRule as without:
        remark = f"No closed form known: no rule for {without}; {_REMAIN}"
        return replace(sheet, remark=remark)
    except _SYMPY_GAVE_UP:
        return replace(sheet, remark=f"No closed form found: SymPy failed; {_REMAIN}")
    for name, expr in found.items():
        integral = sheet[name]
        sheet = sheet.plus(
            replace(
                integral,
                name=f"{name}_closed",
                expr=expr,
                meaning=f"{integral.meaning}, closed form",
                source=f"{_RULES}; {_CLASSIC}",
                closes=name,
            )
        )
    return replace(sheet, remark=_FOUND)


_SYMPY_GAVE_UP = (
    *(ArithmeticError, AttributeError, NotImplementedError, RecursionError, TypeError, ValueError),
    BasePolynomialError,
)
"""Exceptions that SymPy raises for expressions that it cannot handle."""

NONE_IN_TIME = "No closed form found within"
"""Start of the remark if the search for closed forms reached its time limit."""

_REMAIN = "the formulas remain integrals."

_FOUND = (
    "Each closed form follows its integral, for example load_closed follows load.  Generated code "
    "evaluates the integrals, because the closed forms lose digits in float64."
)

_RULES = "int g' cos(n theta) dtheta, x = mid + (h/2) cos(theta), term by term"


def slip_series(
    sheet: FormulaSheet, order: int
) -> tuple[dict[Edge, tuple[Expr, ...]], dict[Symbol, Expr]]:
    """Terms of order 1, 2, ... of both slip zones under constant loads; each zone is their sum.

    Returns the terms, written with ratios, and the definition of every symbol in them in terms of
    the body's parameters.

    Raises ValueError for an order below 1, or for one above the highest known order of a body whose
    formulas are integrals.

    >>> from derive.body.library import load_geometry
    >>> terms, known = slip_series(derive_sheet(load_geometry("wedge")), 1)
    >>> terms[Edge.RIGHT]
    (D_right,)
    >>> known[terms[Edge.RIGHT][0]]
    K_T_right/(K_N_right*f*kappa_right)
    """
    if order < 1:
        raise ValueError(f"the order of a series must be at least 1; got {order}")
    ratios: dict[Symbol, Expr] = {}
    values: dict[Symbol, Expr] = {}
    pressed = []
    for edge, first, sense in zip(Edge, (slip.D_left, slip.D_right), slip.senses, strict=True):
        side, stuck = edge.name.lower(), slip.stuck_edge(edge)
        names = [*("K_N", "L_N"), *(f"C_{k}" for k in range(2, order))][:order]
        symbols = [Symbol(f"{name}_{side}", positive=True) for name in names]
        values[stuck] = sheet[f"K_T_{side}"].expr
        values |= dict(zip(symbols, _pressure_terms(sheet, edge, order), strict=True))
        ratios[first] = stuck / (f * sense * symbols[0])
        over = (symbol / symbols[0] for symbol in symbols[1:])
        ratios |= dict(zip(slip.ratios(side, order), over, strict=True))
        pressed.append(symbols[0] * sense)
    ratios |= {slip.rho: pressed[1] / pressed[0], slip.width: h}
    terms = dict(zip(Edge, slip.terms(order), strict=True))
    held = set().union(*(term.free_symbols for found in terms.values() for term in found))
    shown = {symbol: value for symbol, value in ratios.items() if symbol in held}
    own = {p.name for p in sheet.geometry.parameters}
    ours = {s: Symbol(f"{s}_ratio", positive=True) for s in shown if s.name in own}
    terms = {edge: tuple(t.xreplace(ours) for t in found) for edge, found in terms.items()}
    shown = {ours.get(symbol, symbol): value for symbol, value in shown.items()}
    return terms, shown | {s: sheet.frame.flat(value) for s, value in values.items()}


def _pressure_terms(sheet: FormulaSheet, edge: Edge, order: int) -> list[Expr]:
    """K_N, L_N, ... of a body; if its formulas are integrals, L_N is the last one known."""
    if sheet.geometry.slope.is_polynomial:
        return pressure_series(sheet.frame, edge, order)
    names = [f"{name}_{edge.name.lower()}" for name, *_ in _EDGE_COEFFICIENTS]
    if order > len(names):
        known = f"the highest known order for {sheet.geometry.name!r} is {len(names)}"
        raise ValueError(f"{known}; got {order}")
    return [sheet[name].expr for name in names[:order]]


def _derived(geometry: Geometry, stages: Iterable[Stage]) -> FormulaSheet:
    sheet = FormulaSheet(geometry, Frame(geometry.slope))
    for stage in stages:
        for formula in stage(sheet):
            sheet = sheet.plus(formula)
    return sheet


def _by_parts(sheet: FormulaSheet) -> FormulaSheet:
    """Add sums over the parts of a contact to formulas that lose digits near kinks."""
    if not has_parts(sheet.frame):
        return sheet
    parts, known = parts_of(sheet.frame), dict(sheet.dimensions)
    for d in parts.definitions:
        known[d.symbol] = dimension_of(d.expr, known) or NUMBER
    formulas = dict(sheet.formulas)
    for name in formulas.keys() & parts.formulas.keys():
        formula, computed = formulas[name], parts.formulas[name]
        check(computed, formula.unit, f"{name} of {sheet.geometry.name!r}, part by part", known)
        formulas[name] = replace(formula, computed=computed)
    return replace(sheet, formulas=formulas)


def _superposed(sheet: FormulaSheet) -> Iterator[Formula]:
    """Loads, tilt, pressure and edge coefficients of any profile, as integrals of its curvature."""
    frame, source = sheet.frame, f"superposition of wedges; {_CLASSIC}"
    yield from _loads(frame, superposition, source, source, source)
    yield _pressure_formula(frame, superposition.pressure(frame), source)
    for name, at_edge, unit, meaning in _EDGE_COEFFICIENTS:
        derive = partial(at_edge, frame)
        yield from _at_both_edges(name, derive, meaning, unit, source, contact_conditions(frame))


def _equilibrium(sheet: FormulaSheet) -> Iterator[Formula]:
    sources = "I_0 = 0", "P = (E*/2) I_1", "M = -(E*/2) (I_2 - mid I_1)"
    yield from _loads(sheet.frame, equilibrium, *(f"{source}; {_CLASSIC}" for source in sources))


def _loads(frame: Frame, theory: ModuleType, *sources: str) -> Iterator[Formula]:
    """Tilt, load and moment by the functions of these names in a module of the theory."""
    conditions = contact_conditions(frame)
    rows = (
        ("tilt", alpha, "tilt of this contact", "rad"),
        ("load", P, "normal load", "N/m"),
        ("moment", M, "moment", "N"),
    )
    for (name, symbol, meaning, unit), source in zip(rows, sources, strict=True):
        expr = getattr(theory, name)(frame)
        yield Formula(name, symbol, (a, c), expr, meaning, unit, source, conditions)


def _pressure(sheet: FormulaSheet) -> Iterator[Formula]:
    yield _pressure_formula(sheet.frame, pressure(sheet.frame), _CLASSIC)


def _pressure_formula(frame: Frame, expr: Expr, source: str) -> Formula:
    inside, p = inside_contact(frame, x), Symbol("p")
    return Formula("pressure", p, (x, a, c), expr, "contact pressure", "Pa", source, inside)


def _contact_law(sheet: FormulaSheet) -> Iterator[Formula]:
    """a'(c) and P'(c) from K_N: at fixed tilt the pressure grows by that of a flat punch."""
    conditions = contact_conditions(sheet.frame)
    right = sheet["K_N_right"].expr
    ratio, rate = right / sheet["K_N_left"].expr, pi / 2 * sqrt(h) * right
    for name, symbol, expr, meaning, unit, source in (
        ("edge_ratio", "a_prime", ratio, "a'(c), derivative of a at fixed tilt", "-", ""),
        ("load_rate", "P_prime", rate, "P'(c), derivative of P at fixed tilt", "Pa", ""),
        ("punch", "F", rate / pi, "weight of the flat punches", "Pa", "eq. (7), "),
    ):
        source = f"Mossakovskii's method; {source}{_PAPER}, section 2"
        yield Formula(name, Symbol(symbol), (a, c), expr, meaning, unit, source, conditions)


def _edges(sheet: FormulaSheet) -> Iterator[Formula]:
    conditions = contact_conditions(sheet.frame)
    series = {edge: pressure_series(sheet.frame, edge, 2) for edge in Edge}
    source = f"expansion of p(x); cf. eqs. (8), (9), {_PAPER}"
    for order, (name, _, unit, meaning) in enumerate(_EDGE_COEFFICIENTS):
        terms = {edge: series[edge][order] for edge in Edge}
        yield from _at_both_edges(name, terms.__getitem__, meaning, unit, source, conditions)


_EDGE_COEFFICIENTS = (
    (
        *("K_N", superposition.edge_coefficient, "Pa/sqrt(m)"),
        "coefficient of sqrt(s) in p at the {} edge",
    ),
    (
        *("L_N", superposition.second_coefficient, "Pa/m**(3/2)"),
        "coefficient of s**(3/2) in p at the {} edge",
    ),
)


def _at_both_edges(
    name: str,
    derive: Callable[[Edge], Expr],
    meaning: str,
    unit: str,
    source: str,
    conditions: tuple[Boolean, ...],
    arguments: tuple[Symbol, ...] = (a, c),
    letter: str = "",
) -> Iterator[Formula]:
    """A formula for each edge; `meaning` has {} in the place of its side."""
    for edge in Edge:
        side = edge.name.lower()
        symbol, words = Symbol(f"{letter or name}_{side}"), meaning.format(side)
        expr = derive(edge)
        yield Formula(f"{name}_{side}", symbol, arguments, expr, words, unit, source, conditions)


def _rates(sheet: FormulaSheet) -> Iterator[Formula]:
    """Rates of the loads and the tilt as one edge moves: for any body, those of a flat punch."""
    conditions = contact_conditions(sheet.frame)
    source = "a moving edge adds sqrt((a + x)/(c - x)), or its mirror image, to the pressure"
    for edge, symbol, sense in ((Edge.LEFT, a, -1), (Edge.RIGHT, c, 1)):
        force = pi * sqrt(h) / 4 * sheet[f"K_N_{edge.name.lower()}"].expr
        for of, meaning, unit, expr in (
            ("load", "load", "Pa", force),
            ("moment", "moment", "N/m", -force * (mid + sense * h / 4)),
            ("tilt", "tilt", "1/m", -sense * 4 * force / (pi * E_star * h)),
        ):
            yield Formula(
                f"{of}_by_{symbol}",
                Symbol(f"{sheet[of].symbol}_{symbol}"),
                (a, c),
                tidy(expr, sheet.frame),
                f"rate of change of the {meaning} with {symbol} alone",
                unit,
                source,
                conditions,
            )


def _stick(sheet: FormulaSheet) -> Iterator[Formula]:
    source = "similar bodies, full stick: (1/pi) PV int dq/(x - xi) dxi = dsigma/4, int dq = dQ"
    conditions = contact_conditions(sheet.frame)[:1]
    inside = (*conditions, x > -a, x < c)
    arguments = (a, c, dQ, dsigma)
    yield Formula(
        "full_stick_change",
        Symbol("dq"),
        (x, *arguments),
        stick.full_stick_change(),
        "change in the shear traction under full stick",
        "Pa",
        source,
        inside,
    )
    expanded = f"expansion of full_stick_change; cf. eq. (32), {_PAPER}"
    coefficient = "coefficient of 1/sqrt(s) in the full-stick change at the {} edge"
    yield from _at_both_edges(
        "K_T", stick.K_T, coefficient, "Pa*sqrt(m)", expanded, conditions, arguments
    )
    coefficient = coefficient.replace("1/sqrt(s)", "sqrt(s)")
    yield from _at_both_edges(
        "L_T", stick.L_T, coefficient, "Pa/sqrt(m)", expanded, conditions, arguments
    )
    yield from _at_both_edges(
        "stick_margin",
        stick.stick_margin,
        "margin against slip at the {} edge as all loads begin to change",
        "N/m",
        "an edge that moves by d leaves dq = 2 K_T sqrt(s)/d; stick needs |dq| < f K_N sqrt(s)",
        conditions,
        (a, c, dP, dM, dQ, dsigma),
        "S",
    )


def _slip(sheet: FormulaSheet) -> Iterator[Formula]:
    def zone(edge: Edge) -> Expr:
        return slip.slip_zone(stick.pull(edge), sheet[f"K_N_{edge.name.lower()}"].expr)

    yield from _at_both_edges(
        "slip",
        zone,
        "slip zone at the {} edge under constant normal load, to first order",
        "m",
        f"dq bounded at both ends of the stick zone, first order; cf. {_PAPER}, section 3",
        contact_conditions(sheet.frame),
        (a, c, dQ, dsigma),
        "d",
    )


def _moderate(sheet: FormulaSheet) -> Iterator[Formula]:
    """The stick zone as a contact patch, if contact_at_tilt is a formula."""
    if "contact_at_tilt_a" not in sheet:
        return
    for symbol, edge, side in ((m, "a", "left"), (n, "c", "right")):
        inverse = sheet[f"contact_at_tilt_{edge}"]
        yield Formula(
            f"stick_{symbol}",
            symbol,
            (P, alpha, dQ, dsigma),
            stick.moderate(inverse.expr),
            f"{side} end of the stick zone under moderate tension; P, alpha: cycle means",
            "m",
            "f (p1 + p2) minus 2 f times the pressure of a contact patch of the same body",
            tuple(stick.moderate(condition) for condition in inverse.conditions),
        )


def _inverses(sheet: FormulaSheet) -> Iterator[Formula]:
    tilt, load, moment = (sheet[name].expr for name in ("tilt", "load", "moment"))
    at_moment = contact_law.contact_from_moment(sheet.frame, tilt, load, moment)
    if at_moment is not None:
        yield from _inverse("contact", (P, M), at_moment, load_conditions(sheet.frame))
    at_tilt = contact_law.contact_from_tilt(sheet.frame, tilt, load, moment)
    if at_tilt is not None:
        yield from _inverse("contact_at_tilt", (P, alpha), at_tilt, tilt_conditions(sheet.frame))


def _inverse(
    name: str,
    given: tuple[Symbol, ...],
    found: contact_law.Inverse,
    conditions: tuple[Boolean, ...],
) -> Iterator[Formula]:
    loads = " and ".join({P: "load", M: "moment", alpha: "tilt"}[symbol] for symbol in given)
    for symbol, expr, meaning, unit in (
        (a, found.a, "left edge", "m"),
        (c, found.c, "right edge", "m"),
        (alpha, found.alpha, "tilt", "rad"),
        (M, found.M, "moment", "N"),
    ):
        if symbol not in given:
            yield Formula(
                f"{name}_{symbol}",
                symbol,
                given,
                expr,
                f"{meaning} from {loads}",
                unit,
                "inverse of load(a, c), moment(a, c) and tilt(a, c)",
                conditions,
            )


_CLOSED = (
    *(_equilibrium, _pressure, _edges, _contact_law, _rates),
    *(_stick, _slip, _inverses, _moderate),
)
"""Stages for a body whose integrals are elementary."""

_LAW = (_equilibrium, _inverses)
"""Stages of the contact law alone."""

_SUPERPOSED = (_superposed, _stick, _slip)
"""Stages for any other body."""
