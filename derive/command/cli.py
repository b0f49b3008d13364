"""The command `derive`: read the arguments, call the package, print the results.

Exit status: 0 after success, 1 if a check failed, 2 if the input was invalid, 130 after Ctrl-C, 141
if the reader of the output has closed it.  SymPy is imported only by the commands that need it, so
that help appears at once.
"""

import errno
import os
import shlex
import signal
import sys
import unicodedata
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import replace
from math import inf
from pathlib import Path
from traceback import walk_tb
from typing import TYPE_CHECKING, Any

import click

from derive.command.errors import BadLimit, BadPage, BadPath, NotProven, UserError
from derive.command.limit import DEFAULT
from derive.command.processes import end
from derive.command.terminal import (
    command,
    complain,
    is_narrow,
    output,
    output_table,
    path_of,
    progress,
    remark,
    status,
    typed,
)

if TYPE_CHECKING:
    from derive.check.claim import Paper
    from derive.pipeline import Order
    from derive.sheet.built import Body

FELL_SHORT, BAD_INPUT, INTERRUPTED, UNREAD = 1, 2, 130, 141
"""Exit statuses; the last two are what a shell reports for SIGINT and SIGPIPE."""


class _Path(click.ParamType):
    """A path without control characters that is not empty, which would mean the current folder."""

    name = "path"

    def convert(
        self, value: str, param: click.Parameter | None, context: click.Context | None
    ) -> Path:
        if not value or any(unicodedata.category(character) == "Cc" for character in value):
            is_option = isinstance(param, click.Option)
            assert param is not None
            raise BadPath(param.opts[0] if is_option else param.human_readable_name, value)
        return Path(value)


_PATH = _Path()


def _time(context: click.Context, option: click.Parameter, seconds: float) -> float:
    """Return the seconds; raise BadLimit if they are not a valid time limit."""
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
    help="Time limit for the search for closed forms of one body's integrals.",
)


class _Commands(click.Group):
    """Show a user's mistake as a single message, and exit with the matching status."""

    def make_context(self, *args: Any, **more: Any) -> click.Context:
        """Read the arguments; `--help` and `--version` print here."""
        with _stopped_from_outside():
            return super().make_context(*args, **more)

    def invoke(self, ctx: click.Context) -> object:
        try:
            with _stopped_from_outside():
                done = super().invoke(ctx)
                sys.stdout.flush()
                return done
        except UserError as error:
            complain("Error", error.message.replace("`derive ", f"`{command()} "))
            ctx.exit(BAD_INPUT)
        except NotProven as error:
            complain("Not proven", str(error))
            ctx.exit(FELL_SHORT)

    def main(self, *args: Any, **more: Any) -> Any:
        """Run a command, and report what the system refused."""
        try:
            _demand_surroundings()
            signal.signal(signal.SIGTERM, end)
            return super().main(*args, **more)
        except OSError as error:
            complain("Error", _what_failed(error))
            _forget_the_output()
            sys.exit(BAD_INPUT)


@contextmanager
def _stopped_from_outside() -> Iterator[None]:
    """End with the status that shells use if Ctrl-C is pressed, or the output is closed."""
    try:
        yield
    except (KeyboardInterrupt, click.Abort):  # a question ends with Abort
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        remark("Interrupted")
        sys.exit(INTERRUPTED)
    except BrokenPipeError:
        _forget_the_output()
        sys.exit(UNREAD)


def _what_failed(error: OSError) -> str:
    """What the system refused, and where."""
    passed = [frame.f_code for frame, _ in walk_tb(error.__traceback__)]
    flushing = passed[-1] is _Commands.invoke.__code__
    if flushing or {click.echo.__code__, output.__code__} & {*passed}:
        return f"standard output cannot be written: {error.strerror}"
    return f"{error.strerror}{f': {error.filename}' if error.filename else ''}"


