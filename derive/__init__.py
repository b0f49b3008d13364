"""Contact laws of half-plane contacts, derived from g(x), proven and generated as NumPy code.

A geometry file needs only three names from this package::

    from derive import Geometry, parameter, x

    R = parameter("R", "relative radius of curvature", unit="m")
    geometry = Geometry("hertz", g=x**2 / (2 * R))

The names are imported on first use, so that ``derive --help`` does not wait for SymPy.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from derive.body.geometry import Geometry, parameter
    from derive.body.library import load_geometry
    from derive.proof.prove import prove_sheet
    from derive.sheet.derivation import derive_sheet
    from derive.symbols import x

__all__ = [
    "Geometry",
    "derive_sheet",
    "load_geometry",
    "parameter",
    "prove_sheet",
    "x",
]

_HOME = {
    "Geometry": "derive.body.geometry",
    "load_geometry": "derive.body.library",
    "parameter": "derive.body.geometry",
    "x": "derive.symbols",
    "derive_sheet": "derive.sheet.derivation",
    "prove_sheet": "derive.proof.prove",
}


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module 'derive' has no attribute {name!r}; it provides {__all__}")
    return getattr(import_module(_HOME[name]), name)
