"""The command `derive`: read the arguments, call the package, print the results.

SymPy is imported only by the commands that need it, so that help appears at once.
"""

import shlex
import sys
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import click

from derive.command.group import FELL_SHORT, Commands
from derive.command.options import PATH, WithFormula, name_values, positive, time_limit
from derive.command.terminal import (
    command,
    complain,
    output,
    path_of,
    progress,
    status,
    typed,
)

if TYPE_CHECKING:
    from derive.codegen.publish import Difference
    from derive.pipeline import Order


@click.group(cls=Commands, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(package_name="contact-derive", prog_name="derive")
def main() -> None:
    """Derive contact laws of half-plane contacts from g(x), prove them and generate NumPy code."""


@main.command("list")
def list_() -> None:
    """List all geometries, with g(x) and their closed forms."""
    from derive import load_geometry
    from derive.body.library import library
    from derive.command import view
    from derive.sheet.derivation import derive_law, with_closed_forms

    laws = (derive_law(load_geometry(name)) for name in library())
    output(view.listing(with_closed_forms(law) for law in laws))


@main.command()
@click.argument("name", required=False)
@click.option("--latex", is_flag=True, help="Print the sheet as one LaTeX display.")
@click.option(
    "--code",
    type=click.Choice(["c", "fortran", "javascript", "julia", "matlab"], case_sensitive=False),
    help="Print the closed formulas as functions in this language.",
)
@click.option("--html", is_flag=True, help="Write a page for the browser, NAME.html.")
@click.option(
    "--all", "every", is_flag=True, help="With --html: write a page for every body, and an index."
)
@click.option(
    "--out",
    type=PATH,
    help="With --html: the file to write; with --all, the directory (default: handbook).",
)
@click.option(
    "--slip",
    type=click.IntRange(1, 2),
    metavar="ORDER",
    help="Print the series of the slip zones up to this order instead; kappa is the direction of "
    "slip.",
)
@time_limit
def show(
    name: str | None,
    latex: bool,
    code: str | None,
    html: bool,
    every: bool,
    out: Path | None,
    slip: int | None,
    limit: float,
) -> None:
    """Show the proven formulas of NAME.

    NAME is a geometry of the library or the path of a geometry file.
    """
    if html + latex + bool(code) + bool(slip) > 1:
        raise click.UsageError("--html, --latex, --code and --slip cannot be combined: give one")
    if (every or out) and not html:
        raise click.UsageError("--all and --out require --html: add it")
    if (name is None) != every:
        raise click.UsageError("give either NAME, a geometry or geometry file, or --all --html")
    if html:
        _write_pages(name, out, limit)
        return
    from derive.command.showing import made, sheet_of, slip_of

    assert name is not None
    make = partial(sheet_of, form="latex" if latex else code or "", limit=limit)
    if slip:
        make = partial(slip_of, order=slip)
    (shown,) = made(make, [name], limited=bool(slip))
    if isinstance(shown, str):
        click.echo(shown)
    else:
        output(shown)


def _write_pages(name: str | None, out: Path | None, limit: float) -> None:
    """Write the page of one body, or those of the library with their index."""
    import derive.handbook  # noqa: F401 - reports a missing library at once
    from derive.body.library import is_in_library, library
    from derive.command.files import demand_page, put_page
    from derive.command.folder import demand_replaceable, replace_folder, with_manifest
    from derive.command.processes import cores
    from derive.command.showing import made, page_of
    from derive.handbook.page import index_of

    make = partial(page_of, limit=limit, index=name is None)
    if name is not None:
        if out or is_in_library(name):
            demand_page(out or Path(f"{name}.html"))
        ((body, page, _),) = made(make, [name])
        path = out or Path(f"{body}.html")
        put_page(page, path)
        click.echo(f"Wrote {path_of(path.resolve())}")
        return
    folder = out or Path("handbook")
    demand_replaceable(folder)
    bodies, pages, cards = zip(*made(make, library(), jobs=cores()), strict=True)
    files = dict(zip((f"{body}.html" for body in bodies), pages, strict=True))
    replace_folder(with_manifest(files | {"index.html": index_of(cards)}), folder)
    index = path_of((folder / "index.html").resolve())
    click.echo(f"Wrote {index} and the pages of {len(bodies)} bodies")


@main.command(cls=WithFormula)
@click.argument("name")
@click.argument("profile", metavar="G")
@name_values("--unit", "units", metavar="NAME=UNIT", help="Unit of a parameter.")
@name_values("--meaning", "meanings", metavar="NAME=TEXT", help="Meaning of a parameter.")
@click.option("--title", default="", help="First line of the file.")
@click.option("--out", type=PATH, help="A directory, or a path that ends in .py.")
def new(
    name: str,
    profile: str,
    units: dict[str, str],
    meanings: dict[str, str],
    title: str,
    out: Path | None,
) -> None:
    """Write the geometry file NAME.py from G, the text of g(x).

    G is for example "x**2/(2*R)".  Every name in G other than x becomes a parameter.  Units that
    are not given are derived from the requirement that g(x) be a length.  An existing file is never
    changed.
    """
    from derive.command.files import place_of_geometry, put_page
    from derive.command.new_geometry import Wanted, in_limited_process

    wanted = Wanted(name, profile.strip(), title, units, meanings)
    path = place_of_geometry(name, out)
    with status(f"{name}: reading g(x)"):
        geometry, text = in_limited_process(wanted)
    put_page(text, path, mark=None)
    shown = click.format_filename(path_of(path))
    click.echo(f"Wrote {shown}: g(x) = {geometry.g}")
    for parameter in geometry.parameters:
        click.echo(f"  {parameter.name} [{parameter.unit}]  {parameter.meaning}")
    derive, file = command(), shlex.quote(shown)
    click.echo(f"See its formulas:    {derive} show {file}")
    click.echo(f"Generate a module:   {derive} generate {file} --out DIRECTORY")


@main.command()
@click.argument("sources", nargs=-1, metavar="[NAME|FILE]...")
@click.option("--out", type=PATH, help="Write an importable package here.")
@click.option("--check", is_flag=True, help="Write nothing; fail if anything would change.")
@click.option("--fresh", is_flag=True, hidden=True, expose_value=False)  # as it always is now
@click.option(
    "--jobs",
    type=click.IntRange(min=1),
    metavar="N",
    help="Number of bodies derived at once (default: the number of cores).",
)
@time_limit
def generate(
    sources: tuple[str, ...],
    out: Path | None,
    check: bool,
    jobs: int | None,
    limit: float,
) -> None:
    """Derive, prove and write NumPy modules.

    Without arguments, modules are written for the whole library; otherwise, only for the geometries
    named.  A package that --out names is replaced as a whole.
    """
    from derive.codegen.publish import resolved
    from derive.command.processes import cores
    from derive.pipeline import Order, built

    order = Order(sources, resolved(out) if out else None, writes=not check)
    from derive.command import view
    from derive.command.showing import made

    bodies = made(partial(built, limit=limit), order.names, jobs=jobs or cores())
    changed = order.fulfil(bodies)
    if check:
        _report_drift(order, changed)
        return
    output(view.summary(bodies))
    click.echo(f"{'Wrote' if changed else 'Nothing to change in'} {path_of(order.target)}")
    if lost := [d.name for d in changed if d.removed and "/" not in d.name]:
        click.echo(f"Removed {', '.join(lost)}: name all bodies of a package in one command")


@main.command()
@click.argument("file", required=False, type=PATH)
@click.option(
    "--format",
    "form",
    type=click.Choice(["table", "json", "markdown", "latex", "html"]),
    default="table",
    help="Format of the findings.",
)
@click.option(
    "--explain",
    metavar="CLAIM",
    help='Explain one claim: the steps and the numbers. CLAIM is a name, a label or "(5)".',
)
@click.option(
    "--html",
    "page",
    type=PATH,
    metavar="PAGE",
    help="Also write all findings as a page for the browser.",
)
@click.option(
    "--accept",
    "accepting",
    is_flag=True,
    help="Show how each LaTeX formula of FILE was read; write the readings you accept into it.",
)
@click.option(
    "--draft",
    "drafted",
    type=PATH,
    metavar="NEW",
    help="FILE is a paper in LaTeX: read its displayed equations and write the claims file NEW.",
)
@click.option("--inline", is_flag=True, help="With --draft: also read formulas in running text.")
def check(
    file: Path | None,
    form: str,
    explain: str | None,
    page: Path | None,
    accepting: bool,
    drafted: Path | None,
    inline: bool,
) -> None:
    """Check the algebra of a paper, claim by claim.

    Each printed claim is compared with what follows from the theory.  FILE is a claims file in
    TOML; `derive check paper.tex --draft FILE` writes one from a paper in LaTeX.  Without FILE, the
    paper by Andresen, Fleury, Moore and Hills (2020) is checked.  The exit status is 1 if a verdict
    is not the expected one.
    """
    from derive.command.checking import accept_readings, next_steps, paper_of, write_draft

    if drafted is not None:
        write_draft(file, drafted, inline)
        return
    if inline:
        raise click.UsageError("--inline requires --draft: add it, or leave --inline out")
    if accepting:
        accept_readings(file, explain)
        return
    from derive.check import documents
    from derive.check.verdict import Finding
    from derive.check.verdict import check as judged
    from derive.command import view
    from derive.command.files import demand_page, put_page

    if page is not None:
        demand_page(page, "--html")

    paper = paper_of(file, explain)
    is_short = form == "table" and explain is None and page is None
    if is_short and file is not None and (steps := next_steps(file, paper)):
        click.echo("\n".join(steps))
        sys.exit(FELL_SHORT)
    with progress(len(paper.claims), ("checking",)) as step:
        findings = list[Finding]()
        for claim in paper.claims:
            step(claim.name, "checking")
            findings.append(judged(claim, findings))
            step(claim.name, "")
    if form in documents.FORMS:
        click.echo(documents.FORMS[form](paper, findings))
    elif explain is not None:
        output(view.explained(findings))
    else:
        output(view.checked(findings))
    if page is not None:
        put_page(documents.FORMS["html"](paper, findings), page, "--html")
        click.echo(f"Wrote {path_of(page.resolve())}", err=form != "table")
    elif form == "table" and explain is None:
        given = "" if file is None else f"{typed(file)} "
        click.echo(f"More: {command()} check {given}--explain CLAIM, or --html PAGE for all claims")
    wrong = [finding for finding in findings if not finding.as_expected]
    names = [finding.claim.name for finding in wrong if not finding.claim.to_accept]
    if names:
        complain("Not as expected", "; ".join(names))
    if left := len(wrong) - len(names):
        how = "accept them with --accept; --html PAGE shows them beside their source"
        complain("Readings to be accepted", f"{left}: {how}")
    if wrong:
        sys.exit(FELL_SHORT)


@main.command()
@click.argument("file", type=PATH)
@click.option(
    *("--f", "friction"),
    type=float,
    required=True,
    callback=positive,
    help="Coefficient of friction.",
)
@click.option(
    "--dQ",
    "dQ",
    type=float,
    metavar="N/M",
    help="Change in the shear load, from its lowest to its highest value, if FILE has no dq.",
)
@click.option(
    "--dsigma",
    type=float,
    metavar="PA",
    help="Change in the bulk tension over the same half-cycle.",
)
@name_values("--unit", "units", metavar="NAME=UNIT", help="Unit of x or of p.")
@click.option("--html", type=PATH, help="Also write a page with pictures.")
@click.option("--csv", "table", type=PATH, help="Also write the results, in SI units.")
def edge(
    file: Path,
    friction: float,
    dQ: float | None,
    dsigma: float | None,
    units: dict[str, str],
    html: Path | None,
    table: Path | None,
) -> None:
    """Find the slip zones of both edges from a table.

    FILE is a finite-element table; the coefficients of both edges are found from it.  In FILE, a
    line above the numbers names the columns with their units, such as x [mm], p [MPa], dq [MPa].
    dq is the change in the shear traction in a run without slip.  A column `step` distinguishes
    load steps; the half-cycle runs from the first of them to the last.
    """
    from derive.command.files import MARK, demand_page, put_page
    from derive.edge import report
    from derive.edge.find import find
    from derive.edge.table import read

    if wrong := units.keys() - {"x", "p"}:
        raise click.BadParameter(
            f"{wrong.pop()!r} is neither x nor p: write x=UNIT or p=UNIT", param_hint="--unit"
        )
    if html:
        import derive.sheet.picture  # noqa: F401 - refuses if a library is missing
    targets = ((html, "--html", MARK), (table, "--csv", report.CSV_HEAD))
    for path, option, mark in targets:
        if path is not None:
            demand_page(path, option, mark)
    with status(f"reading {file.name}"):
        steps = read(file, units)
    with progress(len(steps), ("fitting",)) as fitted:
        found = find(
            steps, file.name, friction, dQ, dsigma, lambda name: fitted(f"load step {name}", "")
        )
    click.echo(report.as_text(found))
    for path, option, mark in targets:
        if path is not None:
            page = path is html
            text = report.as_page(found, steps, file.name) if page else report.as_csv(found)
            put_page(text, path, option, mark)
            click.echo(f"Wrote {path_of(path.absolute())}")


def _report_drift(order: "Order", found: "Sequence[Difference]") -> None:
    from derive.command import view

    if not found:
        click.echo(f"{path_of(order.target)} is up to date")
        return
    for line in view.drift(found):
        click.echo(line)
    where = f" --out {path_of(order.target)}" if order.folder else ""
    click.echo(f"Update with: {command()} generate{''.join(f' {s}' for s in order.sources)}{where}")
    sys.exit(FELL_SHORT)


if __name__ == "__main__":
    main()