def _demand_surroundings() -> None:
    """Check that there is a standard output and a working directory.

    A closed standard error becomes the null device; the next file would otherwise take its place.
    """
    if sys.stdout is None:
        raise OSError(errno.EBADF, "the standard output is closed, so nothing can be printed")
    if sys.stderr is None:
        os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
        os.set_inheritable(2, True)
        sys.stderr = os.fdopen(2, "w", closefd=False)
    try:
        Path.cwd()
    except OSError as error:
        why = "the working directory no longer exists: change to another directory"
        raise OSError(error.errno, why) from error


def _forget_the_output() -> None:
    """Prevent a second attempt, at the end of the process, to write the output that failed."""
    with suppress(OSError, AttributeError):  # closed, or not a file
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


class _WithFormula(click.Command):
    """Accept a formula such as -x + b as an argument; -h is the only one-letter option."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        shielded = [
            f" {arg}" if arg[:1] == "-" != arg[1:2] and arg != "-h" else arg for arg in args
        ]
        return super().parse_args(ctx, shielded)


@click.group(cls=_Commands, context_settings={"help_option_names": ["-h", "--help"]})
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
    output_table(view.listing((with_closed_forms(law) for law in laws), is_narrow()))


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
    type=_PATH,
    help="With --html: the file to write; with --all, the directory (default: handbook).",
)
@click.option(
    "--slip",
    type=click.IntRange(1, 2),
    metavar="ORDER",
    help="Print the series of the slip zones up to this order instead; kappa is the direction of "
    "slip.",
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
        raise click.UsageError("--html, --latex, --code and --slip cannot be combined: give one")
    if (every or out) and not html:
        raise click.UsageError("--all and --out require --html: add it")
    if (name is None) != every:
        raise click.UsageError("give either NAME, a geometry or geometry file, or --all --html")
    if html:
        _show_page(name, out, limit) if name else _show_pages(out, limit)
        return
    from derive.command.showing import apart, sheet_of, slip_of

    assert name is not None
    if slip:
        click.echo(apart(slip_of, name, slip))
        return
    shown, said = apart(sheet_of, name, "latex" if latex else code or "", limit)
    if said:
        remark(said)
    if isinstance(shown, str):
        click.echo(shown)
    else:
        output_table(shown)


def _show_page(name: str, out: Path | None, limit: float) -> None:
    """Write the page of one body."""
    import derive.handbook  # noqa: F401 - reports a missing library at once
    from derive.command.shelf import demand_page, put_page
    from derive.command.showing import apart, page_of
    from derive.pipeline import stated_name

    demand_page(out or Path(f"{stated_name(name)}.html"))
    (body,) = _built((name,), None, False, limit)
    path = out or Path(f"{body.name}.html")
    put_page(apart(page_of, name, body, limit), path)
    output(f"Wrote {path_of(path.resolve())}")


def _show_pages(out: Path | None, limit: float) -> None:
    """Write the pages of the library with their index."""
    import derive.handbook  # noqa: F401 - reports a missing library at once
    from derive.body.library import library
    from derive.command.folder import demand_replaceable
    from derive.command.shelf import put_pages
    from derive.command.showing import handbook

    folder = out or Path("handbook")
    demand_replaceable(folder, BadPage)
    bodies = _built(library(), None, False, limit)
    put_pages(handbook(bodies, limit), folder)
    index = path_of((folder / "index.html").resolve())
    output(f"Wrote {index} and the pages of {len(bodies)} bodies")


@main.command(cls=_WithFormula)
@click.argument("name")
@click.argument("profile", metavar="G")
@click.option("--unit", "units", multiple=True, metavar="NAME=UNIT", help="Unit of a parameter.")
@click.option(
    "--meaning", "meanings", multiple=True, metavar="NAME=TEXT", help="Meaning of a parameter."
)
@click.option("--title", default="", help="First line of the file.")
@click.option("--out", type=_PATH, help="A directory, or a path that ends in .py.")
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
    from derive.command.name_values import said
    from derive.command.new_in_process import Asked, drafted
    from derive.command.target import place, write_new

    asked = Asked(name, profile.strip(), title, said("--unit", units), said("--meaning", meanings))
    path = place(name, out)
    with status(f"{name}: reading g(x)"):
        made = drafted(asked)
    write_new(path, made.text)
    shown = click.format_filename(path_of(path))
    click.echo(f"Wrote {shown}: g(x) = {made.g}")
    for parameter, unit, meaning in made.parameters:
        click.echo(f"  {parameter} [{unit}]  {meaning}")
    derive, file = command(), shlex.quote(shown)
    click.echo(f"See its formulas:    {derive} show {file}")
    click.echo(f"Generate a module:   {derive} generate {file} --out DIRECTORY")


@main.command()
@click.argument("sources", nargs=-1, metavar="[NAME|FILE]...")
@click.option("--out", type=_PATH, help="Write an importable package here.")
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

    Without arguments, modules are written for the whole library; otherwise, only for the geometries
    named.  A package that --out names is replaced as a whole.

    A body is taken from an earlier run if neither its geometry file nor the program has changed.
    Such bodies are kept in the directory that the environment variable DERIVE_CACHE names, or else
    in the user's cache; if DERIVE_CACHE is empty, nothing is kept.
    """
    from derive.codegen.publish import resolved
    from derive.command import view
    from derive.pipeline import Order

    order = Order(sources, resolved(out) if out else None, writes=not check)
    bodies = _built(order.names, jobs, fresh or check, limit)
    if check:
        _report_drift(order, bodies)
        return
    changed = order.write(bodies)
    output_table(view.summary(bodies))
    output(f"{'Wrote' if changed else 'Nothing to change in'} {path_of(order.target)}")
    if lost := [d.name for d in changed if d.removed and "/" not in d.name]:
        output(f"Removed {', '.join(lost)}: name all bodies of a package in one command")


