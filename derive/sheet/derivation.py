"""From a body to its formula sheet: the stages of the theory in order; each formula has a source.

In:  Geometry.
Out: FormulaSheet without proofs.
"""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace

from sympy import Expr, Symbol, pi, sqrt
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
from derive.theory import contact_law, slip, stick, superposition
from derive.theory.algebra import tidy
from derive.theory.closed_forms import NoRule, closed_forms
from derive.theory.edges import Edge, contact_formula, pressure_series
from derive.theory.frame import Frame
from derive.theory.parts import has_parts, parts_of

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
    """Derive load, moment and tilt, and the contact from the loads where a formula exists; of a
    body whose formulas are integrals, all that may have a closed form."""
    return _derived(geometry, _LAW if geometry.slope.is_polynomial else _INTEGRALS)


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
    names = [f"{name}_{edge.name.lower()}" for name in ("K_N", "L_N")]
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


def _loads(sheet: FormulaSheet) -> Iterator[Formula]:
    conditions = contact_conditions(sheet.frame)
    for name, symbol, meaning, unit, route in (
        ("tilt", alpha, "tilt of this contact", "rad", "I_0 = 0"),
        ("load", P, "normal load", "N/m", "P = (E*/2) I_1"),
        ("moment", M, "moment", "N", "M = -(E*/2) (I_2 - mid I_1)"),
    ):
        expr, source = _of_contact(sheet, name, f"{route}; {_CLASSIC}")
        yield Formula(name, symbol, (a, c), expr, meaning, unit, source, conditions)


def _pressure(sheet: FormulaSheet) -> Iterator[Formula]:
    expr, source = _of_contact(sheet, "pressure", _CLASSIC)
    inside, p = inside_contact(sheet.frame, x), Symbol("p")
    yield Formula("pressure", p, (x, a, c), expr, "contact pressure", "Pa", source, inside)


def _edges(sheet: FormulaSheet) -> Iterator[Formula]:
    conditions = contact_conditions(sheet.frame)
    expanded = f"expansion of p(x); cf. eqs. (8), (9), {_PAPER}"
    for stem, power, unit in (("K_N", "sqrt(s)", "Pa/sqrt(m)"), ("L_N", "s**(3/2)", "Pa/m**(3/2)")):
        for side in _SIDES:
            name, meaning = f"{stem}_{side}", f"coefficient of {power} in p at the {side} edge"
            expr, source = _of_contact(sheet, name, expanded)
            yield Formula(name, Symbol(name), (a, c), expr, meaning, unit, source, conditions)


def _of_contact(sheet: FormulaSheet, name: str, closed: str) -> tuple[Expr, str]:
    """A formula and its source: `closed`, or that of an integral if g' is not a polynomial."""
    frame = sheet.frame
    if frame.slope.is_polynomial:
        return contact_formula(frame, name), closed
    integral = superposition.formulas(frame.kinks)[name]
    return superposition.by_pieces(integral, frame.slope), f"superposition of wedges; {_CLASSIC}"


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


def _rates(sheet: FormulaSheet) -> Iterator[Formula]:
    """Rates of the loads and the tilt as one edge moves: for any body, those of a flat punch."""
    conditions = contact_conditions(sheet.frame)
    source = "a moving edge adds sqrt((a + x)/(c - x)), or its mirror image, to the pressure"
    for side, edge, sense in zip(_SIDES, (a, c), (-1, 1), strict=True):
        force = pi * sqrt(h) / 4 * sheet[f"K_N_{side}"].expr
        for of, unit, rate in (
            ("load", "Pa", force),
            ("moment", "N/m", -force * (mid + sense * h / 4)),
            ("tilt", "1/m", -sense * 4 * force / (pi * E_star * h)),
        ):
            name, symbol = f"{of}_by_{edge}", Symbol(f"{sheet[of].symbol}_{edge}")
            meaning, expr = f"rate of change of the {of} with {edge} alone", tidy(rate, sheet.frame)
            yield Formula(name, symbol, (a, c), expr, meaning, unit, source, conditions)


