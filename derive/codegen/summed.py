"""Prints functions that are sums over the parts of a contact; their docstrings match their code.

In:  a proven FormulaSheet and a Function of the contract.
Out: Python source, not yet formatted: one function, or `_angles`, which computes the steps that
     these functions share; and the lines that define the shared steps in the docstring of the
     module.
"""

from collections.abc import Iterator

from derive.codegen.function import FunctionText, checks_of, printer_of, step_lines
from derive.codegen.parts import common_steps, functions_called, parts_program
from derive.codegen.printer import NumPyPrinter
from derive.codegen.program import Program
from derive.notation import text_of
from derive.sheet import FormulaSheet
from derive.symbols import a, c

NAME = "_angles"

_WORDS = "The shared symbols that are defined above, and whether such a contact exists."


class SummedText(FunctionText):
    """The text of one function."""

    def _made(self) -> Program:
        return parts_program(self.sheet, {field: str(name) for field, name in self.function.fields})

    def _demand_equal(self) -> None:
        """Compare nothing: `parts_program` has already compared the program with the sheet."""

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

    @property
    def _origin(self) -> str:
        return "For the symbols and the source, see the docstring of the module."


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
