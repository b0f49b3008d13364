"""The functions that are solved for, whatever body: time, blocks, threads, Dask, no compiler.

Values are tested in tests/generated, types and shapes in test_arrays.py.
"""

import importlib
import inspect
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from types import ModuleType
from typing import Any

import dask.array as da
import numpy as np
import pytest
from numpy.testing import assert_allclose

from generated import wedge
from generated.runtime.types import Contact
from tests.commands import python

OWN = {
    "wedge": {"phi": 0.25},
    "flat_rounded": {"R": 1.5, "b": 0.5},
    "hyperbola": {"phi": 0.25, "b": 0.5},
}
"""A closed formula with a corner; sums over parts, solved for; quadrature, solved for."""
NAMES = ["contact", "contact_at_tilt", "stick_zone", "tension_threshold"]
NAMES += ["slip_zones", "slip_error", "shear_change", "slip_range", "shear", "march"]
EACH = pytest.mark.parametrize(
    ("body", "name"),
    [(b, n) for b in OWN for n in NAMES if b != "wedge" or n not in ("contact", "contact_at_tilt")]
    + [("hyperbola", n) for n in ("load", "tilt", "pressure", "K_N", "L_N")],
)
INSTANTS = 4


def module(body: str) -> ModuleType:
    return importlib.import_module(f"generated.{body}")


def cases(body: str, name: str, count: int = 7) -> dict[str, Any]:
    """Values of every argument that has no default: `count` cycles of moderate tension."""
    of, own = module(body), OWN[body]
    a, c = 1.25 + 0.25 * np.random.default_rng(3).uniform(size=(2, count))
    P, M = of.load(a, c, E_star=1.25, **own), of.moment(a, c, E_star=1.25, **own)
    dQ, here = 0.125 * P, Contact(a, c, of.tilt(a, c, **own))
    held = {"a": a, "c": c, "P": P, "M": M, "alpha": here.alpha, "x": 0.3 * (c - a) + 0.1 * a}
    held |= {"first": here, "second": here, "contact": here, "f": 0.5, "E_star": 1.25, **own}
    held |= {"dQ": dQ, "dsigma": dQ / (a + c), "Q": 0.75 * dQ, "sigma": 0.75 * dQ / (a + c)}
    if name in ("march", "history"):
        held |= {"P": P[:, None], "M": M[:, None], "Q": dQ[:, None] * [0.0, 0.5, 1.0, 0.5]}
        held |= {"sigma": 0.0}
    parameters = inspect.signature(getattr(of, name)).parameters.values()
    wanted = {p.name for p in parameters if p.default is p.empty or p.name in ("dQ", "dsigma", "M")}
    return {k: v for k, v in held.items() if k in wanted}


def each(given: dict[str, Any], change: Callable[[Any], Any]) -> dict[str, Any]:
    """Every array changed, those of contacts, too."""
    return {
        k: Contact(*map(change, v)) if isinstance(v, Contact) else change(v) if np.ndim(v) else v
        for k, v in given.items()
    }


def pulled(body: str, name: str) -> Iterator[dict[str, Any]]:
    """A cycle of moderate tension; on a wedge, which is the quickest, also one of large tension,
    and one in which slip turns round."""
    given = cases(body, name, 1)
    yield given
    if body == "wedge" and {"dsigma", "sigma"} & given.keys():
        yield given | {k: 4 * given[k] for k in ("dsigma", "sigma") if k in given}
    if body == "wedge" and name == "stick_zone":
        h = given["first"].a + given["first"].c
        yield given | {"dsigma": -1.1 * 8 * given["dQ"] / (np.pi * h), "mixed": True}


ALIKE = {
    "wedge": [*NAMES, "history"],
    "flat_rounded": ["contact", "contact_at_tilt", "stick_zone", "slip_zones"],
    "hyperbola": ["contact", "load", "pressure", "K_N", "L_N"],
}
"""What is also run as plain Python, which is slow."""


def fields(result: Any) -> tuple[Any, ...]:
    """Those that are told: without places a history has no shear."""
    found = result if isinstance(result, tuple) else (result,)
    return tuple(field for field in found if field is not None)


def called(body: str, name: str, given: dict[str, Any]) -> tuple[Any, ...]:
    with np.errstate(all="raise"):
        return fields(getattr(module(body), name)(**given))


