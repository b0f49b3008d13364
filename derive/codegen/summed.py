"""The text of a function that is a sum over the parts of a contact: what is printed is what runs.

In:  a proven FormulaSheet and a Function of the contract.
Out: Python source, not formatted yet.
"""

from collections.abc import Iterator

from derive.codegen.function import FunctionText
from derive.codegen.parts import equations, parts_program
from derive.codegen.program import Program


class SummedText(FunctionText):
    """The text of one function."""

    def _made(self) -> Program:
        return parts_program(self.sheet, {field: str(name) for field, name in self.function.fields})

    def _demand_equal(self) -> None:
        """Compared when it was made."""

    @property
    def _equations(self) -> Iterator[str]:
        heads = {
            field: str(self.sheet[name].symbol)
            for field, name in self.function.fields
            if isinstance(name, str)
        }
        yield from equations(self.program, heads)
