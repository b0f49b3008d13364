"""The module as it was printed, run and compared: the last proof before anything is written.

In:  a proven FormulaSheet, and the text of its module.
Out: nothing; NotProven if any function's result is not what the sheet says.

The proofs end at expressions.  Here the text itself is imported, in a package of its own, and every
function is called at the contacts of the proof, scalar by scalar and as arrays.
"""

import importlib
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import ModuleType
from typing import Any

import mpmath
import numpy as np
from mpmath import mpf

from derive.codegen.contract import CONTRACT, Function
from derive.codegen.publish import FULL_STICK
from derive.errors import NotProven
from derive.proof.points import Point, contacts, named, numeric
from derive.sheet import FormulaSheet
from derive.symbols import E_star, M, P, a, alpha, c

TOLERANCE = 1e-10
"""Largest error allowed, compared with the size of what is computed; a wrong text is far off."""

_DIGITS = 30

_LARGEST = 1e150
"""Of a load with which a module is tried."""

_CYCLES = 6
"""Contacts at which a stick zone is tried."""


def demand_right(sheet: FormulaSheet, text: str, stuck: str) -> None:
    """Run the module and compare.

    Raises NotProven with the function, the point and both numbers.
    """
    name = sheet.geometry.name
    with imported(name, text, stuck) as module, mpmath.workdps(_DIGITS):
        points = _held(sheet, contacts(sheet))
        for function in CONTRACT:
            if P in function.arguments:
                _demand_inverse(sheet, function, module, points)
            else:
                _demand_forward(sheet, function, module, points)
        _demand_patch(sheet, module, points[:_CYCLES])


def _held(sheet: FormulaSheet, points: list[Point]) -> list[Point]:
    """Contacts whose tilt, load and moment float64 holds, and their squares, too.

    Raises NotProven where these are fewer than half: exp(exp(x/b)) leaves it at x = 6.6 b.
    """
    carried = [numeric(sheet.flat(name)) for name in ("tilt", "load", "moment")]
    found = [p for p in points if all(abs(value(p)) < _LARGEST for value in carried)]
    if len(found) < len(points) / 2:
        raise NotProven(
            f"module of {sheet.geometry.name!r}: tilt, load and moment stay below {_LARGEST:g} at "
            f"{len(found)} of {len(points)} contacts about as wide as its parameters are; float64 "
            "cannot be tried with the others: write a g(x) that rises less steeply"
        )
    return found


def _demand_forward(
    sheet: FormulaSheet, function: Function, module: ModuleType, points: list[Point]
) -> None:
    found = _called(module, function, sheet, points)
    for (field, source), values in zip(function.fields, found, strict=True):
        wanted = [numeric(sheet.flat(str(source)))(point) for point in points]
        scale = max(abs(value) for value in wanted)
        for point, value, right in zip(points, values, wanted, strict=True):
            size = abs(right) + (0 if function.name == "pressure" else scale / 100)
            _demand_close(sheet, f"{function.name} {field}".strip(), value, right, size, point)


def _demand_inverse(
    sheet: FormulaSheet, function: Function, module: ModuleType, points: list[Point]
) -> None:
    """Loads of known contacts lead back to them."""
    forward = {P: "load", M: "moment", alpha: "tilt"}
    given = [
        {**point, **{s: numeric(sheet.flat(name))(point) for s, name in forward.items()}}
        for point in points
    ]
    found = _called(module, function, sheet, given)
    for field, values in zip((a, c, alpha), found, strict=True):
        for point, value in zip(given, values, strict=True):
            size = 100 * (point[a] + point[c]) if field != alpha else 100 + abs(point[alpha])
            label = f"{function.name} {field}"
            _demand_close(sheet, label, value, point[field], size, point)


def _demand_patch(sheet: FormulaSheet, module: ModuleType, points: list[Point]) -> None:
    """Under moderate tension the stick zone is the contact at the reduced load and shifted tilt.

    f = 1/2, dQ a quarter of the load, half of the threshold's tension at either sign in turn.
    """
    constants = [E_star, *(q.symbol for q in sheet.geometry.parameters)]
    for i, point in enumerate(points):
        load, tilt = (numeric(sheet.flat(name))(point) for name in ("load", "tilt"))
        shear, width = load / 4, point[a] + point[c]
        tension = (-1) ** i * 4 * shear / (mpmath.pi * width)
        here = module.Contact(float(point[a]), float(point[c]), float(tilt))
        given = {str(s): float(point[s]) for s in constants}
        zone = module.stick_zone(here, here, float(shear), float(tension), f=0.5, **given)
        stuck = {**point, a: mpf(float(zone.m)), c: mpf(float(zone.n))}
        wanted = {"load": load - shear, "tilt": tilt - tension / (2 * point[E_star])}
        for name, right in wanted.items():
            found = float(numeric(sheet.flat(name))(stuck))
            size = load if name == "load" else load / (point[E_star] * width)
            _demand_close(sheet, f"stick_zone's {name}", found, right, size, point)


def _demand_close(
    sheet: FormulaSheet, label: str, value: float, right: mpf, size: mpf, point: Point
) -> None:
    if not abs(mpf(float(value)) - right) <= TOLERANCE * size:
        raise NotProven(
            f"{label} of {sheet.geometry.name!r} as generated: {value!r} instead of "
            f"{mpmath.nstr(right, 17)} at {named(point)}"
        )


def _called(
    module: ModuleType, function: Function, sheet: FormulaSheet, points: list[Point]
) -> list[Any]:
    """Every field of the result, at all points at once; one of them as plain numbers, too."""
    call = getattr(module, function.name)
    symbols = (*function.arguments, *function.keywords(sheet))
    arrays = {str(s): np.array([float(point[s]) for point in points]) for s in symbols}
    alone = call(**{name: float(values[0]) for name, values in arrays.items()})
    together = call(**arrays)
    fields = together if function.kind else (together,)
    singles = alone if function.kind else (alone,)
    for field, single in zip(fields, singles, strict=True):
        if not np.allclose(field[0], single, rtol=1e-12, atol=0, equal_nan=True):
            raise NotProven(
                f"{function.name} of {sheet.geometry.name!r}: {single!r} alone, {field[0]!r} as "
                f"one of many, at {named(points[0])}"
            )
    return list(fields)


@contextmanager
def imported(name: str, text: str, stuck: str) -> Iterator[ModuleType]:
    """The module in a package of its own, that is forgotten again.

    The runtime is the one that will be copied beside it: it need not be compiled again.
    """
    with tempfile.TemporaryDirectory() as folder:
        package = f"_trial_of_{name}"
        home = Path(folder) / package
        home.mkdir()
        for file, content in {"__init__": "", name: text, FULL_STICK: stuck}.items():
            (home / f"{file}.py").write_text(content, encoding="utf-8")
        sys.path.insert(0, folder)
        importlib.invalidate_caches()
        sys.modules |= {
            module.__name__.replace("derive", package, 1): module for module in _runtime()
        }
        try:
            yield importlib.import_module(f"{package}.{name}")
        finally:
            sys.path.remove(folder)
            for held in [m for m in sys.modules if m.split(".")[0] == package]:
                del sys.modules[held]


def _runtime() -> list[ModuleType]:
    """The modules of the runtime that generated ones import."""
    runtime = importlib.import_module("derive.runtime")
    names = sorted(path.stem for path in Path(runtime.__path__[0]).glob("[a-z]*.py"))
    return [runtime, *(importlib.import_module(f"derive.runtime.{name}") for name in names)]
