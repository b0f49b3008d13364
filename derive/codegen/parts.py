"""Functions of a piecewise polynomial body as sums over the parts of a contact.

In:  a proven FormulaSheet and a Function of the contract.
Out: the Program of that function, compared with the formulas of the sheet before it is used; Python
     source, not yet formatted: the function, whose docstring prints what its code computes, or
     `_angles`, which computes the steps that all these functions begin with.
"""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import lru_cache

from sympy import Expr

from derive.codegen.contract import CONTRACT
from derive.codegen.function import FunctionText, checks_of, printer_of, step_lines
from derive.codegen.printer import NumPyPrinter
from derive.codegen.program import Program, Step
from derive.codegen.rewrite import demand_equal
from derive.proof.points import contacts
from derive.sheet.formulas import FormulaSheet
from derive.sheet.notation import text_of
from derive.symbols import a, c
from derive.theory.frame import Frame
from derive.theory.segments import Parts, definitions_of


def parts_program(sheet: FormulaSheet, fields: Mapping[str, str]) -> Program:
    """The program of a function; it begins with the steps that all functions have in common.

    fields: the name of a formula of the sheet for the name of each field

    Raises NotProven if the program does not agree with the sheet.

    >>> from derive.sheet.derivation import derive_sheet
    >>> from derive.body.library import load_geometry
    >>> sheet = derive_sheet(load_geometry("flat_rounded"))
    >>> parts_program(sheet, {"": "load"}).outputs[""]
    E_star*h**2*(segment(t_1) + segment(t_3))/(16*R)
    """
    program, common = _program(Parts(sheet.frame), fields, _taken(sheet)), common_steps(sheet)
    source = {field: sheet.flat(name) for field, name in fields.items()}
    words = f"{', '.join(fields.values())} of {sheet.geometry.name!r}, part by part"
    demand_equal(words, program, source, contacts(sheet))
    own = (step for step in program.steps if step not in common)
    return replace(program, steps=(*common, *own))


def common_steps(sheet: FormulaSheet) -> tuple[Step, ...]:
    """The steps that all functions have in common, unless that is only the contact width."""
    first, *others = (program.steps for program in _programs(sheet.frame, _taken(sheet)))
    common = tuple(step for step in first if all(step in steps for steps in others))
    return common if len(common) > 1 else ()


def functions_called(sheet: FormulaSheet) -> dict[Expr, Expr]:
    """The functions that the programs call, with their definitions."""
    programs = _programs(sheet.frame, _taken(sheet))
    return definitions_of(
        expr
        for program in programs
        for expr in (*program.outputs.values(), *(step.expr for step in program.steps))
    )


@lru_cache(maxsize=2)
def _programs(frame: Frame, taken: tuple[str, ...]) -> tuple[Program, ...]:
    """The programs of all functions of the contract that are sums over parts."""
    parts = Parts(frame)
    made = (f.formulas for f in CONTRACT if f.formulas[0] in parts.formulas)
    return tuple(_program(parts, {name: name for name in names}, taken) for names in made)


def _program(parts: Parts, fields: Mapping[str, str], taken: tuple[str, ...]) -> Program:
    outputs = {field: parts.formulas[name] for field, name in fields.items()}
    steps = tuple(Step(d.symbol, d.expr, d.meaning) for d in parts.definitions)
    needed = Program(outputs, steps).ordered().steps
    return Program(outputs, tuple(step for step in steps if step in needed)).renamed(taken)


def _taken(sheet: FormulaSheet) -> tuple[str, ...]:
    """Names that no step may have."""
    return tuple(q.name for q in sheet.geometry.parameters)


# ------------------------------------------------------------------ text

NAME = "_angles"

_WORDS = "The shared symbols that are defined above, and whether such a contact exists."


class SummedText(FunctionText):
    """The text of one function."""

    note = "  For symbols, see the module."

    def _made(self) -> Program:
        return parts_program(self.sheet, {field: str(name) for field, name in self.function.fields})

    def _steps(self, printer: NumPyPrinter) -> Iterator[str]:
        yield from summed_steps(self.sheet, self.program, printer, "exists")

    def _existing(self) -> Iterator[str]:
        if not common_steps(self.sheet):
            yield from super()._existing()
        elif checks := [*self._further_checks]:
            yield f"    exists = exists & ({' & '.join(checks)})"

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
    for call, definition in functions_called(sheet).items():
        yield f"{call} = {text_of(definition)}"


def _arguments(sheet: FormulaSheet) -> list[str]:
    """The arguments of `_angles`."""
    exprs = [*(step.expr for step in common_steps(sheet)), *sheet["tilt"].conditions]
    needed = set().union(*(expr.free_symbols for expr in exprs))
    given = (a, c, *(q.symbol for q in sheet.geometry.parameters))
    return [str(symbol) for symbol in given if symbol in needed]
