"""The command `derive`: read the arguments, call the package, print the results.

Exit status: 0 if all went well, 1 if a check failed, 2 if the input was bad.  SymPy is imported
only by the commands that need it, so that help appears at once.
"""

import errno
import os
import shlex
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import replace
from math import inf
from pathlib import Path
from shutil import which
from threading import Timer
from traceback import walk_tb
from typing import TYPE_CHECKING, Any, TypeVar

import click
from rich.console import Console, RenderableType
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

from derive.errors import BadLimit, NotProven, UserError
from derive.limit import DEFAULT

if TYPE_CHECKING:
    from derive.body import Body
    from derive.paper.claim import Paper
    from derive.parallel import Report
    from derive.pipeline import Order
    from derive.sheet import FormulaSheet

Shown = TypeVar("Shown")

_WIDE = 10_000
"""Columns of output that is not a terminal, if COLUMNS is not set: wide enough that no line that
another program reads is broken."""

_NARROW = 100
"""Columns below which a list leaves as much room as possible to texts."""

_PATIENCE = 10.0
"""Seconds after which a line says what takes so long, if standard error is not a terminal."""

FELL_SHORT, BAD_INPUT = 1, 2


def _time(context: click.Context, option: click.Parameter, seconds: float) -> float:
    """Check a number of seconds and return it.

    Raises BadLimit if it is not a valid time limit.
    """
    if not 0 < seconds < inf:
        raise BadLimit(f"{seconds:g}")
    return seconds


_limit = click.option(
    "--limit",
    type=float,
    callback=_time,
    default=DEFAULT,
    show_default=True,
    metavar="SECONDS",
    help="Time for the search for closed forms of one body's integrals.",
)


class _Commands(click.Group):
    """Show a user's mistake as a single message, and exit with the status that belongs to it."""

    def invoke(self, ctx: click.Context) -> object:
        try:
            done = super().invoke(ctx)
            sys.stdout.flush()
            return done
        except UserError as error:
            _complain("Error", error.message.replace("`derive ", f"`{_command()} "))
            ctx.exit(BAD_INPUT)
        except NotProven as error:
            _complain("Not proven", str(error))
            ctx.exit(FELL_SHORT)

    def main(self, *args: Any, **more: Any) -> Any:
        """Run a command; `--help` and `--version` print before `invoke` is called."""
        try:
            _demand_surroundings()
            return super().main(*args, **more)
        except OSError as error:  # a closed pipe never gets here
            _complain("Error", _what_failed(error))
            _forget_the_output()
            sys.exit(BAD_INPUT)


def _what_failed(error: OSError) -> str:
    """What the system refused, and where."""
    passed = [frame.f_code for frame, _ in walk_tb(error.__traceback__)]
    flushing = passed[-1] is _Commands.invoke.__code__
    if flushing or {click.echo.__code__, _print.__code__} & {*passed}:
        return f"standard output cannot be written: {error.strerror}"
    return f"{error.strerror}{f': {error.filename}' if error.filename else ''}"


def _demand_surroundings() -> None:
    """Check that there is a standard output and a working directory."""
    if sys.stdout is None:
        raise OSError(errno.EBADF, "the standard output is closed, so nothing can be printed")
    try:
        Path.cwd()
    except OSError as error:
        why = "the working directory no longer exists: change to another directory"
        raise OSError(error.errno, why) from error


def _forget_the_output() -> None:
    """Prevent a second attempt, at the end of the process, to write output that failed."""
    with suppress(OSError, AttributeError):  # closed, or not a file
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


