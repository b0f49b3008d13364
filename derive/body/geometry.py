"""A body: its name, its profile g(x), and the parameters that g contains."""

import keyword
import re
from collections.abc import Iterable
from copy import copy
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

from sympy import Expr, Float, I, Rational, S, Symbol, SympifyError, nan, oo, sympify, zoo

from derive.body.profile import Slope, read_slope
from derive.command.errors import BadName, BadProfile, DimensionMismatch, UnknownSymbol
from derive.reading.units import Dimension, check, parse_unit
from derive.symbols import QUANTITIES, RESERVED, Quantity, x


class Parameter(Symbol):
    """A positive real symbol with a meaning and a unit; made by `parameter`."""

    __slots__ = ("meaning", "unit")

    meaning: str
    unit: str

    def __new__(cls, name: str, meaning: str, unit: str) -> "Parameter":
        """Make a new symbol; parameters of the same name but different meaning stay distinct."""
        symbol = Symbol.__xnew__(cls, name, positive=True)
        symbol.meaning, symbol.unit = meaning, unit
        return symbol

    def _hashable_content(self) -> tuple[Any, ...]:
        return (*super()._hashable_content(), self.meaning, self.unit)

    def __getnewargs_ex__(self) -> tuple[tuple[str, ...], dict[str, Any]]:
        return (self.name, self.meaning, self.unit), {}


def parameter(name: str, meaning: str, *, unit: str = "m") -> Parameter:
    """Make a positive real parameter of a profile.

    Parameters
    ----------
    name : str
        A Python identifier that is not one of the theory's own symbols.
    meaning : str
        A few words for the formula sheet and the docstrings.
    unit : str, optional
        A product of powers of m, Pa, N, rad; '-' for a pure number.

    Returns
    -------
    Parameter
        A SymPy symbol.

    Raises
    ------
    BadName
        If the name is not allowed.
    BadUnit
        If the unit cannot be read.

    Examples
    --------
    >>> R = parameter("R", "relative radius of curvature", unit="m")
    >>> R.is_positive
    True
    """
    if not isinstance(name, str) or not _usable(name):
        raise BadName("parameter", str(name), "cannot be used as a name")
    if _is_taken(name):
        raise BadName("parameter", name, f"is reserved by the theory{_FOR_X * (name == x.name)}")
    parse_unit(unit)
    return Parameter(name, meaning, unit)


MODULES = ("edge", "full_stick", "runtime")
"""Names of the modules that every generated package contains besides its bodies."""

_FOR_X = " for the position along the contact, which `from derive import x` provides"


def _is_taken(name: str) -> bool:
    """Whether a name belongs to one of the theory's own symbols."""
    numbered = re.fullmatch(
        r"(theta|w|L|u|v|m|n|q_left|q_right)_\d+|(t|sin|cos|tan|cot)_(x|\d+)", name
    )
    return name in RESERVED or numbered is not None


def _usable(name: str) -> bool:
    return (
        name.isascii()
        and name.isidentifier()
        and not keyword.iskeyword(name)
        and not name.startswith("_")
    )


def _stranger(body: str, given: str) -> UnknownSymbol:
    """The error for a symbol that is neither x nor a parameter, with a line that corrects it."""
    if given == x.name:
        remedy = "this is another symbol named x; write `from derive import x` and use that x"
        return UnknownSymbol(body, given, remedy)
    if _usable(given) and not _is_taken(given):
        return UnknownSymbol(body, given, f"declare it with {_line(given)}")
    candidates = (f"{given}0", f"my_{given}", "R0")
    free = next(name for name in candidates if _usable(name) and not _is_taken(name))
    why = "cannot be the name of a parameter"
    if _is_taken(given):
        meaning = QUANTITIES[given].meaning if given in QUANTITIES else ""
        why = f"is reserved by the theory{f' ({meaning})' * bool(meaning)}"
    return UnknownSymbol(body, given, f"{given} {why}; choose another name, as in {_line(free)}")


def _line(name: str) -> str:
    """The line of a geometry file that declares a parameter."""
    return f'{name} = parameter("{name}", "its meaning", unit="m")'


_BY_ROOTS = {number: number.expand(func=True) for number in (S.GoldenRatio, S.TribonacciConstant)}
"""Numbers that have a name in SymPy, written with roots."""


def as_written(number: Float) -> Rational:
    """A decimal number as the fraction that was meant: 0.7 is 7/10, not a binary fraction.

    >>> as_written(Float(0.7)), as_written(Float("0.12345678901234567890"))
    (7/10, 1234567890123456789/10000000000000000000)
    """
    binary = float(number)
    return Rational(repr(binary) if Rational(number) == Rational(binary) else str(number))


