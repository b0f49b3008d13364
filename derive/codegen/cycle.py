"""Functions of a whole cycle: the stick zone, slip, the change of shear, the march through time.

In:  a proven FormulaSheet.
Out: the text of `_LAW`, the body's functions that a cycle is made of, and of the functions that
     hand it to support/_stick.py, _slip.py, _shear.py and _march.py.

What they compute is the same for every body; what differs is its law.
"""

import textwrap
from collections.abc import Iterator
from dataclasses import dataclass

import mpmath
from mpmath import mpf
from sympy import Symbol

from derive.codegen.function import LINE, example_of, inside_quotes, own_parameters
from derive.codegen.integrated import breaks_text, is_mended, keeps_its_digits
from derive.codegen.parabolas import is_parabolic
from derive.codegen.third import NAME as THIRD
from derive.codegen.third import has_third, smooth_cuts
from derive.proof.points import Point, numeric
from derive.sheet import FormulaSheet
from derive.symbols import E_star, M, P, a, c, dQ, dsigma, f, x


@dataclass(frozen=True)
class CycleFunction:
    """One function of a cycle.

    arguments   what it takes by position: symbols, or names of those that are none
    summary     what it gives
    equations   what it computes
    returns     its result with units
    unless      when it is NaN, besides what holds for all
    kind        the named tuple that it returns, "" for a plain array
    optional    keyword-only arguments behind the body's own, with their defaults
    meanings    of arguments that mean something else here than elsewhere
    beyond      loads under which nothing is known
    by_differences  where else it is not, of bodies without a formula for the third coefficient
    """

    name: str
    arguments: tuple[Symbol | str, ...]
    summary: str
    equations: tuple[str, ...]
    returns: str
    unless: str
    kind: str = ""
    optional: tuple[tuple[str, str], ...] = ()
    meanings: tuple[tuple[str, str], ...] = ()
    beyond: str = "dQ < 0 or dQ >= f (P1 + P2), which is sliding"
    by_differences: str = ""


_MEANINGS = {
    "first": "Contact at the start of the half-cycle that raises the shear load",
    "second": "Contact at its end; the same for constant normal loads",
    "contact": "Contact under normal loads that stay",
    "Q": "shear load at every instant [N/m]",
    "sigma": "differential bulk tension at every instant [Pa]",
    "da": "how much further the left edge reaches than at the other end of the half-cycle [m]",
    "dc": "how much further the right edge reaches [m]",
    "order": "order of the series; march takes 0 for the exact conditions",
    "mixed": "whether to solve cycles in which slip turns round, too, to 1e-7 of the width; takes "
    "far longer",
}
"""What is no symbol of the theory, in words."""

_CONTACTS = ("first", "second", "contact")
"""Arguments that are contacts."""

_TYPES = {"order": "int", "mixed": "bool"}
"""Options that are no arrays."""

_BETWEEN: tuple[Symbol | str, ...] = ("first", "second", dQ, dsigma)
_EDGES: tuple[Symbol | str, ...] = (a, c, dQ, dsigma)
_MOTION = (("da", "0.0"), ("dc", "0.0"))

