"""The output of the commands: tables and formula sheets for a terminal.

In:  sheets, bodies, differences, findings.
Out: renderable objects of the library rich, or lines.

Only functions that show formulas import SymPy.
"""

from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING

import click
from rich.console import Group, RenderableType
from rich.table import Column, Table
from rich.text import Text

from derive.proof.verdict import Verdict
from derive.sheet.built import BuiltBody, by_form

if TYPE_CHECKING:
    from derive.check.verdict import Finding
    from derive.codegen.publish import Difference
    from derive.sheet.formulas import FormulaSheet


def listing(sheets: "Iterable[FormulaSheet]") -> Group:
    """All geometries: g(x), and which parts are in closed form or numerical."""
    from derive.sheet.notation import text_of

    return Group(*(_listed(sheet, text_of(sheet.geometry.g)) for sheet in sheets))


def _listed(sheet: "FormulaSheet", g: str) -> Group:
    rest = Table.grid(padding=(0, 2, 0, 0))
    closed, numerical = map(_row, by_form(sheet.is_closed))
    for head, words in (("g(x)", g), ("closed form", closed), ("numerical", numerical)):
        rest.add_row(Text(f"  {head}"), words)
    geometry = sheet.geometry
    return Group(Text.assemble((geometry.name, "bold cyan"), f"  {geometry.title}"), rest, "")


def summary(bodies: Iterable[BuiltBody]) -> Table:
    """A table of the bodies built: closed or numerical parts, proofs by kind, and time."""
    table = Table(
        Column("geometry", no_wrap=True),
        *("closed form", "numerical"),
        Column("proven", justify="right"),
        Column("by 30 digits", justify="right"),
        Column("time", no_wrap=True, justify="right"),
    )
    for body in bodies:
        table.add_row(
            Text(body.name, style="bold cyan"),
            _row(body.closed),
            _row(body.numerical),
            Text(str(len(body.formulas(Verdict.PROVEN))), style="green"),
            Text(str(len(body.formulas(Verdict.NUMERICAL))), style="yellow"),
            f"{body.seconds:.1f} s",
        )
    return table


def _row(words: Iterable[str]) -> str:
    """Every word once, separated by commas."""
    return ", ".join(dict.fromkeys(words)) or "-"


def formulas(sheet: "FormulaSheet") -> Group:
    """A formula sheet for a terminal."""
    from derive.sheet.notation import text_of

    table = Table.grid(padding=(0, 2, 1, 0))
    for name, formula in sheet.items():
        table.add_row(
            Text(name, style="bold cyan"),
            Text.assemble(
                (f"{sheet.equation(name)}\n", "bold"),
                *([f"computed as {computed}\n"] if (computed := sheet.computed_as(name)) else []),
                f"{formula.meaning} [{formula.unit}], if {formula.assumptions}\n",
                (f"{formula.proof or 'not proven yet'}\n", "green"),
                (formula.source, "dim"),
            ),
        )
    for symbol, definition in (sheet.definitions | sheet.computed_definitions).items():
        table.add_row(Text(str(symbol), style="cyan"), f"{symbol} = {text_of(definition)}")
    for q in sheet.quantities:
        table.add_row(Text(q.name, style="cyan"), Text(f"{q.meaning} [{q.unit}]"))
    remark = [sheet.remark] if sheet.remark else []
    return Group(Text(sheet.title, style="bold"), *remark, "", table)


def drift(found: "Iterable[Difference]") -> Iterator[str]:
    """The files that differ from the generated ones, with their differences, line by line."""
    for difference in found:
        yield click.style(f"{difference.name}: {difference.what}", fg="red", bold=True)
        for line in difference.diff.splitlines():
            yield click.style(line, fg=_DIFF.get(line[:1]))


_DIFF = {"+": "green", "-": "red", "@": "cyan"}


_VERDICTS = {
    "holds": "green",
    "by definition": "green",
    "numerical": "yellow",
    "convention": "magenta",
    "fails": "bold red",
    "unchecked": "blue",
}


def checked(findings: "Sequence[Finding]") -> Group:
    """The verdict on every claim, failures first, and a remark on each that is not true."""
    from derive.check import report

    table = Table("claim", Column("verdict", no_wrap=True), "rests on", "description")
    findings = report.in_order(findings)
    for finding in findings:
        verdict = _verdict_of(finding)
        claim = finding.claim
        rests_on = Text(finding.ground)
        if finding.unsound:
            rests_on.highlight_words([f"({finding.unsound})"], _VERDICTS[finding.unsound])
        table.add_row(Text(claim.name, style="cyan"), verdict, rests_on, claim.entry.says)
    parts: list[RenderableType] = [table]
    for finding in findings:
        if remark := report.remark(finding):
            line = Text.assemble((finding.claim.name, "cyan"), ": ", _verdict_of(finding), ": ")
            parts.append(line.append(remark))
    told = f"{report.summary(findings)}\n{report.coverage(findings)}"
    return Group(*parts, Text(told, style="bold"))


def _verdict_of(finding: "Finding") -> Text:
    from derive.check import report

    told = Text(report.verdict(finding), style=_VERDICTS[finding.verdict])
    told.highlight_words(["units do not fit", "not as expected"], "bold red")
    return told


def explained(findings: "Sequence[Finding]") -> Group:
    """One claim, or all of one equation."""
    return Group(*(part for each in findings for part in (*_explained(each), "")))


def _explained(finding: "Finding") -> list[RenderableType]:
    """One claim: the formula it was compared with, the steps, and the numbers."""
    from derive.check import report

    entries = Table.grid(Column(style="bold", no_wrap=True), "", padding=(0, 2, 0, 0))
    for told in report.explanation(finding):
        for n, line in enumerate(told.lines):
            entries.add_row("" if n else told.name, Text(line))
    parts: list[RenderableType] = [Text(finding.claim.name, style="bold cyan"), entries]
    if rows := report.numbers(finding):
        table = Table("point", "left", "right", title="numbers", title_justify="left")
        for row in rows:
            table.add_row(*row)
        parts.append(table)
    return parts
