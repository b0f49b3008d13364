"""What the commands print: tables and formula sheets in a terminal.

In:  sheets, bodies, differences, findings.
Out: renderables of rich.

SymPy is imported by what shows formulas, not by what shows bodies.
"""

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from rich.console import Group, RenderableType
from rich.table import Column, Table
from rich.text import Text

from derive.body import Body, by_form
from derive.proof.verdict import Verdict

if TYPE_CHECKING:
    from derive.codegen.publish import Difference
    from derive.paper.claim import Paper
    from derive.paper.verdict import Finding
    from derive.sheet import FormulaSheet


def listing(sheets: "Iterable[FormulaSheet]") -> Table:
    """Every geometry, its g(x), what is closed form and what is numerical."""
    from derive.notation import text_of

    names = Column("geometry", no_wrap=True)
    table = Table(names, Column("g(x)", overflow="fold"), "closed form", "numerical", "body")
    for sheet in sheets:
        closed, numerical = by_form(sheet.is_closed)
        table.add_row(
            Text(sheet.geometry.name, style="bold cyan"),
            text_of(sheet.geometry.g),
            _row(closed),
            _row(numerical),
            sheet.geometry.title,
        )
    return table


def summary(bodies: Iterable[Body]) -> Table:
    """What was built: closed form or numerical, how each formula was proven, time."""
    table = Table(
        Column("geometry", no_wrap=True),
        *("closed form", "numerical", "proved", "agrees to 30 digits or more", "time"),
    )
    for body in bodies:
        table.add_row(
            Text(body.name, style="bold cyan"),
            _row(body.closed),
            _row(body.numerical),
            Text(_row(map(_stem, body.formulas(Verdict.PROVED))), style="green"),
            Text(_row(map(_stem, body.formulas(Verdict.NUMERICAL))), style="yellow"),
            "kept" if body.kept else f"{body.seconds:.1f} s",
        )
    return table


def _row(words: Iterable[str]) -> str:
    """Every word once, in a row."""
    return ", ".join(dict.fromkeys(words)) or "-"


def _stem(name: str) -> str:
    """A formula's name, of both edges the same."""
    return name.replace("_left", "").replace("_right", "")


def formulas(sheet: "FormulaSheet") -> Group:
    """A formula sheet for a terminal."""
    from derive.notation import text_of

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


def drift(found: "Iterable[Difference]") -> Group:
    """Which files differ from what is generated, and how."""
    parts: list[RenderableType] = []
    for difference in found:
        parts.append(Text(f"{difference.name}: {difference.what}", style="bold red"))
        if difference.diff:
            parts += [Text(line, style=_DIFF.get(line[:1], "")) for line in difference.lines]
    return Group(*parts)


_DIFF = {"+": "green", "-": "red", "@": "cyan"}


_VERDICTS = {
    "holds": "green",
    "by definition": "green",
    "numerical": "yellow",
    "convention": "magenta",
    "fails": "bold red",
    "unchecked": "blue",
}


def checked(paper: "Paper", findings: "Sequence[Finding]") -> Group:
    """What was found of every claim of a paper, which sign each section takes, and its errata."""
    from derive.paper import report

    table = Table("claim", "place", "verdict", "says")
    for finding, row in zip(findings, report.rows(findings), strict=True):
        verdict = Text(str(row.verdict), style=_VERDICTS[row.verdict])
        if not row.expected:
            verdict.append(" (unexpected)", style="bold red")
        table.add_row(Text(row.label, style="cyan"), row.place, verdict, finding.claim.says)
    parts: list[RenderableType] = [table]
    parts += [Text(f"sign of the {line}", style="dim") for line in report.signs(paper, findings)]
    parts += [Text(line, style="bold red") for line in report.units(findings)]
    parts += [Text(line) for line in report.reasons(findings)]
    parts += map(_erratum, report.errata(findings))
    return Group(*parts, Text(report.summary(findings), style="bold"))


def _erratum(finding: "Finding") -> Group:
    """One error: as printed, as corrected, why, and what it does."""
    from derive.paper import report

    verdict = Text(str(finding.verdict), style=_VERDICTS[finding.verdict])
    head = Text.assemble("\n", verdict, (f"  {finding.claim.place}", "bold"))
    lines = [
        Text.assemble((f"  {heading:12}", "cyan"), text)
        for heading, text in (
            ("printed", report.printed(finding.claim)),
            ("corrected", report.corrected(finding)),
            ("evidence", report.evidence(finding)),
            ("consequence", finding.claim.consequence),
        )
        if text
    ]
    return Group(head, *lines)


def explained(finding: "Finding") -> Group:
    """One claim: what it was compared with, by which steps, and the numbers."""
    from derive.paper import report

    parts: list[RenderableType] = [Text(finding.claim.label, style="bold cyan")]
    for heading, lines in report.explanation(finding):
        parts.append(Text(heading, style="bold"))
        parts += [Text(f"    {line}") for line in lines]
    return Group(*parts)