CYCLE: tuple[CycleFunction, ...] = (
    CycleFunction(
        "stick_zone",
        _BETWEEN,
        "What sticks all through a steady cycle, [-m, n], and how the cycle slips.",
        (
            "moderate tension: load(m, n) = (P1 + P2)/2 - dQ/(2 f), "
            "tilt(m, n) = (alpha1 + alpha2)/2 - dsigma/(4 f E*)",
            "large tension: int r sqrt((xi + m)/(xi - n)) dxi = dQ - pi dsigma (m + n)/8, "
            "int r sqrt((xi - n)/(xi + m)) dxi = dQ + pi dsigma (m + n)/8 over the slip zones, "
            "r = +/- f (p1 + p2), the upper sign on the left if dsigma > 0",
        ),
        "StickZone(m [m], n [m], regime as a code of Regime)",
        "the regime is MODERATE, LARGE or FULL_STICK; where slip reverses within a half-cycle, "
        "MIXED, they are given if the normal loads are constant and forward slip overtakes it in "
        "the end, or if `mixed` asks for them",
        "StickZone",
        (("mixed", "False"),),
    ),
    CycleFunction(
        "tension_threshold",
        ("first", "second", dQ),
        "Changes of bulk tension between which tension is moderate, so that its solution is exact.",
        ("constant loads: dsigma = -/+ 8 dQ/(pi (a + c))",),
        "Threshold(lower [Pa], upper [Pa])",
        "there is such a range",
        "Threshold",
    ),
    CycleFunction(
        "closing_tension",
        ("first", "second", dQ),
        "Changes of bulk tension at which the moderate solution closes one slip zone.",
        (
            "upper: load(m, c) = (P1 + P2)/2 - dQ/(2 f), "
            "dsigma = 4 f E* ((alpha1 + alpha2)/2 - tilt(m, c)), c that of the smaller contact",
            "lower: the same with a kept",
        ),
        "Threshold(lower [Pa], upper [Pa]); slip reverses before it closes, see tension_threshold",
        "the reduced load is positive",
        "Threshold",
    ),
    CycleFunction(
        "slip_zones",
        _EDGES,
        "Slip zones by series in their length: order 1, 2 or 3.",
        (
            "order 1: d = |K_T|/(f K_N) + da/2, and dc/2 at the right edge",
            "orders 2 and 3: the conditions of stick_zone for the pressure's first two or three "
            "terms at each edge of both contacts, cut behind that power of d, solved as they stand",
        ),
        "Edges(left [m], right [m])",
        "slip reaches in at both edges and leaves some stick",
        "Edges",
        (*_MOTION, ("order", "1")),
        by_differences="; to order 3, unless each edge lies off every kink by 1e-7 of its own x",
    ),
    CycleFunction(
        "slip_error",
        _EDGES,
        "By how much one more term would change the slip zones: an estimate of the series' error.",
        ("|d(order + 1) - d(order)|",),
        "Edges(left [m], right [m])",
        "both orders give slip zones",
        "Edges",
        (*_MOTION, ("order", "1")),
    ),
    CycleFunction(
        "shear_change",
        (x, *_BETWEEN),
        "Change of the shear traction at x over the half-cycle; zero outside the contacts.",
        (
            "dq = kappa f (p1 + p2) where it slips",
            "moderate tension: dq = f (p1 + p2) - 2 f p(x; m, n)",
            "large tension: dq = sqrt((x + m)(n - x))/pi int r/(w (xi - x)) dxi where it sticks, "
            "w = sqrt((xi + m)(xi - n)), negative on the left",
        ),
        "dq [Pa]; with `second`, dQ and dsigma as they are part of the way, dq until then, if the "
        "regime of the whole half-cycle is MODERATE or LARGE",
        "the stick zone is known without `mixed`; nor in full stick between two contacts",
    ),
    CycleFunction(
        "shear",
        (x, "contact", "Q", "sigma"),
        "Shear traction at x in a cycle at constant normal loads; zero outside the contact.",
        (
            "q = dq(2 Q, 2 sigma)/2 - dq(dQ, dsigma), dq as by shear_change",
            "first the shear load rises from nothing to Q and the tension to sigma, in proportion; "
            "since then they have fallen by dQ and dsigma, in proportion again: by nothing at the "
            "upper end of a cycle, by all of the half-cycle's change at the lower end, from which "
            "q rises by shear_change",
        ),
        "q [Pa]; where it sticks, the mean of both ends is what the first rise has locked in",
        "the regimes of (2 Q, 2 sigma) and of (dQ, dsigma) are both MODERATE or both LARGE, it "
        "slips back only where it slipped and drives none of that on, and dQ <= 2 Q; so reverse "
        "all signs, those of q too, where the lower end has the larger shear load",
        optional=(("dQ", "0.0"), ("dsigma", "0.0")),
        meanings=(
            ("Q", "shear load that is reached first [N/m]"),
            ("sigma", "differential bulk tension that comes with it [Pa]"),
            ("dQ", "what the shear load has fallen by since then [N/m]"),
            ("dsigma", "what the tension has fallen by since then [Pa]"),
        ),
        beyond="Q < 0, dQ < 0, or Q >= f P, which is sliding",
    ),
    CycleFunction(
        "slip_range",
        (x, *_BETWEEN),
        "How far the surfaces slip at x over the half-cycle; zero where they stick.",
        (
            "(E*/2) d slip/dx = (1/pi) PV int dq/(x - xi) dxi - dsigma/4; "
            "moderate tension and constant loads: 2 f times the gap beside the patch [-m, n]",
        ),
        "slip [m], positive",
        "x lies in both contacts and the regime is MODERATE, LARGE or FULL_STICK",
    ),
    CycleFunction(
        "march",
        (P, M, "Q", "sigma"),
        "A steady cycle instant by instant: contact, stick zone, and which way the edges slip.",
        (
            "since the loads last turned, at the least or the greatest Q, slip has grown as in a "
            "half-cycle that ends now: by stick_zone, or by slip_zones if an order is given; where "
            "the whole half-cycle is MIXED it has not, and only its end may be known",
        ),
        "March(a, c, m, n [m]; left, right: +1 forward slip, -1 reverse slip, 0 none; regime)",
        "all loads are as far on their way between both states, to 1e-6 of their change",
        "March",
        (("order", "0"),),
    ),
)