@main.command()
@click.argument("file", required=False, type=_PATH)
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
    type=_PATH,
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
    type=_PATH,
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
    if drafted is not None:
        _draft(file, drafted, inline)
        return
    if inline:
        raise click.UsageError("--inline requires --draft: add it, or leave --inline out")
    if accepting:
        _accept(file, explain)
        return
    from derive.check import report
    from derive.check.verdict import check as judged
    from derive.command import view

    forms = {**report.FORMS}
    if page is not None or form == "html":
        from derive.check.page import as_html
        from derive.command.shelf import demand_page, put_page

        forms["html"] = as_html
    if page is not None:
        demand_page(page, "--html")

    paper = _paper(file, explain)
    with progress(len(paper.claims), ("checking",)) as step:
        findings = []
        for claim in paper.claims:
            step(claim.name, "checking")
            findings.append(judged(claim))
            step(claim.name, "")
    if form in forms:
        click.echo(forms[form](paper, findings))
    elif explain is not None:
        output_table(view.explained(findings))
    else:
        output_table(view.checked(findings))
    if page is not None:
        put_page(as_html(paper, findings), page, "--html")
        output(f"Wrote {path_of(page.resolve())}")
    elif form == "table" and explain is None:
        given = "" if file is None else f"{typed(file)} "
        output(f"More: {command()} check {given}--explain CLAIM, or --html PAGE for all claims")
    wrong = report.unexpected(findings)
    if wrong:
        complain("Not as expected", "; ".join(finding.claim.name for finding in wrong))
        sys.exit(FELL_SHORT)


