"""Take a sheet, and return it with a proof for every formula."""

from dataclasses import replace

from mpmath.libmp import NoConvergence

from derive.proof.numerical import compared, numeric_proof
from derive.proof.points import numeric, numeric_by_steps
from derive.proof.symbolic import symbolic_proof
from derive.proof.verdict import Proof, Verdict, combined
from derive.sheet.formulas import FormulaSheet
from derive.theory.parts import parts_of
from derive.theory.segments import written_out


def prove_sheet(sheet: FormulaSheet) -> FormulaSheet:
    """Prove every formula by all its routes; the verdict states if a formula is not proven.

    A closed form of an integral is left out if it is not proven.

    Parameters
    ----------
    sheet : FormulaSheet
        A result of `derive_sheet`.

    Returns
    -------
    FormulaSheet
        The same formulas with their proofs.

    Examples
    --------
    >>> from derive.sheet.derivation import derive_sheet
    >>> from derive.body.library import load_geometry
    >>> sheet = derive_sheet(load_geometry("hertz"))
    >>> proven = prove_sheet(sheet)
    >>> all(formula.proof.holds for formula in proven.values())
    True
    """
    proven, left_out = {}, []
    for name, formula in sheet.items():
        proof = _proof(sheet, name)
        if formula.closes and not proof.holds:
            left_out.append(name)
        else:
            proven[name] = replace(formula, proof=proof)
    remark = sheet.remark
    if left_out:
        remark = f"{remark}  Not proven, and therefore left out: {', '.join(left_out)}."
    return replace(sheet, formulas=proven, remark=remark)


def _proof(sheet: FormulaSheet, name: str) -> Proof:
    """The proof of one formula; what cannot be evaluated somewhere is not proven."""
    is_closed_form = bool(sheet[name].closes)
    try:
        symbolic = None if is_closed_form else symbolic_proof(sheet, name)
        proof = combined(symbolic, numeric_proof(sheet, name))
        return proof if is_closed_form else _also_computed(sheet, name, proof)
    except (ArithmeticError, ValueError, TypeError, NoConvergence) as error:
        return Proof(Verdict.UNKNOWN, f"cannot be evaluated: {error}")


def _also_computed(sheet: FormulaSheet, name: str, proof: Proof) -> Proof:
    """The proof of a formula, or that the form evaluated in its place differs from it."""
    computed = sheet[name].computed
    if computed is None or not proof.holds:
        return proof
    steps = [(d.symbol, written_out(d.expr)) for d in parts_of(sheet.frame).definitions]
    summed, derived = numeric_by_steps(steps, written_out(computed)), numeric(sheet.flat(name))
    words = "the evaluated form, a sum over the parts of the contact"
    equal = compared(sheet, words, lambda point: (summed(point), derived(point)))
    return proof if equal.holds else equal
