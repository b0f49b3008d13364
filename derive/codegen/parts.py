"""Functions of a body of straight lines and parabolas, as sums over the parts of a contact.

In:  a FormulaSheet, and which of its formulas a function returns.
Out: the Program of that function, compared with the sheet's formulas before it is used, and its
     equations for the reader.
"""

from collections.abc import Iterator, Mapping

from sympy import Expr

from derive.codegen.program import Program, Step
from derive.codegen.rewrite import prove_equal
from derive.errors import NotProven
from derive.notation import text_of
from derive.proof.points import contacts
from derive.sheet import FormulaSheet
from derive.theory.edges import Edge, pressure_series
from derive.theory.segments import Parts, definitions_of


def parts_program(sheet: FormulaSheet, fields: Mapping[str, str]) -> Program:
    """The program of a function whose fields are formulas of the sheet.

    fields: by the field's name that of a formula, or third_left or third_right, the coefficients of
        s**(5/2) in the pressure.

    Raises NotProven if it is not what the sheet says.

    >>> from derive.derivation import derive_sheet
    >>> from derive.library import load_geometry
    >>> sheet = derive_sheet(load_geometry("flat_rounded"))
    >>> parts_program(sheet, {"": "load"}).outputs[""]
    E_star*h**2*(segment(t_1) + segment(t_3))/(16*R)
    """
    parts = Parts(sheet.frame)
    outputs = {field: parts.formulas[name] for field, name in fields.items()}
    steps = tuple(Step(d.symbol, d.expr, d.meaning) for d in parts.definitions)
    program = Program(outputs, steps).ordered()
    source = {field: _derived(sheet, name) for field, name in fields.items()}
    proof = prove_equal(program, source, contacts(sheet))
    if not proof.holds:
        names = ", ".join(fields.values())
        raise NotProven(f"{names} of {sheet.geometry.name!r}, part by part: {proof}")
    return program.renamed(q.name for q in sheet.geometry.parameters)


def equations(program: Program, heads: Mapping[str, str]) -> Iterator[str]:
    """What a program computes, line by line: its outputs, its steps, the functions that it calls.

    heads: what stands on the left of each output.
    """
    for name, expr in program.outputs.items():
        yield f"{heads[name]} = {text_of(expr)}"
    for step in program.steps:
        yield f"{step.symbol} = {text_of(step.expr)}"
    held = (*program.outputs.values(), *(step.expr for step in program.steps))
    for call, definition in definitions_of(held).items():
        yield f"{call} = {text_of(definition)}"


def _derived(sheet: FormulaSheet, name: str) -> Expr:
    """A formula by the sheet's own derivation, the frame's symbols written out."""
    if name.startswith("third_"):
        edge = Edge[name.removeprefix("third_").upper()]
        return sheet.frame.flat(pressure_series(sheet.frame, edge, 3)[2])
    return sheet.flat(name)