class CycleText:
    """The text of one function of a cycle, for one body."""

    def __init__(self, sheet: FormulaSheet, function: CycleFunction, source: str) -> None:
        self.sheet, self.function, self.source = sheet, function, source
        self.example = _Example(sheet)

    @property
    def text(self) -> str:
        """The whole function."""
        own, given = own_parameters(self.sheet)
        own = own.removeprefix(", *")
        names = [*map(str, self.function.arguments)]
        kinds = ["Contact" if name in _CONTACTS else "Array" for name in names]
        taken = ", ".join(f"{n}: {kind}" for n, kind in zip(names, kinds, strict=True))
        optional = "".join(
            f", {n}: {_TYPES.get(n, 'Array')} = {default}" for n, default in self.function.optional
        )
        passed = "".join(f", {n}={n}" for n, _ in self.function.optional)
        way = "chunkwise_in_time" if self.function.name == "march" else "chunkwise"
        return "\n".join(
            [
                f"@{way}",
                f"def {self.function.name}({taken}, *, f: Array, E_star: Array{own}{optional}) "
                f"-> {self.function.kind or 'Array'}:",
                textwrap.indent(self._docstring, " " * 4),
                f"    return {self.function.name}_of("
                f"_LAW, {', '.join(names)}, f=f, E_star=E_star{given}{passed})",
            ]
        )

    @property
    def _docstring(self) -> str:
        lines = [self.function.summary, ""]
        for equation in self.function.equations:
            lines += textwrap.wrap(
                equation, LINE - 8, initial_indent="    ", subsequent_indent=" " * 8
            )
        lines += ["", "Arguments broadcast; results are float64 of the broadcast shape."]
        if self.function.name == "march":
            lines[-1] = "Arguments broadcast; the instants of a cycle lie along the last axis."
            lines.append("Of a Dask array, that axis must be one chunk.")
        lines += self._arguments
        lines += ["", *textwrap.wrap(f"Returns {self.function.returns}.", LINE - 4)]
        exists = self.function.unless
        if not has_third(self.sheet):
            exists += self.function.by_differences
        lines += textwrap.wrap(
            f"NaN unless {exists}; nor where {self.function.beyond}.",
            LINE - 4,
        )
        lines += [f"Derived from {self.source}.", "", *self.example.of(self.function)]
        return "\n".join(['"""' + lines[0], *lines[1:], '"""'])

    @property
    def _arguments(self) -> Iterator[str]:
        quantities = self.sheet.geometry.quantities
        own = [q.symbol for q in self.sheet.geometry.parameters]
        names = [*self.function.arguments, f, E_star, *own]
        names += [name for name, _ in self.function.optional]
        width = max(len(str(name)) for name in names)
        meanings = {**_MEANINGS, **dict(self.function.meanings)}
        for name in map(str, names):
            if name in meanings:
                words = meanings[name]
            else:
                words = inside_quotes(f"{quantities[name].meaning} [{quantities[name].unit}]")
            yield from textwrap.wrap(
                f"{name:{width}}  {words}",
                LINE - 4,
                initial_indent="    ",
                subsequent_indent=" " * (width + 6),
            )


