"""The one template of a generated module.

In:  a proven FormulaSheet.
Out: the text of a module: one function of the contract after the other, then what the solvers need
     of the body, then the functions of a cycle, bound to it.
"""

import ast
import subprocess
import textwrap
from collections.abc import Iterator

from ruff import find_ruff_bin

from derive.codegen.contract import CONTRACT
from derive.codegen.curve import CurveText, IntegratedText
from derive.codegen.function import LINE, FunctionText, inside_quotes
from derive.codegen.law import LawText
from derive.codegen.mark import MARK
from derive.codegen.plan import Route, carried_by, route_of
from derive.codegen.publish import FULL_STICK
from derive.codegen.summed import SummedText, angles_text, definitions_text
from derive.notation import text_of
from derive.runtime import segments
from derive.runtime.cycle import CYCLE, EXPLAINING
from derive.runtime.history.public import HISTORIES
from derive.runtime.shared import SHARED
from derive.sheet import FormulaSheet

_KINDS = (
    *("Contact", "Edges", "History", "March", "Regime"),
    *("SteadyCycle", "StickZone", "Threshold"),
)
"""Types of results, which a module offers beside its functions."""

_HELPERS = {
    "arrays": ("elementwise",),
    "body": ("Asked", "Body", "Example", "Parameter"),
    "cycle": ("integrated",),
    "elementary": ("LEAST", "MOST", "TINY", "kink_logarithm", "where"),
    "history": ("public",),
    "kernels": ("BREAKS", "PRESSURE", "SERIES", "SLOPE", "STATE", "kernel"),
    "pieces": ("BESIDE_BREAK", "curve_of"),
    "segments": tuple(n for n, f in vars(segments).items() if f in SHARED),
    "shared": ("by_position", "shared"),
    "types": ("Array", *_KINDS),
}
"""What the modules of runtime/ offer to a body's."""

_TEXTS = {
    Route.FORMULA: FunctionText,
    Route.PARTS: SummedText,
    Route.QUADRATURE: IntegratedText,
}


def module_text(sheet: FormulaSheet, source: str) -> str:
    """The module of one body; `source` names the file that g(x) came from.

    Raises NotProven if any formula of the sheet, or any rewritten form, is not proven.
    """
    sheet.demand_proven()
    solved = [f.name for f in CONTRACT if route_of(sheet, f) is Route.SOLVED]
    bound = [*solved, *(function.__name__ for function in (*CYCLE, *EXPLAINING))]
    histories = [function.__name__ for function in HISTORIES]
    names = [*(f.name for f in CONTRACT), *bound[len(solved) :], *histories, *_KINDS]
    code = "\n\n".join(_functions(sheet, source))
    cycle = "\n".join(
        [
            *(f"{name} = _BODY.bound(cycle.{name})" for name in bound),
            *(f"{name} = _BODY.bound(public.{name})" for name in histories),
        ]
    )
    stuck = [f.name for f in CONTRACT if not f.geometric]
    return formatted(f'''{MARK}
"""{inside_quotes(_heading(sheet, source))}
"""

import numpy as np

from .{FULL_STICK} import {", ".join(stuck)}
from .runtime import {"cycle, pieces" if "pieces." in code else "cycle"}
{_imports(code, (*_KINDS, "public"))}

{_offered(names)}


{code}

{cycle}
''')


def _heading(sheet: FormulaSheet, source: str) -> str:
    """The module's docstring: the body, its profile, what several of its formulas hold."""
    origin = f"g(x) = {text_of(sheet.geometry.g)}, from {source}."
    paragraphs = [textwrap.fill(sheet.geometry.title, LINE - 4)]
    paragraphs.append(textwrap.fill(origin, LINE, subsequent_indent=" " * 4))
    paragraphs.append(textwrap.fill(SHAPES, LINE))
    if carried_by(sheet) is Route.PARTS:
        lines = [
            textwrap.fill(line, LINE, initial_indent=" " * 4, subsequent_indent=" " * 8)
            for line in definitions_text(sheet)
        ]
        paragraphs.append("\n".join(["In the formulas below", *lines]))
    return "\n\n".join(paragraphs)


SHAPES = (
    "Arguments broadcast, and results are float64 of the broadcast shape; NaN unless material and "
    "geometry are positive and lengths are between 1e-75 and 1e75 m."
)


def _offered(names: list[str]) -> str:
    """`__all__`, in lines that type checkers read."""
    lines: list[list[str]] = [[]]
    for name in sorted(names, key=_order):
        if len(str([*lines[-1], name])) > LINE - len("__all__ += "):
            lines.append([])
        lines[-1].append(name)
    first, *others = map(str, lines)
    return "\n".join([f"__all__ = {first}", *(f"__all__ += {other}" for other in others)])


def full_stick_text(sheet: FormulaSheet) -> str:
    """The module of the functions that hold no parameter of a body; any body's sheet gives it."""
    made = (f for f in CONTRACT if not f.geometric)
    code = "\n\n".join(FunctionText(sheet, f, "derive/theory/stick.py").text for f in made)
    return formatted(f'''{MARK}
"""Full stick: how shear changes next to the edges of a contact that does not slip.

{textwrap.fill(SHAPES, LINE)}
"""

import numpy as np

{_imports(code)}


{code}
''')


def _functions(sheet: FormulaSheet, source: str) -> Iterator[str]:
    """The text of every function that has a formula, and of the body's law."""
    carried = carried_by(sheet)
    if carried is Route.PARTS and (angles := angles_text(sheet)):
        yield angles
    for function in CONTRACT:
        route = route_of(sheet, function)
        if function.geometric and route is not Route.SOLVED:
            yield _TEXTS[route](sheet, function, source).text
    routes = {route_of(sheet, function) for function in CONTRACT}
    made = CurveText if Route.QUADRATURE in routes else LawText
    yield made(sheet, source).text


def _imports(code: str, always: tuple[str, ...] = ()) -> str:
    """What the code needs of the modules of runtime/."""
    lines = []
    used = {node.id for node in ast.walk(ast.parse(code)) if isinstance(node, ast.Name)}
    for module, names in _HELPERS.items():
        held = sorted({*names} & {*always, *used}, key=_order)
        if held:
            lines.append(f"from .runtime.{module} import {', '.join(held)}")
    return "\n".join(lines)


def _order(name: str) -> tuple[bool, bool, str]:
    """K_N before Contact before load: as the linter sorts `__all__`."""
    return not name.isupper(), name.islower(), name


def formatted(text: str) -> str:
    """`text` in the project's format, whatever configuration lies around."""
    command = [find_ruff_bin(), "format", "--isolated", f"--line-length={LINE}", "-"]
    done = subprocess.run(
        command, input=text, text=True, encoding="utf-8", capture_output=True, check=True
    )
    return done.stdout