def same(got: tuple[Any, ...], wanted: tuple[Any, ...], rtol: float = 1e-12) -> None:
    for one, other in zip(got, wanted, strict=True):
        assert one.shape == other.shape and one.dtype == other.dtype
        assert_allclose(one, other, rtol=rtol, atol=1e-15)


# ------------------------------------------------------------------ cases, time and blocks


def test_threads_do_not_disturb_each_other() -> None:
    asked = [(b, n, cases(b, n, 50)) for b in OWN for n in ("stick_zone", "slip_zones", "march")]
    wanted = [called(*each_) for each_ in asked]
    with ThreadPoolExecutor(4) as pool:
        for got, known in zip(pool.map(lambda v: called(*v), asked * 2), wanted * 2, strict=True):
            same(got, known)


# ------------------------------------------------------------------ what is refused

LAW: dict[str, float] = {"E_star": 1.0, "phi": 0.25}
HERE = Contact(1.0, 1.0, 0.0)


@pytest.mark.parametrize(
    ("call", "kind", "words"),
    [
        (lambda: wedge.stick_zone((1, 1), HERE, 0.1, 0, f=1, **LAW), TypeError,
         r"first must be a Contact, as returned by contact\(...\); got \(1, 1\)"),
        (lambda: wedge.shear(0.2, 1.5, 0.1, 0, f=1, **LAW), TypeError, "contact must be a Contact"),
        (lambda: wedge.stick_zone(HERE, HERE, 0.1, 0, f=1, **LAW, mixed=1), TypeError,
         "mixed must be True or False"),
        (lambda: wedge.slip_zones(1, 1, 0.1, 0, f=1, **LAW, order=1.0), TypeError,
         "order must be a whole number; got 1.0"),
        (lambda: wedge.slip_zones(1, 1, 0.1, 0, f=1, **LAW, order=True), TypeError, "whole number"),
        (lambda: wedge.slip_error(1, 1, 0.1, 0, f=1, **LAW, order=9), ValueError,
         "order must be 1 or 2; got 9"),
        (lambda: wedge.march(1, 0, [0, 0.1], 0, f=[1, 2], **LAW), ValueError,
         "must not change along the last axis"),
        (lambda: wedge.march(1, 0, [], 0, f=1, **LAW), ValueError, "2 or more values"),
    ],
)  # fmt: skip
def test_what_is_refused_is_told(
    call: Callable[[], Any], kind: type[Exception], words: str
) -> None:
    with pytest.raises(kind, match=words):
        call()


# ------------------------------------------------------------------ Dask


class Computed(Exception):
    """A chunk was computed."""


def trapped(block: Any) -> Any:
    raise Computed


@EACH
def test_dask_arrays_stay_lazy_and_give_the_same(body: str, name: str) -> None:
    given = cases(body, name)

    def lazy(value: Any) -> Any:
        return da.from_array(value, chunks=(3, *np.shape(value)[1:]))

    found = called(body, name, each(given, lazy))
    for field, known in zip(found, called(body, name, given), strict=True):
        assert isinstance(field, da.Array) and field.chunks[0] == (3, 3, 1)
        assert field.dtype == known.dtype and field.shape == known.shape
        value = field.compute(scheduler="synchronous")
        assert value.dtype == known.dtype
        assert_allclose(value, known, rtol=1e-12, atol=1e-15)
    raising = each(given, lambda v: lazy(v).map_blocks(trapped, meta=np.empty((0,) * v.ndim)))
    for field in called(body, name, raising):
        with pytest.raises(Computed):
            field.compute(scheduler="synchronous")


# ------------------------------------------------------------------ without a compiler

PLAIN = """
import sys
from tests.runtime.test_cycle import ALIKE, called, pulled
from generated.runtime.kernels import COMPILED
assert not COMPILED
for body, names in ALIKE.items():
    for name in names:
        for given in pulled(body, name):
            for value in called(body, name, given):
                print(*map(repr, map(float, value.ravel())))
"""


@pytest.mark.slow
def test_plain_python_gives_what_is_compiled() -> None:
    done = python(PLAIN, NUMBA_DISABLE_JIT="1")
    assert done.returncode == 0, done.stderr
    lines = iter(done.stdout.splitlines())
    for body, names in ALIKE.items():
        for name in names:
            for given in pulled(body, name):
                for known in called(body, name, given):
                    found = [float(number) for number in next(lines).split()]
                    assert_allclose(found, known.ravel(), rtol=1e-11, atol=1e-15, err_msg=name)