def _expression(name: str, g: Any) -> Expr:
    """g as a real SymPy expression."""
    remedy = "write a real SymPy expression in x and parameters, such as x**2/(2*R)"
    try:
        given = sympify(g, strict=True)
    except SympifyError:
        raise BadProfile(name, f"is {g!r:.60}, which is not an expression", remedy) from None
    if not isinstance(given, Expr):
        raise BadProfile(name, f"is {given!s:.60}, which is not an expression", remedy)
    if given.has(I, nan, oo, -oo, zoo) or given.is_real is False:
        raise BadProfile(name, f"is {given}, which is not real and finite", remedy)
    return given.xreplace(_BY_ROOTS | {number: as_written(number) for number in given.atoms(Float)})


_NUMBERS = (
    "a number has no unit, so replace each number that should have one by a parameter, such as R "
    "in x**2/(2*R), and give its value when you call the generated functions"
)


def without_x(name: str, parameters: Iterable[str]) -> BadProfile:
    """The error for a profile that does not depend on x."""
    held = ", ".join(parameters)
    others = f", only parameters ({held})" if held else ""
    return BadProfile(
        name,
        f"is constant, because it does not contain x{others}",
        "write g as a function of x, the position along the contact, such as x**2/(2*R)",
    )


def _encodable(text: str) -> str:
    """A text that can be written to a file: bytes that are no UTF-8 become question marks."""
    return text.encode("utf-8", "replace").decode()


@dataclass(frozen=True, eq=False)
class Geometry:
    """One body that is pressed on a half-plane, given by its profile g(x) before loading.

    Parameters
    ----------
    name : str
        A Python identifier; it becomes the name of the generated module.
    g : Expr
        SymPy expression in x and parameters [m], positive upwards, and convex wherever contact can
        occur.  The tilt is never part of g.

    Raises
    ------
    BadName
        If the name is not allowed.
    UnknownSymbol
        If g contains a symbol that is neither x nor a parameter.
    DimensionMismatch
        If g is not a length.
    BadProfile
        If g is not a real convex profile that the package can read.

    Examples
    --------
    >>> from derive import parameter, x
    >>> R = parameter("R", "radius", unit="m")
    >>> Geometry("cylinder", g=x**2 / (2 * R)).slope.base
    x/R
    """

    name: str
    g: Expr
    description: str = field(init=False, default="")
    parameters: tuple[Quantity, ...] = field(init=False)

    def __post_init__(self) -> None:
        if not isinstance(self.name, str) or not _usable(self.name):
            raise BadName("geometry", str(self.name), "cannot be the name of a module")
        if self.name in MODULES:
            raise BadName("geometry", self.name, "is a module in every generated package")
        given = _expression(self.name, self.g)
        plain: dict[Symbol, Quantity] = {}
        for symbol in sorted(given.free_symbols, key=str):
            if isinstance(symbol, Parameter):
                if symbol.name in (q.name for q in plain.values()):
                    raise BadName("parameter", symbol.name, "has two meanings in one geometry")
                real = Symbol(symbol.name, positive=True)
                plain[symbol] = Quantity(real, _encodable(symbol.meaning), symbol.unit)
            elif symbol != x:
                raise _stranger(self.name, str(symbol))
        object.__setattr__(self, "g", given.xreplace({p: q.symbol for p, q in plain.items()}))
        object.__setattr__(self, "parameters", tuple(plain.values()))
        self._demand_length()
        if x not in self.g.free_symbols:
            raise without_x(self.name, (q.name for q in self.parameters))
        self.slope  # noqa: B018  (refuses a profile that cannot be read)

    def _demand_length(self) -> None:
        """Refuse a g(x) that is not a length, and explain that numbers have no unit."""
        try:
            check(self.g, "m", f"g of {self.name!r}", self.dimensions)
        except DimensionMismatch as error:
            first = f"{error.remedy}; " if self.parameters else ""
            error.remedy = f"{first}{_NUMBERS}"
            raise

    @cached_property
    def slope(self) -> Slope:
        """g'(x) as that of one reference piece plus a jump at each kink."""
        return read_slope(self.name, self.g)

    def described(self, description: str) -> "Geometry":
        """The same body with the docstring of its file as its description."""
        twin = copy(self)
        object.__setattr__(twin, "description", _encodable(description))
        return twin

    @property
    def title(self) -> str:
        """First line of the description, or the name if there is no description."""
        return self.description.splitlines()[0] if self.description else self.name

    @property
    def quantities(self) -> dict[str, Quantity]:
        """The symbols of the theory and the body's parameters, by name."""
        return QUANTITIES | {q.name: q for q in self.parameters}

    @property
    def dimensions(self) -> dict[Symbol, Dimension]:
        """Dimension of every symbol that a formula of this body may contain."""
        return {q.symbol: parse_unit(q.unit) for q in self.quantities.values()}
