"""Functions of a piecewise polynomial body as sums over the parts of a contact.

In:  a FormulaSheet and the names of the formulas that a function returns.
Out: the Program of that function, compared with the formulas of the sheet before it is used; the
     steps with which all these programs begin.
"""

from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache

from sympy import Expr

from derive.codegen.contract import CONTRACT
from derive.codegen.program import Program, Step
from derive.codegen.rewrite import prove_equal
from derive.errors import NotProven
from derive.proof.points import contacts
from derive.sheet import FormulaSheet
from derive.theory.edges import Edge, pressure_series
from derive.theory.frame import Frame
from derive.theory.segments import Parts, definitions_of

THIRD = {"left": "third_left", "right": "third_right"}
"""The fields of the program for the coefficients of s**(5/2) in the pressure."""


def parts_program(sheet: FormulaSheet, fields: Mapping[str, str]) -> Program:
    """The program of a function; it begins with the steps that all functions have in common.

    fields: the name of a formula of the sheet for the name of each field, or THIRD

    Raises NotProven if the program does not agree with the sheet.

    >>> from derive.derivation import derive_sheet
    >>> from derive.library import load_geometry
    >>> sheet = derive_sheet(load_geometry("flat_rounded"))
    >>> parts_program(sheet, {"": "load"}).outputs[""]
    E_star*h**2*(segment(t_1) + segment(t_3))/(16*R)
    """
    program, common = _program(Parts(sheet.frame), fields, _taken(sheet)), common_steps(sheet)
    source = {field: _derived(sheet, name) for field, name in fields.items()}
    proof = prove_equal(program, source, contacts(sheet))
    if not proof.holds:
        names = ", ".join(fields.values())
        raise NotProven(f"{names} of {sheet.geometry.name!r}, part by part: {proof}")
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


def _derived(sheet: FormulaSheet, name: str) -> Expr:
    """A formula as derived by the sheet, with the symbols of the frame written out."""
    if name in THIRD.values():
        edge = Edge[name.removeprefix("third_").upper()]
        return sheet.frame.flat(pressure_series(sheet.frame, edge, 3)[2])
    return sheet.flat(name)