class _Example:
    """A contact in plain numbers for the docstrings; f = 1/2, so that dQ/(2 f) is dQ."""

    def __init__(self, sheet: FormulaSheet) -> None:
        point: Point = example_of(sheet, sheet["load"].conditions)
        self.load, *self.K = (
            numeric(sheet.flat(name))(point) for name in ("load", "K_N_left", "K_N_right")
        )
        self.h = point[a] + point[c]
        self.dQ = mpf(f"{float(self.load / 8):.2g}")
        constants = [E_star, *(q.symbol for q in sheet.geometry.parameters)]
        self.law = ", ".join(f"{s}={float(point[s])!r}" for s in constants)
        self.edges = f"{float(point[a])!r}, {float(point[c])!r}"

    def of(self, function: CycleFunction) -> Iterator[str]:
        """Lines of a doctest whose result is known beforehand."""
        shear, name = repr(float(self.dQ)), function.name
        between = f"here, here, {shear}, 0.0, f=0.5, **law"
        yield f">>> law = dict({self.law})"
        if set(_CONTACTS) & set(function.arguments):
            yield f">>> here = Contact({self.edges}, 0.0)"
        match name:
            case "stick_zone":
                yield f">>> zone = stick_zone({between})"
                yield from (">>> Regime(zone.regime).name", "'MODERATE'")
                yield '>>> f"{load(zone.m, zone.n, **law):.6g}"  # P - dQ/(2 f)'
                yield repr(f"{float(self.load - self.dQ):.6g}")
            case "tension_threshold":
                yield f">>> lower, upper = tension_threshold(here, here, {shear}, f=0.5, **law)"
                yield '>>> f"{upper:.6g}"'
                yield repr(f"{float(8 * self.dQ / (mpmath.pi * self.h)):.6g}")
            case "closing_tension":
                yield f">>> lower, upper = closing_tension(here, here, {shear}, f=0.5, **law)"
                yield from (">>> bool(lower < 0 < upper)", "True")
            case "slip_zones":
                scale = mpmath.pi * mpmath.sqrt(self.h) / 2
                yield f">>> d = slip_zones({self.edges}, {shear}, 0.0, f=0.5, **law)"
                yield '>>> [f"{v:.6g}" for v in d]'
                yield str([f"{float(self.dQ / (scale * K)):.6g}" for K in self.K])
            case "slip_error":
                yield f">>> error = slip_error({self.edges}, {shear}, 0.0, f=0.5, **law)"
                yield from (">>> bool(error.left > 0)", "True")
            case "shear_change":
                yield from (f">>> float(shear_change(here.c + 1.0, {between}))", "0.0")
            case "shear":
                yield ">>> law |= dict(f=0.5)"
                yield f">>> upper, lower = (shear(0.1, here, {shear}, 0.0, dQ=fall, **law)"
                yield f"...                 for fall in (0.0, 2 * {shear}))"
                yield from (">>> bool(upper == -lower)  # a cycle between Q and -Q", "True")
            case "slip_range":
                yield f">>> zone = stick_zone({between})"
                yield from (f">>> float(slip_range(zone.n, {between}))", "0.0")
            case "march":
                yield f">>> P, M = (of({self.edges}, **law) for of in (load, moment))"
                yield f">>> Q = np.array([0.0, 1.0, 0.0, -1.0]) * {shear} / 2"
                yield ">>> cycle = march(P, M, Q, 0.0, f=0.5, **law)"
                yield from (">>> cycle.left.tolist()", "[1, 1, -1, -1]")


def law_text(sheet: FormulaSheet) -> str:
    """`_LAW` of one body, and where it is cut unless that is there already."""
    lines: list[str] = []
    if sheet.geometry.slope.is_polynomial and not is_mended(sheet):
        lines += breaks_text(sheet)
    exact = is_parabolic(sheet) or keeps_its_digits(sheet, "pressure")
    integrand = "as_integrand(pressure)" if is_mended(sheet) and not exact else "pressure"
    functions = f"contact, contact_at_tilt, tilt, load, moment, pressure, {integrand}, K_N, L_N"
    further = f", third={THIRD}" if has_third(sheet) else ""
    if smooth := smooth_cuts(sheet):
        further += f", smooth={smooth}"
    return "\n".join([*lines, f"_LAW = Law({functions}, _breaks{further})"])
