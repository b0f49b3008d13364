"""Provide the body that a claims file names or defines, with formulas that are proven before use.

In:   the entry `body`: a name of the library, a table with g, or the name of a geometry file, of
      which nothing is executed.
Out:  the ProvenBody, or None for "none".
"""

import ast
from collections.abc import Mapping
from functools import cache
from pathlib import Path

from sympy import Expr, Mul, S, Symbol, atan, atan2, log, nan, powsimp

from derive.body.geometry import Geometry
from derive.body.library import is_in_library, library, load_geometry
from derive.check.schema import OwnBody, Place, decoded
from derive.command.errors import (
    BadClaimsFile,
    BadFormula,
    BadGeometryFile,
    BadText,
    NotProven,
    UserError,
)
from derive.command.files import Unreadable, bytes_of
from derive.command.new_geometry import TEXT_LIMITS, Wanted, new_geometry
from derive.command.processes import Report, in_processes
from derive.proof.numerical import numeric_proof
from derive.proof.symbolic import symbolic_proof
from derive.sheet.derivation import derive_sheet
from derive.sheet.formulas import FormulaSheet

_LARGEST = 50_000
"""The largest size of a geometry file, in bytes."""


class ProvenBody:
    """A geometry with its formula sheet, whose formulas are proven before they are returned."""

    def __init__(self, geometry: Geometry) -> None:
        self.sheet: FormulaSheet = derive_sheet(geometry)
        self._known: dict[str, Expr] = {}

    def formula(self, name: str) -> Expr:
        """Return a formula that is proven symbolically or else to 30 digits; raises NotProven."""
        if name not in self._known:
            proof = symbolic_proof(self.sheet, name) or numeric_proof(self.sheet, name)
            if proof is None or not proof.holds:
                raise NotProven(f"{name} of {self.sheet.geometry.name!r}: {proof}")
            self._known[name] = self.sheet.flat(name)
        return self._known[name]


def body_of(given: object, place: Place) -> ProvenBody | None:
    """Return the body of a file or of a claim; raises UserError."""
    if given is None or given == "none":
        return None
    if isinstance(given, str) and is_in_library(given):
        return _of_library(given)
    here, remedy = place.inside("body"), "correct g or the units"
    try:
        if isinstance(given, dict):
            own = decoded(OwnBody, given, here)
        elif isinstance(given, str) and given.endswith(".py") and Path(given).name == given:
            remedy = "correct the geometry file, or write g here"
            own = _read(Path(place.file).parent / given)
        else:
            why = f"{given!r} is not in the library, nor a geometry file in the same folder"
            remedy = f"write one of {', '.join(library())}, or {{ g = 'x**2/(2*R)' }}"
            raise here.bad(why, remedy)
        return _derived(own.g, tuple(sorted(own.units.items())))
    except BadText as error:
        raise BadFormula(str(here), own.g, error.column, error.why, error.remedy) from error
    except BadClaimsFile:
        raise
    except UserError as error:
        raise here.bad(error.message, remedy) from error


@cache
def _of_library(name: str) -> ProvenBody:
    return ProvenBody(load_geometry(name))


@cache
def _derived(profile: str, units: tuple[tuple[str, str], ...]) -> ProvenBody:
    """Return a body whose profile is text.

    It is first derived in another process, because SymPy can run without end or abort.
    """
    wanted = Wanted("own_body", profile, units=dict(units))
    in_processes(_derive, [wanted], lambda *_: None, 1, TEXT_LIMITS)
    return ProvenBody(new_geometry(wanted)[0])


def _derive(wanted: Wanted, report: Report) -> None:
    """Read and derive a body, without a result."""
    report("g(x)", "reading")
    geometry, _ = new_geometry(wanted)
    report("g(x)", "deriving")
    ProvenBody(geometry)


def _read(path: Path) -> OwnBody:
    """Read g(x), and the units of its parameters, from a geometry file without executing it."""
    try:
        tree = ast.parse(bytes_of(path, _LARGEST))
    except Unreadable as error:
        raise BadGeometryFile(str(path), str(error)) from error
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        raise BadGeometryFile(str(path), "the file is not valid Python") from error
    units, profiles = dict[str, str](), list[str]()
    for statement in tree.body:
        match statement:
            case ast.Assign([ast.Name(name), *_], ast.Call(ast.Name("parameter")) as call):
                named = {each.arg: each.value for each in call.keywords}
                first, *_ = *call.args, named.get("name")
                match first, named.get("unit", ast.Constant("m")):
                    case ast.Constant(value=word), ast.Constant(value=str(unit)) if word == name:
                        units[name] = unit
                    case _:
                        why = f"it does not define {name} = parameter({name!r}, ..., unit=...)"
                        raise BadGeometryFile(str(path), why)
            case ast.Assign(_, ast.Call(ast.Name("Geometry"), _, keywords)):
                profiles += [ast.unparse(each.value) for each in keywords if each.arg == "g"]
    if len(profiles) != 1:
        why = "the file does not have exactly one `geometry = Geometry(name, g=...)`"
        raise BadGeometryFile(str(path), why)
    return OwnBody(profiles[0], units)


def placed(expr: Expr, table: Mapping[Symbol, Expr]) -> Expr:
    """Substitute the arguments of a formula, and write acute angles with atan.

    At a kink, the distance to it times its logarithm has the limit zero.
    """
    found = expr.xreplace(table)
    if found.has(nan):
        products = [each for each in expr.atoms(Mul) if _vanishes(each, table)]
        found = expr.xreplace(dict.fromkeys(products, S.Zero)).xreplace(table)
    return found.replace(atan2, _arc)


def _vanishes(product: Expr, table: Mapping[Symbol, Expr]) -> bool:
    """Whether what stands beside a logarithm in a product is zero for these arguments."""
    beside = [factor for factor in product.args if factor.func != log]
    return len(beside) < len(product.args) and Mul(*beside).xreplace(table) == 0


def _arc(over: Expr, under: Expr) -> Expr:
    return atan(powsimp(over / under)) if under.is_positive else atan2(over, under)