@main.command()
@click.argument("file", type=_PATH)
@click.option("--f", "friction", type=float, required=True, help="Coefficient of friction.")
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
@click.option("--unit", "units", multiple=True, metavar="NAME=UNIT", help="Unit of x or of p.")
@click.option("--html", type=_PATH, help="Also write a page with pictures.")
@click.option("--csv", "table", type=_PATH, help="Also write the results, in SI units.")
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
    dq is the change in the shear traction in a run without slip.  A column `step` distinguishes
    load steps; the half-cycle runs from the first of them to the last.
    """
    from derive.command.name_values import said
    from derive.command.shelf import MARK, demand_page, put_page
    from derive.edge import report
    from derive.edge.find import find
    from derive.edge.table import read

    if not 0 < friction < inf:
        raise click.BadParameter("must be a finite number above zero", param_hint="--f")
    given = said("--unit", units)
    if wrong := given.keys() - {"x", "p"}:
        raise click.BadParameter(
            f"{wrong.pop()!r} is neither x nor p: write x=UNIT or p=UNIT", param_hint="--unit"
        )
    targets = ((html, "--html", MARK), (table, "--csv", report.CSV_HEAD))
    for path, option, mark in targets:
        if path is not None:
            demand_page(path, option, mark)
    with status(f"fitting the edges of {file.name}"):
        steps = read(file, given)
        found = find(steps, file.name, friction, dQ, dsigma)
    click.echo(report.as_text(found))
    for path, option, mark in targets:
        if path is not None:
            page = path is html
            text = report.as_page(found, steps, file.name) if page else report.as_csv(found)
            put_page(text, path, option, mark)
            click.echo(f"Wrote {path_of(path.absolute())}")


def _draft(file: Path | None, new: Path, inline: bool) -> None:
    """Read the displayed equations of a paper and write them as claims."""
    from derive.check.draft import demand_new, draft, write

    if file is None:
        raise click.UsageError("--draft reads a paper: give FILE, in LaTeX")
    demand_new(new)
    with status("reading the displayed equations"):
        made = draft(file, inline)
    write(made, new)
    click.echo(f"{made.environments} displayed equations with {len(made.parts)} statements")
    named, symbols = made.named
    click.echo(f"Wrote {path_of(new.absolute())}: {made.understood} statements read")
    click.echo(f"{symbols} symbols, {named} with a proposed meaning")
    for line in made.unread:
        click.echo(f"not read: {line}")
    for line in made.notes:
        click.echo(f"note: {line}")


def _accept(file: Path | None, label: str | None) -> None:
    """Show each reading that is not yet accepted, then write those that the user accepts."""
    from derive.check.accept import accept, demand_writable
    from derive.check.userfile import open_readings

    if file is None or label is not None:
        raise click.UsageError("--accept needs a claims file, without --explain: give FILE alone")
    demand_writable(file)
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


def _paper(file: Path | None, name: str | None) -> "Paper":
    """All claims of a paper, or only those with a given label, name or equation number."""
    from derive.check.userfile import built_in, read_claims
    from derive.command.errors import UnknownClaim

    with status("deriving the formulas for comparison with the paper"):
        source = built_in() if file is None else read_claims(file)
    if name is None:
        return source
    if not (chosen := source.called(name)):
        raise UnknownClaim(name, tuple(claim.name for claim in source.claims))
    return replace(source, claims=chosen)


def _built(sources: Sequence[str], jobs: int | None, fresh: bool, limit: float) -> "list[Body]":
    """Build every body under a progress bar, and report the searches that reached their limit."""
    from derive.command.cache import distrusted
    from derive.command.processes import cores
    from derive.pipeline import STAGES, build_all

    if why := distrusted():
        remark(why)
    with progress(len(sources), STAGES) as step:
        bodies = build_all(sources, step, jobs or cores(), fresh, limit)
    for body in bodies:
        if body.struck:
            remark(f"{body.name}: {body.struck}")
    return bodies


def _report_drift(order: "Order", bodies: "Sequence[Body]") -> None:
    from derive.command import view

    found = order.check(bodies)
    if not found:
        output(f"{path_of(order.target)} is up to date")
        return
    output(view.drift(found))
    where = f" --out {path_of(order.target)}" if order.folder else ""
    output(f"Update with: {command()} generate{''.join(f' {s}' for s in order.sources)}{where}")
    sys.exit(FELL_SHORT)


if __name__ == "__main__":
    main()
