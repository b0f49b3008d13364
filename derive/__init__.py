"""Contact laws of half-plane contacts: derived from g(x), proven, generated as NumPy.

A geometry file needs three names from here, and nothing else of the package::

    from derive import Geometry, parameter, x

    R = parameter("R", "relative radius of curvature", unit="m")
    geometry = Geometry("hertz", g=x**2 / (2 * R))

The names load on first use, so that ``derive --help`` does not wait for SymPy.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from derive.geometry import Geometry, parameter
    from derive.pipeline import derive_sheet, prove_sheet
    from derive.symbols import x

__all__ = ["Geometry", "derive_sheet", "parameter", "prove_sheet", "x"]

_HOME = {
    "Geometry": "derive.geometry",
    "parameter": "derive.geometry",
    "x": "derive.symbols",
    "derive_sheet": "derive.pipeline",
    "prove_sheet": "derive.pipeline",
}


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module 'derive' has no attribute {name!r}; it offers {__all__}")
    return getattr(import_module(_HOME[name]), name)