def _stick(sheet: FormulaSheet) -> Iterator[Formula]:
    always, sheared = (h > 0,), (a, c, dQ, dsigma)
    change, inside = stick.full_stick_change(), (*always, x > -a, x < c)
    meaning = "change in the shear traction under full stick"
    source = "similar bodies, full stick: (1/pi) PV int dq/(x - xi) dxi = dsigma/4, int dq = dQ"
    name, dq = "full_stick_change", Symbol("dq")
    yield Formula(name, dq, (x, *sheared), change, meaning, "Pa", source, inside)
    expanded = f"expansion of full_stick_change; cf. eq. (32), {_PAPER}"
    moving = "an edge that moves by d leaves dq = 2 K_T sqrt(s)/d; stick needs |dq| < f K_N sqrt(s)"
    in_series = "coefficient of {} in the full-stick change at the {{}} edge".format
    margin = "margin against slip at the {} edge as all loads begin to change"
    loads = (a, c, dP, dM, dQ, dsigma)
    for name, derive, words, unit, source, arguments, letter in (
        ("K_T", stick.K_T, in_series("1/sqrt(s)"), "Pa*sqrt(m)", expanded, sheared, "K_T"),
        ("L_T", stick.L_T, in_series("sqrt(s)"), "Pa/sqrt(m)", expanded, sheared, "L_T"),
        ("stick_margin", stick.stick_margin, margin, "N/m", moving, loads, "S"),
    ):
        for edge, side in zip(Edge, _SIDES, strict=True):
            symbol, meaning = Symbol(f"{letter}_{side}"), words.format(side)
            expr, key = derive(edge), f"{name}_{side}"
            yield Formula(key, symbol, arguments, expr, meaning, unit, source, always)


def _slip(sheet: FormulaSheet) -> Iterator[Formula]:
    conditions = contact_conditions(sheet.frame)
    source = f"dq bounded at both ends of the stick zone, first order; cf. {_PAPER}, section 3"
    for edge, side in zip(Edge, _SIDES, strict=True):
        zone = slip.slip_zone(stick.pull(edge), sheet[f"K_N_{side}"].expr)
        meaning = f"slip zone at the {side} edge under constant normal load, to first order"
        symbol, arguments = Symbol(f"d_{side}"), (a, c, dQ, dsigma)
        yield Formula(f"slip_{side}", symbol, arguments, zone, meaning, "m", source, conditions)


def _inverses(sheet: FormulaSheet) -> Iterator[Formula]:
    tilt, load, moment = (sheet[name].expr for name in ("tilt", "load", "moment"))
    for name, given, invert, conditions in (
        ("contact", M, contact_law.contact_from_moment, load_conditions),
        ("contact_at_tilt", alpha, contact_law.contact_from_tilt, tilt_conditions),
    ):
        found = invert(sheet.frame, tilt, load, moment)
        if found is None:
            continue
        source = "inverse of load(a, c), moment(a, c) and tilt(a, c)"
        loads = f"load and {'moment' if given == M else 'tilt'}"
        for symbol, words, unit in (
            *((a, "left edge", "m"), (c, "right edge", "m")),
            *((alpha, "tilt", "rad"), (M, "moment", "N")),
        ):
            if symbol != given:
                expr, meaning = getattr(found, symbol.name), f"{words} from {loads}"
                held = conditions(sheet.frame)
                key, arguments = f"{name}_{symbol}", (P, given)
                yield Formula(key, symbol, arguments, expr, meaning, unit, source, held)


def _moderate(sheet: FormulaSheet) -> Iterator[Formula]:
    """The stick zone as a contact patch, if contact_at_tilt is a formula."""
    if "contact_at_tilt_a" not in sheet:
        return
    source = "f (p1 + p2) minus 2 f times the pressure of a contact patch of the same body"
    for symbol, edge, side in zip((m, n), (a, c), _SIDES, strict=True):
        inverse = sheet[f"contact_at_tilt_{edge}"]
        conditions = tuple(map(stick.moderate, inverse.conditions))
        meaning = f"{side} end of the stick zone under moderate tension; P, alpha: cycle means"
        expr, arguments = stick.moderate(inverse.expr), (P, alpha, dQ, dsigma)
        yield Formula(f"stick_{symbol}", symbol, arguments, expr, meaning, "m", source, conditions)


_SIDES = ("left", "right")
"""The edges in the order of Edge, as names contain them."""

_CLOSED = (
    *(_loads, _pressure, _edges, _contact_law, _rates),
    *(_stick, _slip, _inverses, _moderate),
)
"""Stages for a body whose integrals are elementary."""

_LAW = (_loads, _inverses)
"""Stages of the contact law alone."""

_INTEGRALS = (_loads, _pressure, _edges)
_SUPERPOSED = (*_INTEGRALS, _stick, _slip)
"""Stages for any other body."""
