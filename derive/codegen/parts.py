"""Functions of a piecewise polynomial body as sums over the parts of a contact.

In:  a proven FormulaSheet and a Function of the contract.
Out: the Program of that function; Python source, not yet formatted: the function, whose docstring
     prints what its code computes, or `_angles`, which computes the steps that all these functions
     begin with.

The proof of the sheet covers the sums, too (proof/prove.py).
"""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import lru_cache

from sympy import Piecewise

from derive.codegen.contract import CONTRACT
from derive.codegen.function import FunctionText, checks_of, printer_of, step_lines
from derive.codegen.printer import NumPyPrinter
from derive.codegen.program import Program
from derive.sheet.formulas import FormulaSheet
from derive.sheet.notation import text_of
from derive.symbols import a, c
from derive.theory.frame import Frame
from derive.theory.parts import Definition, parts_of
from derive.theory.segments import definitions_of


def parts_programs(sheet: FormulaSheet) -> Mapping[str, Program]:
    """The program of each function; all begin with the steps that they have in common.

    >>> from derive.sheet.derivation import derive_sheet
    >>> from derive.body.library import load_geometry
    >>> sheet = derive_sheet(load_geometry("flat_rounded"))
    >>> parts_programs(sheet)["load"].outputs[""]
    E_star*h**2*(segment(t_1) + segment(t_3))/(16*R)
    """
    return _programs(sheet)[0]


def common_steps(sheet: FormulaSheet) -> tuple[Definition, ...]:
    """The steps that all functions have in common, unless that is only the contact width."""
    return _programs(sheet)[1]


def _programs(sheet: FormulaSheet) -> tuple[Mapping[str, Program], tuple[Definition, ...]]:
    return _programs_of(sheet.frame, tuple(q.name for q in sheet.geometry.parameters))


@lru_cache(maxsize=2)
def _programs_of(
    frame: Frame, taken: tuple[str, ...]
) -> tuple[Mapping[str, Program], tuple[Definition, ...]]:
    """The programs and their common steps; `taken` are names that no step may have."""
    parts, made = parts_of(frame), {}
    steps = parts.definitions
    for function in (f for f in CONTRACT if f.formulas[0] in parts.formulas):
        outputs = {field: parts.formulas[str(name)] for field, name in function.fields}
        needed = Program(outputs, steps).ordered().steps
        program = Program(outputs, tuple(step for step in steps if step in needed))
        made[function.name] = program.renamed(taken)
    common = [
        s
        for s in next(iter(made.values())).steps
        if all(s in program.steps for program in made.values())
    ]
    common = common if len(common) > 1 else []
    for name, program in made.items():
        own = (step for step in program.steps if step not in common)
        made[name] = replace(program, steps=(*common, *own))
    return made, tuple(common)


# ------------------------------------------------------------------ text

NAME = "_angles"

_WORDS = "The shared symbols that are defined above, and whether such a contact exists."


class SummedText(FunctionText):
    """The text of one function."""

    note = "  For symbols, see the module."

    def _made(self) -> Program:
        return parts_programs(self.sheet)[self.function.name]

    def _steps(self, printer: NumPyPrinter) -> Iterator[str]:
        yield from summed_steps(self.sheet, self.program, printer, "exists")

    def _existing(self) -> Iterator[str]:
        if not common_steps(self.sheet):
            yield from super()._existing()
        elif checks := [*self._further_checks]:
            yield f"    exists = exists & ({' & '.join(checks)})"

    @property
    def _further_checks(self) -> Iterator[str]:
        """The parameters of all pieces, because a formula with pieces uses those of one."""
        yield from super()._further_checks
        own = [str(q.symbol) for q in self.sheet.geometry.parameters]
        if len(own) > 1 and any(expr.has(Piecewise) for expr in self.program.exprs):
            yield f"{' * '.join(own)} > 0"

    @property
    def _equations(self) -> Iterator[str]:
        for field, name in self.function.fields:
            yield f"{self.sheet[str(name)].symbol} = {text_of(self.program.outputs[field])}"
        for step in self.program.steps[len(common_steps(self.sheet)) :]:
            yield f"{step.symbol} = {text_of(step.expr)}"


def summed_steps(
    sheet: FormulaSheet, program: Program, printer: NumPyPrinter, exists: str = "_"
) -> Iterator[str]:
    """The code of the steps of a program; the steps that all functions share call `_angles`."""
    common = common_steps(sheet)
    if common:
        names = ", ".join(str(step.symbol) for step in common)
        yield f"    {names}, {exists} = {NAME}({', '.join(_arguments(sheet))})"
    yield from step_lines(sheet, program, printer, len(common))


def angles_text(sheet: FormulaSheet) -> str:
    """The function `_angles` of a body; empty if its functions share no steps."""
    common = common_steps(sheet)
    if not common:
        return ""
    conditions = sheet["tilt"].conditions
    exists = " & ".join(f"({check})" for check in checks_of(conditions))
    typed = ", ".join(f"{argument}: Array" for argument in _arguments(sheet))
    program = Program({}, common)
    return "\n".join(
        [
            "@shared",
            f"def {NAME}({typed}) -> tuple[Array, ...]:",
            f'    """{_WORDS}"""',
            *step_lines(sheet, program, printer_of(program, {a, c})),
            f"    exists = {exists}",
            f"    return {', '.join(str(step.symbol) for step in common)}, exists",
        ]
    )


def definitions_text(sheet: FormulaSheet) -> Iterator[str]:
    """The lines that define the shared symbols and the functions that the formulas call."""
    for step in common_steps(sheet):
        yield f"{step.symbol} = {text_of(step.expr)}"
    exprs = [expr for program in parts_programs(sheet).values() for expr in program.exprs]
    for call, definition in definitions_of(exprs).items():
        yield f"{call} = {text_of(definition)}"


def _arguments(sheet: FormulaSheet) -> list[str]:
    """The arguments of `_angles`."""
    exprs = [*(step.expr for step in common_steps(sheet)), *sheet["tilt"].conditions]
    needed = set().union(*(expr.free_symbols for expr in exprs))
    given = (a, c, *(q.symbol for q in sheet.geometry.parameters))
    return [str(symbol) for symbol in given if symbol in needed]
