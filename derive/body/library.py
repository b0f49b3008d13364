"""Find and load geometry files: those of the library by name, those of a user by path.

SymPy is imported when a file is loaded, not when it is looked up.
"""

import signal
import sys
from contextlib import suppress
from pathlib import Path
from runpy import run_path
from typing import TYPE_CHECKING

from derive.command.errors import BadGeometryFile, UnknownGeometry, UserError

if TYPE_CHECKING:
    from derive.body.geometry import Geometry

FOLDER = Path(__file__).parents[1] / "geometries"

_TERMINATED = 128 + signal.SIGTERM
"""The status with which a process ends that is asked to end while it loads a file."""


def library() -> tuple[str, ...]:
    """Names of all bodies in derive/geometries/, in alphabetical order."""
    return tuple(sorted(p.stem for p in FOLDER.glob("*.py") if not p.stem.startswith("_")))


def is_in_library(name: str) -> bool:
    """Whether derive/geometries/ contains a body of this name."""
    return name in library()


def load_geometry(name_or_path: str | Path) -> "Geometry":
    """Load a geometry, given by its name in the library or by the path of its file.

    Parameters
    ----------
    name_or_path : str or Path
        Such as "hertz" or "skid.py".

    Returns
    -------
    Geometry
        The body.

    Raises
    ------
    UnknownGeometry
        If the library does not contain the name.
    BadGeometryFile
        If the file cannot be read or does not define `geometry`.
    UserError
        If g(x) has a fault, as in Geometry.

    Examples
    --------
    >>> load_geometry("hertz").g
    x**2/(2*R)
    """
    from derive.body.geometry import Geometry

    path = file_of(str(name_or_path))
    keep, sys.dont_write_bytecode = sys.dont_write_bytecode, True
    try:
        found = run_path(str(path), run_name=f"_geometry_{path.stem}")
    except UserError:
        raise
    except (Exception, SystemExit) as error:
        if isinstance(error, SystemExit) and error.code == _TERMINATED:
            raise
        why = f"{type(error).__name__}: {error}".splitlines()[0].removesuffix(": ")
        raise BadGeometryFile(str(path), why) from error
    finally:
        sys.dont_write_bytecode = keep
    geometry = found.get("geometry")
    if not isinstance(geometry, Geometry):
        raise BadGeometryFile(str(path), "it does not define `geometry`")
    return geometry.described((found["__doc__"] or "").strip())


def file_of(given: str) -> Path:
    """The file of a geometry, which is not executed; raises UnknownGeometry or BadGeometryFile."""
    if is_in_library(given):
        return FOLDER / f"{given}.py"
    path, exists = Path(given), False
    with suppress(OSError, ValueError):  # not a valid file name
        exists = bool(given) and path.exists()
    if not exists and path.suffix != ".py":
        raise UnknownGeometry(given, library())
    if not exists:
        raise BadGeometryFile(given, "there is no such file")
    if not path.is_file():
        what = "a directory" if path.is_dir() else "a device or a pipe, not a regular file"
        raise BadGeometryFile(given, f"it is {what}")
    if path.suffix != ".py":
        raise BadGeometryFile(given, "it is not a Python file")
    return path
