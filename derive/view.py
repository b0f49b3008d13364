"""What the commands print: tables and formula sheets in a terminal.

In:  sheets, bodies, differences.
Out: renderables of rich.

SymPy is imported by what shows formulas, not by what shows bodies.
"""

from collections.abc import Iterable
from typing import TYPE_CHECKING

from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from derive.body import Body, by_form
from derive.proof.verdict import Verdict

if TYPE_CHECKING:
    from derive.codegen.publish import Difference
    from derive.sheet import FormulaSheet


def listing(sheets: "Iterable[FormulaSheet]") -> Table:
    """Every geometry, its g(x), what is closed form and what is numerical."""
    from derive.notation import text_of

    table = Table("geometry", "g(x)", "closed form", "numerical", "body")
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
        "geometry", "closed form", "numerical", "proved", "agrees to 30 digits or more", "time"
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
    for side in ("_left", "_right"):
        name = name.removesuffix(side)
    return name


def formulas(sheet: "FormulaSheet") -> Group:
    """A formula sheet for a terminal."""
    from derive.notation import text_of

    table = Table.grid(padding=(0, 2, 1, 0))
    for name, formula in sheet.items():
        table.add_row(
            Text(name, style="bold cyan"),
            Text.assemble(
                (f"{sheet.equation(name)}\n", "bold"),
                f"{formula.meaning} [{formula.unit}], if {formula.assumptions}\n",
                (f"{formula.proof or 'not proven yet'}\n", "green"),
                (formula.source, "dim"),
            ),
        )
    for symbol, definition in sheet.definitions.items():
        table.add_row(Text(str(symbol), style="cyan"), f"{symbol} = {text_of(definition)}")
    return Group(Text(sheet.title, style="bold"), "", table)


def drift(found: "Iterable[Difference]") -> Group:
    """Which files differ from what is generated, and how."""
    parts: list[RenderableType] = []
    for difference in found:
        parts.append(Text(f"{difference.name}: {difference.what}", style="bold red"))
        if difference.diff:
            parts += [Text(line, style=_DIFF.get(line[:1], "")) for line in difference.lines]
    return Group(*parts)


_DIFF = {"+": "green", "-": "red", "@": "cyan"}
