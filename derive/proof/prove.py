"""Sheet in, the same sheet out with a proof for every formula."""

from dataclasses import replace

from derive.proof.numerical import NumericalRoutes
from derive.proof.symbolic import symbolic_proof
from derive.proof.verdict import combined
from derive.sheet import FormulaSheet


def prove_sheet(sheet: FormulaSheet) -> FormulaSheet:
    """Prove every formula by all its routes; what is not proven keeps a verdict that says so.

    >>> from derive.derivation import derive_sheet
    >>> from derive.library import load_geometry
    >>> sheet = prove_sheet(derive_sheet(load_geometry("hertz")))
    >>> all(formula.proof.holds for formula in sheet.values())
    True
    """
    numerical = NumericalRoutes(sheet)
    proven = {
        name: replace(formula, proof=combined(symbolic_proof(sheet, name), numerical.proof(name)))
        for name, formula in sheet.items()
    }
    return replace(sheet, formulas=proven)
