"""What `derive show` prints, and the pages it writes.

In:  the name of a geometry of the library, or a geometry file.
Out: texts, sheets for the terminal, pages.

The series of slip zones, which may take a long time, and what runs a user's file are made in a
separate process with limits on time and memory; a geometry file cannot end this one.
"""

from collections.abc import Callable, Sequence
from typing import TypeVar

import click
from markupsafe import Markup
from rich.console import RenderableType
from sympy import Add, Expr, Monomial, Poly

from derive import derive_sheet, load_geometry, pipeline
from derive.command import view
from derive.command.processes import Report
from derive.command.terminal import folded, progress, remark
from derive.sheet.derivation import slip_series
from derive.sheet.notation import text_of

Made = TypeVar("Made")

_SENSES = (
    "kappa_left, kappa_right: directions of slip in the half-cycle that raises the shear load: 1 "
    "and 1 under moderate tension, 1 and -1 under large tension if the tension rises, -1 and 1 if "
    "it falls"
)


def made(
    make: Callable[[str, Report], tuple[str, Made]],
    names: Sequence[str],
    jobs: int = 1,
    limited: bool = False,
) -> list[Made]:
    """What `make` returns for every body, with a progress bar; its remarks are printed.

    limited: whether limits hold for a body of the library, too
    """
    with progress(len(names), pipeline.STAGES) as step:
        found = pipeline.each_in_process(make, names, step, jobs, limited)
    for note in filter(None, (note for note, _ in found)):
        remark(note)
    return [each for _, each in found]


def sheet_of(name: str, report: Report, form: str, limit: float) -> tuple[str, RenderableType]:
    """A remark, and the proven sheet of a body for the terminal, in LaTeX or as code."""
    sheet = pipeline.proven_sheet(name, report, limit).demand_proven()
    note = pipeline.time_limit_note(sheet)
    if form == "latex":
        return note, sheet.latex
    if form:
        from derive.codegen.languages import code_of

        return note, code_of(sheet, form, name)
    return note, view.formulas(sheet)


def page_of(
    name: str, report: Report, limit: float, index: bool
) -> tuple[str, tuple[str, str, Markup]]:
    """A remark; a body's name, its page, and its entry in an index, to which the page may link."""
    from derive.handbook.page import card, page

    sheet, body = pipeline.sheet_and_body(name, report, limit)
    found = body.name, page(sheet, body, index), card(sheet, body)
    report(name, pipeline.DONE)
    return pipeline.time_limit_note(sheet), found


def slip_of(name: str, report: Report, order: int) -> tuple[str, RenderableType]:
    """No remark; the terms of both slip zones and the meaning of their coefficients, in lines."""
    report(name, "reading g(x)")
    geometry = load_geometry(name)
    report(name, "deriving the terms of the slip zones")
    try:
        terms, known = slip_series(derive_sheet(geometry), order)
    except ValueError as error:
        raise click.BadParameter(str(error), param_hint="--slip") from None
    leading = [found[0] for found in terms.values()]
    zones = [
        f"d_{edge.name.lower()}, order {number}: {text_of(_grouped(term, leading))}"
        for edge, found in terms.items()
        for number, term in enumerate(found, 1)
    ]
    lines = [*zones, *(f"{s} = {text_of(value)}" for s, value in known.items()), _SENSES]
    return "", "\n".join(folded(line) for line in lines)


def _grouped(term: Expr, leading: Sequence[Expr]) -> Expr:
    """A term with one factor for each product of powers of the leading terms."""
    groups = Poly(term, *leading).terms()
    return Add(*(factor * Monomial(powers, leading).as_expr() for powers, factor in groups))
