"""Read g(x) of a body, given as text."""

from collections.abc import Mapping

from sympy import Expr, Symbol

from derive.body.geometry import parameter
from derive.command.errors import BadName
from derive.reading.text import parse
from derive.reading.value import Meaning
from derive.reading.words import FUNCTIONS_OF_PROFILES, Words
from derive.symbols import x

_OF_THE_FILE = frozenset({"Geometry", "geometry", "parameter", "Rational"})
"""Names that the geometry file itself uses."""


def read(text: str, symbols: Mapping[str, Symbol] | None = None) -> Expr:
    """The SymPy expression of g(x).

    symbols: the symbol of each parameter; by default a plain positive one

    Raises BadText.

    >>> read("abs(x)**1.5 / sqrt(R)")
    Abs(x)**(3/2)/sqrt(R)
    """
    tree = parse(text, OF_PROFILES)
    symbols = symbols or {name: Symbol(name, positive=True) for name in tree.names()}
    return Meaning(tree, {**symbols, "x": x}).value(tree.root)


def _mistake(name: str) -> tuple[str, str] | None:
    """Why a parameter cannot have a name, and what to do instead."""
    try:
        if name in _OF_THE_FILE:
            raise BadName("parameter", name, "is used by the geometry file itself")
        if name != "x":
            parameter(name, "")
    except BadName as error:
        return f"parameter {name!r} {error.why}", "choose another name of letters and digits"
    return None


OF_PROFILES = Words(FUNCTIONS_OF_PROFILES, deepest=30, mistake=_mistake)
"""The names that g(x) may contain."""
