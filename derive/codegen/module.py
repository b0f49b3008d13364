"""The one template of a generated module.

In:  a proven FormulaSheet.
Out: the text of a module: NumPy code, one function of the contract after the other, formatted.
"""

import re
import subprocess
import textwrap
from collections.abc import Iterator

from ruff import find_ruff_bin

from derive.codegen.contract import CONTRACT, Function
from derive.codegen.cycle import CYCLE, CycleText, law_text
from derive.codegen.function import LINE, FunctionText, inside_quotes, own_parameters
from derive.codegen.integrated import (
    IntegratedText,
    MendedText,
    carried_text,
    curve_text,
    is_mended,
    keeps_its_digits,
    level_text,
)
from derive.codegen.mark import MARK
from derive.codegen.parabolas import ParabolicText, body_of, body_text, is_parabolic
from derive.codegen.solved import SOLVED, SolvedText, StateText, slope_text
from derive.codegen.third import has_third, third_text
from derive.notation import text_of
from derive.sheet import FormulaSheet
from derive.symbols import alpha

_HELPERS = {
    "_arrays": (
        *("LEAST", "MOST", "TINY"),
        *("chunkwise", "chunkwise_in_time", "elementwise", "fmax", "kink_logarithm"),
        *("maximum", "minimum", "only_where", "scaled", "scaled_at_last", "select"),
    ),
    "_law": ("Law",),
    "_march": ("march_of",),
    "_mended": ("as_integrand", "mended", "mended_sums"),
    "_parabolas": ("Parabolas", "looked_up"),
    "_profile": ("Curve", "Piece", "Profile", "slope_of"),
    "_quadrature": ("pressure_at", "second_of", "state_of"),
    "_shear": ("shear_change_of", "shear_of", "slip_range_of"),
    "_slip": ("slip_error_of", "slip_zones_of"),
    "_solve": ("contact_at", "contact_under", "level"),
    "_state": ("State",),
    "_stick": ("closing_tension_of", "stick_zone_of", "tension_threshold_of"),
}
"""What the modules of support/ offer to those beside them."""


def module_text(sheet: FormulaSheet, source: str) -> str:
    """The module of one body; `source` names the file that g(x) came from.

    Raises NotProven if any formula of the sheet, or any rewritten form, is not proven.
    """
    sheet.demand_proven()
    bodies = "\n\n".join(_functions(sheet, source))
    made = [(f.name, f.kind) for f in CONTRACT] + [(f.name, f.kind) for f in CYCLE]
    kinds = sorted({kind for _, kind in made if kind} | {"Regime"})
    names = sorted([name for name, _ in made] + kinds, key=_order_of_names)
    origin = f"g(x) = {text_of(sheet.geometry.g)}, from {source}."
    title = textwrap.fill(sheet.geometry.title, LINE - 4)
    heading = f"{title}\n\n{textwrap.fill(origin, LINE, subsequent_indent=' ' * 4)}"
    text = f'''{MARK}
"""{inside_quotes(heading)}
"""

import numpy as np

{_imports(bodies)}
from ._types import {", ".join(["Array", *kinds])}

__all__ = {names}


{bodies}
'''
    return formatted(text)


def _functions(sheet: FormulaSheet, source: str) -> Iterator[str]:
    """The text of every function; what has no closed formula is solved, or integrated."""
    solved = [f for f in CONTRACT if f.name in SOLVED and not f.available(sheet)]
    slope = sheet.geometry.slope
    closed, mended = slope.is_polynomial, is_mended(sheet)
    parabolic, (_, own) = is_parabolic(sheet), own_parameters(sheet)
    carried, level = f"state_of(_BODY, a, c{own})", f"slope_of(_BODY, x{own})"
    if parabolic:
        yield body_text(sheet)
        carried, level = f"{body_of(sheet)}.state(a, c)", f"{body_of(sheet)}.slope(x)"
    elif mended or not closed:
        yield curve_text(sheet)
    if solved:
        apart = closed and not parabolic
        yield StateText(sheet, source).text if apart else carried_text(sheet, carried)
    if any(alpha in f.arguments for f in solved):
        yield slope_text(sheet) if closed and not mended else level_text(sheet, level)
    for function in CONTRACT:
        yield _made(sheet, function, function in solved)(sheet, function, source).text
    if has_third(sheet):
        yield third_text(sheet, source)
    yield law_text(sheet)
    for cycle in CYCLE:
        yield CycleText(sheet, cycle, source).text


def _made(sheet: FormulaSheet, function: Function, solved: bool) -> type[FunctionText]:
    """How one function is written."""
    if solved:
        return SolvedText
    if not all(sheet.is_closed(name) for name in function.formulas):
        return IntegratedText
    if not function.geometric or keeps_its_digits(sheet, function.name):
        return FunctionText
    if is_parabolic(sheet):
        return ParabolicText
    return MendedText if is_mended(sheet) else FunctionText


def _imports(code: str) -> str:
    """What the code needs of the modules beside it."""
    lines = []
    for module, names in _HELPERS.items():
        held = [name for name in names if re.search(rf"\b{name}\b", code)]
        if held:
            lines.append(f"from .{module} import {', '.join(held)}")
    return "\n".join(lines)


def _order_of_names(name: str) -> tuple[bool, bool, str]:
    """K_N before Contact before load: as the linter sorts `__all__`."""
    return not name.isupper(), name.islower(), name


def formatted(text: str) -> str:
    """`text` in the project's format, whatever configuration lies around."""
    command = [find_ruff_bin(), "format", "--isolated", f"--line-length={LINE}", "-"]
    done = subprocess.run(
        command, input=text, text=True, encoding="utf-8", capture_output=True, check=True
    )
    return done.stdout
