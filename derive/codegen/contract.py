"""The functions of a generated module, and the formulas of the sheet that each is made from.

This table is the contract with users: names, argument order and meanings are fixed.
"""

from dataclasses import dataclass, replace

from sympy import Expr, Symbol
from sympy.logic.boolalg import Boolean

from derive.sheet.formulas import FormulaSheet
from derive.symbols import E_star, M, P, a, alpha, c, dM, dP, dQ, dsigma, f, x


@dataclass(frozen=True)
class Function:
    """One function of the contract.

    fields      the fields of the result, each with the name of its formula.  A plain array is a
                single field with an empty name.  A field that returns an argument has the symbol
                of the argument in place of the name of a formula.
    kind        the named tuple that the function returns, or "" for a plain array
    optional    the argument that is zero if it is not given
    constants   keyword-only arguments other than the parameters of the geometry
    geometric   whether the function takes the parameters of the geometry
    """

    name: str
    arguments: tuple[Symbol, ...]
    fields: tuple[tuple[str, str | Symbol], ...]
    summary: str
    kind: str = ""
    optional: Symbol | None = None
    constants: tuple[Symbol, ...] = (E_star,)
    geometric: bool = True

    @property
    def formulas(self) -> tuple[str, ...]:
        """Names of the formulas that the function is made from."""
        return tuple(source for _, source in self.fields if isinstance(source, str))

    def available(self, sheet: FormulaSheet) -> bool:
        """Whether the sheet has every formula that the function needs."""
        return all(name in sheet for name in self.formulas)

    def keywords(self, sheet: FormulaSheet) -> tuple[Symbol, ...]:
        """The keyword-only arguments."""
        own = tuple(q.symbol for q in sheet.geometry.parameters) if self.geometric else ()
        return (*self.constants, *own)

    def outputs(self, sheet: FormulaSheet) -> dict[str, Expr]:
        """The expression of every field."""
        return {
            field: sheet[source].expr if isinstance(source, str) else source
            for field, source in self.fields
        }

    def conditions(self, sheet: FormulaSheet) -> tuple[Boolean, ...]:
        """The assumptions under which the state exists, besides constants that are positive.

        Conditions on x are left out, because the pressure outside the contact is zero.
        """
        needed = (condition for name in self.formulas for condition in sheet[name].conditions)
        return tuple(dict.fromkeys(condition for condition in needed if not condition.has(x)))


def _edges(name: str, summary: str) -> Function:
    """A function of the contact alone that returns a value at both edges."""
    fields = tuple((side, f"{name}_{side}") for side in ("left", "right"))
    return Function(name, (a, c), fields, summary, "Edges")


def _full_stick(
    name: str, changes: tuple[Symbol, ...], summary: str, constants: tuple[Symbol, ...] = ()
) -> Function:
    """A function of the contact and of changes in the loads, the same for all bodies."""
    made = _edges(name, summary)
    return replace(made, arguments=(a, c, *changes), constants=constants, geometric=False)


CONTRACT: tuple[Function, ...] = (
    Function(
        "contact",
        (P, M),
        (("a", "contact_a"), ("c", "contact_c"), ("alpha", "contact_alpha")),
        "Contact and tilt under the load P and the moment M.",
        "Contact",
        optional=M,
    ),
    Function(
        "contact_at_tilt",
        (P, alpha),
        (("a", "contact_at_tilt_a"), ("c", "contact_at_tilt_c"), ("alpha", alpha)),
        "Contact under the load P at the tilt alpha.",
        "Contact",
        optional=alpha,
    ),
    Function(
        "tilt", (a, c), (("", "tilt"),), "Tilt at which the contact is [-a, c].", constants=()
    ),
    Function("load", (a, c), (("", "load"),), "Normal load that makes the contact [-a, c]."),
    Function("moment", (a, c), (("", "moment"),), "Moment that makes the contact [-a, c]."),
    Function(
        "pressure", (x, a, c), (("", "pressure"),), "Contact pressure at x; zero outside [-a, c]."
    ),
    _edges("K_N", "Coefficients of sqrt(s) in the pressure at a distance s from the edges."),
    _edges("L_N", "Coefficients of s**(3/2) in the pressure at a distance s from the edges."),
    _full_stick(
        "K_T",
        (dQ, dsigma),
        "Coefficients of 1/sqrt(s) in the full-stick shear change at a distance s from the edges.",
    ),
    _full_stick(
        "L_T",
        (dQ, dsigma),
        "Coefficients of sqrt(s) in the full-stick shear change at a distance s from the edges.",
    ),
    _full_stick(
        "stick_margin",
        (dP, dM, dQ, dsigma),
        "Margin against slip at each edge as the loads begin to change; no slip starts if >= 0.",
        constants=(f,),
    ),
)
