"""What the commands print: tables and formula sheets in a terminal.

In:  sheets, bodies, differences.
Out: renderables of rich.
"""

from collections.abc import Iterable

from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from derive.codegen.publish import Difference
from derive.notation import text_of
from derive.pipeline import Body
from derive.proof.verdict import Verdict
from derive.sheet import FormulaSheet


def listing(sheets: Iterable[FormulaSheet]) -> Table:
    """Every geometry, its g(x), what is closed form and what is numerical."""
    table = Table("geometry", "g(x)", "closed form", "numerical", "body")
    for sheet in sheets:
        closed, numerical = _by_form(sheet)
        table.add_row(
            Text(sheet.geometry.name, style="bold cyan"),
            text_of(sheet.geometry.g),
            closed,
            numerical,
            sheet.geometry.title,
        )
    return table


def summary(bodies: Iterable[Body]) -> Table:
    """What was built: closed form or numerical, how each formula was proven, time."""
    table = Table(
        "geometry", "closed form", "numerical", "proved", "agrees to 30 digits or more", "time"
    )
    for body in bodies:
        closed, numerical = _by_form(body.sheet)
        table.add_row(
            Text(body.name, style="bold cyan"),
            closed,
            numerical,
            Text(_proven(body.sheet, Verdict.PROVED), style="green"),
            Text(_proven(body.sheet, Verdict.NUMERICAL), style="yellow"),
            f"{body.seconds:.1f} s",
        )
    return table


def _by_form(sheet: FormulaSheet) -> tuple[str, str]:
    """Which parts of a body's contact law are closed formulas, and which are not."""
    parts = {
        "forward": "load" in sheet,
        "from (P, M)": "contact_a" in sheet,
        "from (P, alpha)": "contact_at_tilt_a" in sheet,
    }
    closed = [words for words, there in parts.items() if there]
    numerical = [words for words, there in parts.items() if not there]
    return ", ".join(closed) or "-", ", ".join(numerical) or "-"


def _proven(sheet: FormulaSheet, verdict: Verdict) -> str:
    """Names of the formulas with this verdict, both edges as one."""
    names = [name for name, f in sheet.items() if f.proof and f.proof.verdict == verdict]
    return ", ".join(dict.fromkeys(_stem(name) for name in names)) or "-"


def _stem(name: str) -> str:
    for side in ("_left", "_right"):
        name = name.removesuffix(side)
    return name


def formulas(sheet: FormulaSheet) -> Group:
    """A formula sheet for a terminal."""
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


def drift(found: Iterable[Difference]) -> Group:
    """Which files differ from what is generated, and how."""
    parts: list[RenderableType] = []
    for difference in found:
        parts.append(Text(f"{difference.name}: {difference.what}", style="bold red"))
        if difference.diff:
            parts += [Text(line, style=_DIFF.get(line[:1], "")) for line in difference.lines]
    return Group(*parts)


_DIFF = {"+": "green", "-": "red", "@": "cyan"}
