"""Runs the printed module and compares its results with the sheet, before anything is written.

In:  a proven FormulaSheet and the text of its module.
Out: nothing; raises NotProven if the result of any function does not agree with the sheet.

The proofs cover expressions only.  Here the text itself is imported in a package of its own, and
every function is called with arrays of the contacts of the proof.
"""

import importlib
import os
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from types import ModuleType

import mpmath
import numpy as np
from mpmath import mpf

from derive.codegen.contract import CONTRACT, Function
from derive.codegen.publish import FULL_STICK, LIBRARY, RUNTIME
from derive.command.errors import NotProven
from derive.proof.points import Point, contacts, named, numeric
from derive.proof.verdict import WORKING
from derive.sheet.formulas import FormulaSheet
from derive.symbols import E_star, M, P, a, alpha, c

TOLERANCE = 1e-10
"""Largest error allowed, relative to the size of the result; the error of a wrong formula is much
larger."""

_LARGEST = 1e150
"""Largest tilt, load or moment at which a module is tried."""

_CYCLES = 6
"""Number of contacts at which a stick zone is tried."""


_CARRIED = {P: "load", M: "moment", alpha: "tilt"}
"""Formulas of what a contact carries."""


def demand_right(sheet: FormulaSheet, text: str, stuck: str) -> None:
    """Run the module and compare its results with the sheet.

    Raises NotProven, which names the function, the point and both numbers.
    """
    name = sheet.geometry.name
    with imported(name, text, stuck) as module, mpmath.workdps(WORKING):
        points = _usable(sheet)
        for function in CONTRACT:
            _demand_agreement(sheet, function, module, points)
        _demand_patch(sheet, module, points[:_CYCLES])


def _usable(sheet: FormulaSheet) -> list[Point]:
    """Contacts with what they carry, which is in the range of float64, as are its squares.

    Raises NotProven if these are fewer than half of the contacts.  For example, exp(exp(x/b))
    leaves the range at x = 6.6 b.
    """
    carried = {symbol: numeric(sheet.flat(name)) for symbol, name in _CARRIED.items()}
    points = [{**p, **{s: value(p) for s, value in carried.items()}} for p in contacts(sheet)]
    usable = [p for p in points if all(abs(p[symbol]) < _LARGEST for symbol in carried)]
    if len(usable) < len(points) / 2:
        raise NotProven(
            f"module of {sheet.geometry.name!r}: tilt, load and moment are below {_LARGEST:g} at "
            f"only {len(usable)} of {len(points)} contacts whose widths are similar to the "
            "parameters, and at least half are needed to test the module in float64; write a g(x) "
            "that rises less steeply"
        )
    return usable


def _demand_agreement(
    sheet: FormulaSheet, function: Function, module: ModuleType, points: list[Point]
) -> None:
    """Compare every field with the sheet; the contact at the loads of a contact is that contact."""
    symbols = (*function.arguments, *function.keywords(sheet))
    given = {str(s): np.array([float(point[s]) for point in points]) for s in symbols}
    results = getattr(module, function.name)(**given)
    fields = results if function.kind else (results,)
    for (field, source), found in zip(function.fields, fields, strict=True):
        if P in function.arguments:
            symbol = {"a": a, "c": c, "alpha": alpha}[field]
            wanted = [point[symbol] for point in points]
            sizes = [
                100 + abs(p[alpha]) if field == "alpha" else 100 * (p[a] + p[c]) for p in points
            ]
        else:
            wanted = [numeric(sheet.flat(str(source)))(point) for point in points]
            scale = 0 if function.name == "pressure" else max(map(abs, wanted)) / 100
            sizes = [abs(right) + scale for right in wanted]
        label = f"{function.name} {field}".strip()
        for value, right, size, point in zip(found, wanted, sizes, points, strict=True):
            _demand_close(sheet, label, value, right, size, point)


def _demand_patch(sheet: FormulaSheet, module: ModuleType, points: list[Point]) -> None:
    """Demand that stick zones under moderate tension agree with contacts at other loads.

    The stick zone is the contact at a reduced load and a shifted tilt.  Here f = 1/2, dQ is a
    quarter of the load, and the tension is half of the threshold, with alternating sign.
    """
    constants = [E_star, *(q.symbol for q in sheet.geometry.parameters)]
    for i, point in enumerate(points):
        load, tilt, width = point[P], point[alpha], point[a] + point[c]
        shear = load / 4
        tension = (-1) ** i * 4 * shear / (mpmath.pi * width)
        here = module.Contact(float(point[a]), float(point[c]), float(tilt))
        given = {str(s): float(point[s]) for s in constants}
        zone = module.stick_zone(here, here, float(shear), float(tension), f=0.5, **given)
        stuck = {**point, a: mpf(float(zone.m)), c: mpf(float(zone.n))}
        expected = {"load": load - shear, "tilt": tilt - tension / (2 * point[E_star])}
        for name, right in expected.items():
            value = float(numeric(sheet.flat(name))(stuck))
            size = load if name == "load" else load / (point[E_star] * width)
            _demand_close(sheet, f"{name} of stick_zone", value, right, size, point)


def _demand_close(
    sheet: FormulaSheet, label: str, value: float, right: mpf, size: mpf, point: Point
) -> None:
    if not abs(mpf(float(value)) - right) <= TOLERANCE * size:
        raise NotProven(
            f"{label} of {sheet.geometry.name!r}: the generated code returned {value!r} instead of "
            f"{mpmath.nstr(right, 17)} at {named(point)}"
        )


@contextmanager
def imported(name: str, text: str, stuck: str) -> Iterator[ModuleType]:
    """The module, imported from a folder that is removed again afterwards.

    Its solvers run as plain Python: compiling them takes longer than running them a few times.
    """
    package = _plain_package()
    modules = [f"{_PLAIN}.{file}" for file in (name, FULL_STICK)]
    with tempfile.TemporaryDirectory() as folder:
        for file, content in {name: text, FULL_STICK: stuck}.items():
            (Path(folder) / f"{file}.py").write_text(content, encoding="utf-8")
        package.__path__.insert(0, folder)
        importlib.invalidate_caches()
        before = {module: sys.modules.pop(module, None) for module in modules}
        try:
            yield importlib.import_module(modules[0])
        finally:
            package.__path__.remove(folder)
            for module in modules:
                del sys.modules[module]
            sys.modules |= {module: held for module, held in before.items() if held}


_PLAIN = "_plain_generated"
"""The name under which the generated package is imported as plain Python."""


@cache
def _plain_package() -> ModuleType:
    """The package whose runtime is plain Python, beside a compiled one that the user may have."""
    spec = spec_from_file_location(_PLAIN, LIBRARY.parent / "__init__.py")
    assert spec and spec.loader
    package = sys.modules[_PLAIN] = module_from_spec(spec)
    before = os.environ.get(_SWITCH)
    os.environ[_SWITCH] = "1"
    try:
        importlib.import_module(f"{_PLAIN}.{RUNTIME}.kernels")
    finally:
        del os.environ[_SWITCH]
        os.environ |= {_SWITCH: before} if before is not None else {}
    return package


_SWITCH = "NUMBA_DISABLE_JIT"
"""numba's own setting, which runtime/kernels.py reads when it is imported."""