class _WithFormula(click.Command):
    """Accept a formula such as -x + b as an argument; -h is the only option of one letter."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        shielded = [
            f" {arg}" if arg[:1] == "-" != arg[1:2] and arg != "-h" else arg for arg in args
        ]
        return super().parse_args(ctx, shielded)


@click.group(cls=_Commands, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(package_name="contact-derive", prog_name="derive")
def main() -> None:
    """Contact laws of half-plane contacts: derived from g(x), proven, generated as NumPy."""


@main.command("list")
def list_() -> None:
    """List all geometries: g(x), closed and numerical parts."""
    from derive import load_geometry, view
    from derive.derivation import derive_law, with_closed_forms
    from derive.library import library

    laws = (derive_law(load_geometry(name)) for name in library())
    narrow = _console(columns=os.environ.get("COLUMNS", "")).width < _NARROW
    _print_table(view.listing((with_closed_forms(law) for law in laws), narrow))


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
    "--all",
    "every",
    is_flag=True,
    help="With --html: write a page for every body, and an index.",
)
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    help="With --html: the file to write; with --all, the directory (default: handbook).",
)
@click.option(
    "--slip",
    type=click.IntRange(1, 4),
    metavar="ORDER",
    help="Print the series of the slip zones up to this order instead; kappa is the direction of "
    "slip. Order 3 takes half a minute, order 4 much longer.",
)
@_limit
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
        raise click.UsageError("--html, --latex, --code and --slip exclude each other: give one")
    if (every or out) and not html:
        raise click.UsageError("--all and --out require --html: add it")
    if (name is None) != every:
        raise click.UsageError("give either NAME, a geometry or geometry file, or --all --html")
    if html:
        _show_page(name, out, limit) if name else _show_pages(out, limit)
        return
    assert name is not None
    if slip:
        click.echo(_apart(_slip_of, name, slip))
        return
    shown, remark = _apart(_sheet_of, name, "latex" if latex else code or "", limit)
    if remark:
        click.echo(remark, err=True)
    if isinstance(shown, str):
        click.echo(shown)
    else:
        _print(shown)


def _apart(
    function: "Callable[[tuple[Any, ...], Report], Shown]", name: str, *more: object
) -> Shown:
    """Apply a function to a geometry, for a file in another process with limits.

    In the other process a geometry file can neither end this one nor take time without end.
    """
    from derive import pipeline
    from derive.library import is_in_library
    from derive.parallel import in_processes

    bounds = None if is_in_library(name) else pipeline.STRANGERS
    with _status(f"reading {name}") as update:

        def report(what: str, stage: str) -> None:
            update(f"{what}: {stage}")

        (shown,) = in_processes(function, [(name, *more)], report, 1, bounds)
    return shown


def _sheet_of(asked: tuple[str, str, float], report: "Report") -> tuple[RenderableType, str]:
    """The proven sheet of a body for the terminal, in LaTeX or in a language, and a remark."""
    from derive import derive_sheet, load_geometry, prove_sheet, view
    from derive.derivation import NONE_IN_TIME, with_closed_forms

    name, form, limit = asked
    report(name, "reading g(x)")
    geometry = load_geometry(name)
    report(name, "deriving")
    sheet = derive_sheet(geometry)
    if not sheet.is_closed("load"):
        report(name, f"looking for closed forms, {limit:g} s at most")
        sheet = with_closed_forms(sheet, limit)
    report(name, "proving")
    sheet = prove_sheet(sheet).demand_proven()
    struck = sheet.remark.startswith(NONE_IN_TIME)
    remark = f"{geometry.name}: {sheet.remark}" if struck else ""
    if form == "latex":
        return sheet.latex, remark
    if form:
        from derive.codegen.languages import code_of

        return code_of(sheet, form), remark
    return view.formulas(sheet), remark


def _show_page(name: str, out: Path | None, limit: float) -> None:
    """Write the page of one body."""
    from derive.handbook.shelf import put_page

    (body,) = _built((name,), None, False, limit)
    text = _apart(_page_of, name, body, limit)
    path = out or Path(f"{body.name}.html")
    put_page(text, path)
    _print(f"Wrote {_shown(path.resolve())}")


def _page_of(asked: "tuple[str, Body, float]", report: "Report") -> str:
    """The page of a body that has been built."""
    from derive.handbook.page import page

    name, body, limit = asked
    return page(_sheet_of_body(name, body, limit, report), body)


def _sheet_of_body(name: str, body: "Body", limit: float, report: "Report") -> "FormulaSheet":
    """The sheet of a body that has been built."""
    from derive import derive_sheet, load_geometry
    from derive.derivation import with_closed_forms
    from derive.handbook.page import proven

    report(name, "reading g(x)")
    geometry = load_geometry(name)
    report(name, "deriving")
    return proven(with_closed_forms(derive_sheet(geometry), limit), body)


def _show_pages(out: Path | None, limit: float) -> None:
    """Write the pages of the library with their index."""
    from derive.handbook.page import entry, index, page
    from derive.handbook.shelf import demand_replaceable, put_pages
    from derive.library import library

    folder = out or Path("handbook")
    demand_replaceable(folder)
    bodies = _built(library(), None, False, limit)
    sheets = [
        _sheet_of_body(source, body, limit, lambda *_: None)
        for source, body in zip(library(), bodies, strict=True)
    ]
    pages = {f"{b.name}.html": page(s, b, index=True) for s, b in zip(sheets, bodies, strict=True)}
    pages["index.html"] = index([entry(s, b) for s, b in zip(sheets, bodies, strict=True)])
    put_pages(pages, folder)
    _print(
        f"Wrote {_shown((folder / 'index.html').resolve())} and the pages of {len(bodies)} bodies"
    )


_SENSES = (
    "kappa_left, kappa_right: directions of slip in the half-cycle that raises the shear load: 1 "
    "and 1 under moderate tension, 1 and -1 under large tension that rises, -1 and 1 under large "
    "tension that falls"
)


def _slip_of(asked: tuple[str, int], report: "Report") -> str:
    """The terms of both slip zones, one per line, then the meaning of their coefficients."""
    from derive import derive_sheet, load_geometry
    from derive.derivation import slip_series
    from derive.notation import text_of
    from derive.pipeline import TERMS

    name, order = asked
    report(name, "reading g(x)")
    geometry = load_geometry(name)
    report(name, "deriving")
    sheet = derive_sheet(geometry)
    report(name, TERMS)
    try:
        terms, known = slip_series(sheet, order)
    except ValueError as error:
        raise click.BadParameter(str(error), param_hint="--slip") from None
    zones = [
        f"d_{edge.name.lower()}, order {number}: {text_of(term)}"
        for edge, found in terms.items()
        for number, term in enumerate(found, 1)
    ]
    return "\n".join([*zones, *(f"{s} = {text_of(value)}" for s, value in known.items()), _SENSES])


@main.command(cls=_WithFormula)
@click.argument("name")
@click.argument("profile", metavar="G")
@click.option("--unit", "units", multiple=True, metavar="NAME=UNIT", help="Unit of a parameter.")
@click.option(
    "--meaning", "meanings", multiple=True, metavar="NAME=TEXT", help="Meaning of a parameter."
)
@click.option("--title", default="", help="First line of the file.")
@click.option(
    "--out", type=click.Path(path_type=Path), help="A directory, or a path that ends in .py."
)
def new(
    name: str,
    profile: str,
    units: tuple[str, ...],
    meanings: tuple[str, ...],
    title: str,
    out: Path | None,
) -> None:
    """Write the geometry file NAME.py from G, the text of g(x).

    G is for example "x**2/(2*R)".  Every name in G other than x becomes a parameter.  Units that
    are not given are derived from the requirement that g(x) be a length.  An existing file is never
    changed.
    """
    from derive.writing.apart import Asked, drafted
    from derive.writing.options import said
    from derive.writing.target import place, write_new

    asked = Asked(name, profile.strip(), title, said("--unit", units), said("--meaning", meanings))
    path = place(name, out)
    with _status(f"{name}: reading g(x)"):
        made = drafted(asked)
    write_new(path, made.text)
    shown = click.format_filename(_shown(path))
    click.echo(f"Wrote {shown}: g(x) = {made.g}")
    for parameter, unit, meaning in made.parameters:
        click.echo(f"  {parameter} [{unit}]  {meaning}")
    derive, file = _command(), shlex.quote(shown)
    click.echo(f"See its formulas:    {derive} show {file}")
    click.echo(f"Make a module of it: {derive} generate {file} --out DIRECTORY")


@main.command()
@click.argument("sources", nargs=-1, metavar="[NAME|FILE]...")
@click.option("--out", type=click.Path(path_type=Path), help="Write an importable package here.")
@click.option("--check", is_flag=True, help="Write nothing; fail if anything would change.")
@click.option("--fresh", is_flag=True, help="Derive everything again; --check always does this.")
@click.option(
    "--jobs",
    type=click.IntRange(min=1),
    metavar="N",
    help="Number of bodies derived at once (default: the number of cores).",
)
@_limit
def generate(
    sources: tuple[str, ...],
    out: Path | None,
    check: bool,
    fresh: bool,
    jobs: int | None,
    limit: float,
) -> None:
    """Derive, prove and write NumPy modules.

    Without arguments, these are the modules of the whole library; otherwise, of the geometries
    named.

    A body is taken from an earlier run if neither its geometry file nor the program has changed.
    Such bodies are kept in the directory DERIVE_CACHE or in the user's cache; if DERIVE_CACHE is
    empty, nothing is kept.
    """
    from derive import view
    from derive.codegen.publish import resolved
    from derive.pipeline import Order

    order = Order(sources, resolved(out) if out else None)
    bodies = _built(order.names, jobs, fresh or check, limit)
    if check:
        _report_drift(order, bodies)
        return
    changed = order.write(bodies)
    _print_table(view.summary(bodies))
    _print(f"{'Wrote' if changed else 'Nothing to change in'} {_shown(order.target)}")


@main.command()
@click.argument("file", required=False, type=click.Path(path_type=Path))
@click.option(
    "--format",
    "form",
    type=click.Choice(["table", "json", "markdown", "latex", "html"]),
    default="table",
    help="Format of the findings.",
)
@click.option("--explain", metavar="LABEL", help="Explain one claim: the steps and the numbers.")
@click.option(
    "--html",
    "page",
    type=click.Path(path_type=Path),
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
    type=click.Path(path_type=Path),
    metavar="NEW",
    help="FILE is a paper in LaTeX: read its displayed equations and write the claims file NEW.",
)
@click.option("--inline", is_flag=True, help="With --draft: also read relations within the text.")
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
    if drafted is not None:
        _draft(file, drafted, inline)
        return
    if inline:
        raise click.UsageError("--inline requires --draft: add it, or leave --inline out")
    if accepting:
        _accept(file, explain)
        return
    from derive import view
    from derive.paper import report
    from derive.paper.verdict import check as judged

    if page is not None or form == "html":
        from derive.handbook.shelf import put_page
        from derive.paper.page import as_html

    paper = _paper(file, explain)
    with _progress(len(paper.claims), ("checking",)) as step:
        findings = []
        for claim in paper.claims:
            step(claim.label, "checking")
            findings.append(judged(claim))
            step(claim.label, "")
    if form == "json":
        click.echo(report.as_json(findings))
    elif form == "markdown":
        click.echo(report.as_markdown(paper, findings))
    elif form == "latex":
        click.echo(report.as_latex(paper, findings))
    elif form == "html":
        click.echo(as_html(paper, findings))
    elif explain is not None:
        _print_table(view.explained(findings[0]))
    else:
        _print_table(view.checked(findings))
    if page is not None:
        put_page(as_html(paper, findings), page)
        _print(f"Wrote {_shown(page.resolve())}")
    elif form == "table" and explain is None:
        given = "" if file is None else f"{_typed(file)} "
        _print(f"More: {_command()} check {given}--explain CLAIM, or --html PAGE for all claims")
    wrong = report.unexpected(findings)
    if wrong:
        labels = ", ".join(finding.claim.label for finding in wrong)
        _complain("Not as expected", labels)
        sys.exit(FELL_SHORT)


@main.command()
@click.argument("file", type=click.Path(path_type=Path))
@click.option("--f", "friction", type=float, required=True, help="Coefficient of friction.")
@click.option(
    "--dQ",
    "dQ",
    type=float,
    metavar="N/M",
    help="Change of the shear load, from its lowest to its highest value, if FILE has no dq.",
)
@click.option(
    "--dsigma",
    type=float,
    metavar="PA",
    help="Change of the bulk tension over the same half-cycle.",
)
@click.option("--unit", "units", multiple=True, metavar="NAME=UNIT", help="Unit of x or of p.")
@click.option("--html", type=click.Path(path_type=Path), help="Also write a page with pictures.")
@click.option(
    "--csv", "table", type=click.Path(path_type=Path), help="Also write the results, in SI units."
)
def edge(
    file: Path,
    friction: float,
    dQ: float | None,
    dsigma: float | None,
    units: tuple[str, ...],
    html: Path | None,
    table: Path | None,
) -> None:
    """Find the slip zones of both edges from a table.

    FILE is a finite-element table; the coefficients of both edges are found from it.  In FILE, a
    line above the numbers names the columns with their units, such as x [mm], p [MPa], dq [MPa].
    dq is the change of the shear traction in a run without slip.  A column `step` distinguishes
    load steps; the half-cycle leads from the first to the last of them.
    """
    from derive.edge import report
    from derive.edge.find import find
    from derive.edge.table import read
    from derive.files import write_whole
    from derive.writing.options import said

    if not 0 < friction < inf:
        raise click.BadParameter("must be a finite number above zero", param_hint="--f")
    given = said("--unit", units)
    if wrong := given.keys() - {"x", "p"}:
        raise click.BadParameter(
            f"{wrong.pop()!r} is neither x nor p: write x=UNIT or p=UNIT", param_hint="--unit"
        )
    if table is not None and table.exists():
        head = table.read_bytes()[: len(report.CSV_HEAD)] if table.is_file() else b""
        if head != report.CSV_HEAD.encode():
            why = f"{str(table)!r} exists and is not a table of results: give another file"
            raise click.BadParameter(why, param_hint="--csv")
    steps = read(file, given)
    found = find(steps, file.name, friction, dQ, dsigma)
    click.echo(report.as_text(found))
    if html is not None:
        from derive.handbook.shelf import put_page

        put_page(report.as_page(found, steps, file.name), html)
        click.echo(f"Wrote {_shown(html.absolute())}")
    if table is not None:
        try:
            table.parent.mkdir(parents=True, exist_ok=True)
            write_whole(report.as_csv(found).encode(), table)
        except OSError as error:
            raise click.BadParameter(str(error), param_hint="--csv") from None
        click.echo(f"Wrote {_shown(table.absolute())}")


def _draft(file: Path | None, new: Path, inline: bool) -> None:
    """Read the displayed equations of a paper and write them as claims."""
    from derive.paper.draft import draft, write

    if file is None:
        raise click.UsageError("--draft reads a paper: give FILE, in LaTeX")
    if new.exists():
        raise click.UsageError(f"{new} already exists: give the name of a new file with --draft")
    with _status("reading the displayed equations"):
        made = draft(file, inline)
    write(made, new)
    click.echo(f"{made.environments} displayed equations with {len(made.parts)} statements")
    named, symbols = made.named
    click.echo(f"Wrote {_shown(new.absolute())}: {made.understood} statements read")
    click.echo(f"{symbols} symbols, {named} with a proposed meaning")
    for line in made.unread:
        click.echo(f"not read: {line}")
    for line in made.notes:
        click.echo(f"note: {line}")


def _accept(file: Path | None, label: str | None) -> None:
    """Show each reading that is not yet accepted, then write those that the user accepts."""
    from derive.paper.accept import accept
    from derive.paper.userfile import open_readings

    if file is None or label is not None:
        raise click.UsageError("--accept needs a claims file, without --explain: give FILE alone")
    found = open_readings(file)
    readings = [reading for reading in found if reading.understood]
    accepted = []
    for number, reading in enumerate(readings, 1):
        click.echo(f"\n{number} of {len(readings)}: {reading.label}")
        click.echo(f"  LaTeX       {reading.latex.strip()}")
        click.echo(f"  understood  {reading.understood}")
        if reading.accepted:
            click.echo(f"  in the file {reading.accepted}")
        for key, entry in reading.beside.items():
            click.echo(f"  {key:<11} {entry}")
        if reading.why:
            click.echo(f"  unchecked   {reading.why}")
        answer = click.prompt(
            "Is this what is printed?",
            type=click.Choice(["y", "n", "q"]),
            default="n",
            show_default=True,
        )
        if answer == "q":
            break
        if answer == "y":
            accepted.append(reading)
    if accepted:
        accept(file, accepted)
    left = len(readings) - len(accepted)
    click.echo(f"{len(accepted)} accepted, {left} left")
    for reading in found:
        if not reading.understood:
            click.echo(f"unchecked: {reading.label}: {reading.why}")


def _paper(file: Path | None, label: str | None) -> "Paper":
    """All claims of a paper, or only the claim with the given label."""
    from derive.errors import UnknownClaim
    from derive.paper.userfile import built_in, read_claims

    with _status("deriving the formulas for comparison with the paper"):
        source = built_in() if file is None else read_claims(file)
    if label is None:
        return source
    labels = tuple(claim.label for claim in source.claims)
    if label not in labels:
        raise UnknownClaim(label, labels)
    return replace(source, claims=(source[label],))


def _built(sources: Sequence[str], jobs: int | None, fresh: bool, limit: float) -> "list[Body]":
    """Build every body under a progress bar, and report the searches that reached their limit."""
    from derive.cache import distrusted
    from derive.parallel import cores
    from derive.pipeline import STAGES, build_all

    if folder := distrusted():
        why = "nothing is kept in this directory, because others may write to it"
        remedy = "remove their permission to write, or set DERIVE_CACHE to another directory"
        click.echo(f"{folder}: {why}: {remedy}", err=True)
    with _progress(len(sources), STAGES) as step:
        bodies = build_all(sources, step, jobs or cores(), fresh, limit)
    for body in bodies:
        if body.struck:
            click.echo(f"{body.name}: {body.struck}", err=True)
    return bodies


def _report_drift(order: "Order", bodies: "Sequence[Body]") -> None:
    from derive import view

    found = order.check(bodies)
    if not found:
        _print(f"{_shown(order.target)} is up to date")
        return
    _print(view.drift(found))
    where = f" --out {_shown(order.target)}" if order.folder else ""
    _print(f"Update with: {_command()} generate{''.join(f' {s}' for s in order.sources)}{where}")
    sys.exit(FELL_SHORT)


@contextmanager
def _status(words: str) -> Iterator[Callable[[str], None]]:
    """A spinner with words, which the function that is yielded changes."""
    console = _console(stderr=True)
    now = [words]
    with _told_after_a_while(console, now), console.status(words) as status:

        def update(words: str) -> None:
            now[0] = words
            status.update(words)

        yield update


@contextmanager
def _told_after_a_while(console: Console, now: Sequence[str]) -> Iterator[None]:
    """Print once what takes so long, where nothing that moves is shown."""

    def tell() -> None:
        with suppress(OSError, ValueError):  # standard error is closed
            click.echo(f"Still at work after {_PATIENCE:g} s: {now[0]}", err=True)

    timer = Timer(_PATIENCE, tell)
    timer.daemon = True
    if not console.is_terminal:
        timer.start()
    try:
        yield
    finally:
        timer.cancel()


@contextmanager
def _progress(bodies: int, stages: Sequence[str]) -> Iterator[Callable[[str, str], None]]:
    """A progress bar; `step` tells it that a body enters a stage, or is done if there is none."""
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn())
    console = _console(stderr=True)
    bar = Progress(
        *columns,
        TimeElapsedColumn(),
        console=console,
        transient=True,
        disable=not console.is_terminal,
    )
    now = ["starting"]
    with _told_after_a_while(console, now), bar:
        task = bar.add_task("", total=bodies * len(stages))
        passed: dict[str, int] = {}

        def step(body: str, stage: str) -> None:
            passed[body] = stages.index(stage) if stage in stages else len(stages)
            others = sum(n < len(stages) for name, n in passed.items() if name != body)
            words = f"{body}: {stage}" + (f", {others} more in progress" if others else "")
            now[0] = words
            bar.update(task, description=words, completed=sum(passed.values()))

        yield step


def _console(stderr: bool = False, columns: str = "") -> Console:
    """A console: FORCE_COLOR also colours piped output, but progress is shown on terminals only."""
    is_terminal = (sys.stderr if stderr else sys.stdout).isatty()
    return Console(
        stderr=stderr,
        force_terminal=False if stderr and not is_terminal else None,
        width=None if is_terminal or columns else _WIDE,
        highlight=False,
        markup=False,
        emoji=False,
    )


def _print(what: RenderableType, columns: str = "") -> None:
    """Print, without the blanks that pad each column to its width."""
    console = _console(columns=columns)
    with console.capture() as printed:
        console.print(what)
    text = "\n".join(line.rstrip() for line in printed.get().split("\n"))
    click.echo(text, nl=False, color=console.color_system is not None)


def _print_table(what: RenderableType) -> None:
    """Print a table; COLUMNS also holds for pipes, and formulas and file names are not broken."""
    _print(what, os.environ.get("COLUMNS", ""))


def _complain(what: str, message: str) -> None:
    click.echo(f"{click.style(f'{what}:', fg='red', bold=True)} {message}", err=True)


def _command() -> str:
    """This command as the user can type it: derive, .venv/bin/derive, or python -m derive."""
    called = Path(sys.argv[0])
    if called.parent == Path(__file__).parent:  # python -m derive
        return f"{_typed(Path(sys.orig_argv[0]))} -m derive"
    if called.stem != "derive":  # called by another program
        return "derive"
    return _typed(called)


def _typed(program: Path) -> str:
    """A program by its name if the shell finds it by that, otherwise by its shortest path."""
    found = which(program.name)
    if found and Path(found).absolute() == program.absolute():
        return shlex.quote(program.name)
    if program.parent == Path():
        return shlex.quote(str(program))
    return shlex.quote(_shown(program.absolute()))


def _shown(path: Path) -> str:
    """A path as the user would type it."""
    here = Path.cwd()
    return str(path.relative_to(here) if path.is_relative_to(here) else path)


if __name__ == "__main__":
    main()
