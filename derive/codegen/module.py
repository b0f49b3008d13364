"""The template of a generated module.

In:  a proven FormulaSheet.
Out: the text of a module: first the functions of the contract, then the functions of the body that
     the solvers call, then the functions that the runtime solves.
"""

import ast
import subprocess
import textwrap
from collections.abc import Iterator
from itertools import chain

from ruff import find_ruff_bin

from derive.codegen.common import common_of, common_text
from derive.codegen.contract import CONTRACT
from derive.codegen.curve import CurveText
from derive.codegen.function import (
    LINE,
    FunctionText,
    definition_lines,
    demands_of,
    equation_lines,
    inside_quotes,
)
from derive.codegen.integrals import IntegratedText
from derive.codegen.law import LawText
from derive.codegen.plan import is_integrated, is_solved
from derive.codegen.program import Common
from derive.codegen.publish import FULL_STICK, MARK
from derive.codegen.solved import solved_functions
from derive.sheet.formulas import FormulaSheet
from derive.sheet.notation import text_of
from derive.symbols import P
from derive.theory.segments import FUNCTIONS

_KINDS = (
    *("Contact", "Edges", "History", "March", "Regime"),
    *("SteadyCycle", "StickZone", "Threshold"),
)
"""Types of results, which a module exports along with its functions."""

_HELPERS = {
    "": ("cycle", "pieces"),
    "arrays": ("evaluated",),
    "body": ("Body",),
    "elementary": ("LEAST", "MOST", "kink_logarithm"),
    "history": ("public",),
    "kernels": ("kernel", "shared", "where"),
    "pieces": ("curve_of",),
    "segments": tuple({f.__name__ for f in FUNCTIONS} - {"kink_logarithm"}),
    "types": ("Array", "Values", *_KINDS),
}
"""The names that a module can import, by their module in runtime/."""


def module_text(sheet: FormulaSheet, source: str) -> str:
    """The text of the module of one body; `source` names the file that defines g(x).

    Raises NotProven if any formula of the sheet is not proven.
    """
    sheet.demand_proven()
    solved = solved_functions(sheet)
    given = {f.name for f in CONTRACT if not is_solved(sheet, f)}
    bound = {name: text for name, text in solved.items() if name not in given}
    texts = [*_texts(sheet)]
    summed = [text for text in texts if text.is_summed]
    common = common_of(summed)
    functions = [text.text(common if text.is_summed else Common()) for text in texts]
    if common.steps:
        functions.insert(0, "\n".join(common_text(summed[0], common)))
    law = (CurveText if is_integrated(sheet) else LawText)(sheet).text
    code = "\n\n\n".join([*functions, law, *bound.values()])
    stuck = [f.name for f in CONTRACT if not f.geometric]
    return formatted(f'''{MARK}
"""{inside_quotes(_heading(sheet, source, common))}
"""

import numpy as np

from .{FULL_STICK} import {", ".join(stuck)}
{_imports(code, _KINDS)}

{_offered([*given, *bound, *_KINDS])}


{code}
''')


def _heading(sheet: FormulaSheet, source: str, common: Common) -> str:
    """The docstring of the module: the body, its profile, and the symbols of its formulas."""
    origin = f"g(x) = {text_of(sheet.geometry.g)}, from {source}."
    paragraphs = [textwrap.fill(sheet.geometry.title, LINE - 4)]
    paragraphs.append(textwrap.fill(origin, LINE, subsequent_indent=" " * 4))
    demands = demands_of(sheet)
    shapes = f"{EXISTENCE}  {SLIDING}  {SHARED}"
    if demands:
        shapes = shapes.replace("are positive", f"are positive, {demands}")
    paragraphs.append(textwrap.fill(shapes, LINE))
    if common.defined:
        lines = (equation_lines(line, LINE) for line in definition_lines(common.defined))
        paragraphs += ["The formulas of several functions use", "\n".join(chain(*lines))]
    return "\n\n".join(paragraphs)


EXISTENCE = (
    "Results are NaN unless the constants of material and geometry are positive and the contact "
    "width is between 1e-75 and 1e75 m."
)

SHARED = "The docstring of the package describes shapes and errors."

SLIDING = (
    "Those from stick_zone to slip_range are also NaN where dQ < 0, and where "
    "dQ >= f (P_1 + P_2), because the contact then slides."
)


def _offered(names: list[str]) -> str:
    """`__all__`, built up in a form that type checkers understand."""
    lines: list[list[str]] = [[]]
    for name in sorted(names, key=_order):
        if len(str([*lines[-1], name])) > LINE - len("__all__ += "):
            lines.append([])
        lines[-1].append(name)
    first, *others = map(str, lines)
    return "\n".join([f"__all__ = {first}", *(f"__all__ += {other}" for other in others)])


def full_stick_text(sheet: FormulaSheet) -> str:
    """The module of the functions that depend on no body; any sheet gives the same text."""
    made = (f for f in CONTRACT if not f.geometric)
    code = "\n\n".join(FunctionText(sheet, f).text(Common()) for f in made)
    return formatted(f'''{MARK}
"""Full stick: the change in shear traction next to the edges of a contact that does not slip.

{textwrap.fill(f"From derive/theory/stick.py.  {EXISTENCE}  {SHARED}", LINE)}
"""

import numpy as np

{_imports(code)}


{code}
''')


def _texts(sheet: FormulaSheet) -> Iterator[FunctionText]:
    """The text of every function that has a formula."""
    integrated = is_integrated(sheet)
    for function in CONTRACT:
        if function.geometric and not is_solved(sheet, function):
            text = IntegratedText if integrated and P not in function.arguments else FunctionText
            yield text(sheet, function)


def _imports(code: str, always: tuple[str, ...] = ()) -> str:
    """The imports from runtime/ that the code needs."""
    lines = []
    used = {node.id for node in ast.walk(ast.parse(code)) if isinstance(node, ast.Name)}
    for module, names in _HELPERS.items():
        needed = sorted({*names} & {*always, *used}, key=_order)
        if needed:
            path = ".".join(filter(None, (".runtime", module)))
            lines.append(f"from {path} import {', '.join(needed)}")
    return "\n".join(lines)


def _order(name: str) -> tuple[bool, bool, str]:
    """The sort key of the linter for `__all__`: K_N before Contact before load."""
    return not name.isupper(), name.islower(), name


def formatted(text: str) -> str:
    """`text` in the format of the project, regardless of any configuration file."""
    command = [find_ruff_bin(), "format", "--isolated", f"--line-length={LINE}", "-"]
    done = subprocess.run(
        command, input=text, text=True, encoding="utf-8", capture_output=True, check=True
    )
    return done.stdout
