"""What `derive show` prints, and the pages it writes.

In:  the name of a geometry of the library, or a geometry file.
Out: texts, sheets for the terminal, pages.

Work that may take a long time or that runs a user's file is done in a separate process with limits
on time and memory.
"""

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, TypeVar

import click
from rich.console import RenderableType
from sympy import Add, Expr, Monomial, Poly

from derive import derive_sheet, load_geometry, pipeline
from derive.body.library import is_in_library
from derive.command import view
from derive.command.processes import Report, in_processes
from derive.command.terminal import folded, status
from derive.proof import prove
from derive.sheet.built import BuiltBody
from derive.sheet.derivation import NONE_IN_TIME, slip_series, with_closed_forms
from derive.sheet.formulas import FormulaSheet
from derive.sheet.notation import text_of

if TYPE_CHECKING:
    from derive.handbook.page import Entry

Shown = TypeVar("Shown")

_SENSES = (
    "kappa_left, kappa_right: directions of slip in the half-cycle that raises the shear load: 1 "
    "and 1 under moderate tension, 1 and -1 under large tension if the tension rises, -1 and 1 if "
    "it falls"
)


def in_limited_process(
    function: Callable[[tuple[Any, ...], Report], Shown], name: str, *more: object
) -> Shown:
    """Apply a function to a geometry, with limits for a file and for the series of slip zones.

    With limits, it runs in a separate process, in which a geometry file cannot end this one.
    """
    limited = function is slip_of or not is_in_library(name)
    bounds = pipeline.USER_FILE_LIMITS if limited else None
    with status(f"reading {name}") as update:

        def report(what: str, stage: str) -> None:
            update(f"{what}: {stage}")

        (shown,) = in_processes(function, [(name, *more)], report, 1, bounds)
    return shown


def sheet_of(asked: tuple[str, str, float], report: Report) -> tuple[RenderableType, str]:
    """The proven sheet of a body for the terminal, in LaTeX or as code, and a remark."""
    name, form, limit = asked
    sheet = _derived(name, report)
    if not sheet.is_closed("load"):
        report(name, f"looking for closed forms, {limit:g} s at most")
        sheet = with_closed_forms(sheet, limit)
    report(name, "proving")
    sheet = prove.prove_sheet(sheet).demand_proven()
    struck = sheet.remark.startswith(NONE_IN_TIME)
    remark = f"{sheet.geometry.name}: {sheet.remark}" if struck else ""
    if form == "latex":
        return sheet.latex, remark
    if form:
        from derive.codegen.languages import code_of

        return code_of(sheet, form, name), remark
    return view.formulas(sheet), remark


def page_of(
    asked: tuple[str, float], report: Report, index: bool = False
) -> "tuple[BuiltBody, str, Entry]":
    """A body, its page, and its entry in an index, to which the page may link."""
    from derive.handbook.page import entry, page

    name, limit = asked
    sheet, body = pipeline.sheet_and_body(name, report, limit)
    made = body, page(sheet, body, index), entry(sheet, body)
    report(name, pipeline.DONE)
    return made


def slip_of(asked: tuple[str, int], report: Report) -> str:
    """The terms of both slip zones, then the meaning of their coefficients; long lines continue."""
    name, order = asked
    sheet = _derived(name, report)
    report(name, "deriving the terms of the slip zones")
    try:
        terms, known = slip_series(sheet, order)
    except ValueError as error:
        raise click.BadParameter(str(error), param_hint="--slip") from None
    leading = [found[0] for found in terms.values()]
    zones = [
        f"d_{edge.name.lower()}, order {number}: {text_of(_grouped(term, leading))}"
        for edge, found in terms.items()
        for number, term in enumerate(found, 1)
    ]
    lines = [*zones, *(f"{s} = {text_of(value)}" for s, value in known.items()), _SENSES]
    return "\n".join(folded(line) for line in lines)


def _grouped(term: Expr, leading: Sequence[Expr]) -> Expr:
    """A term with one factor for each product of powers of the leading terms."""
    groups = Poly(term, *leading).terms()
    return Add(*(factor * Monomial(powers, leading).as_expr() for powers, factor in groups))


def _derived(name: str, report: Report) -> FormulaSheet:
    report(name, "reading g(x)")
    geometry = load_geometry(name)
    report(name, "deriving")
    return derive_sheet(geometry)
