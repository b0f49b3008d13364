"""Times of several calls that do the same, round by round; memory; what it was measured with."""

import platform
import tracemalloc
from collections.abc import Callable, Mapping
from functools import partial
from importlib import metadata
from pathlib import Path
from statistics import median
from time import perf_counter
from typing import Any

import numpy as np

Call = Callable[[], Any]

Clock = Callable[[int], float]
"""Of how many calls, the seconds of one."""

LEAST = 2e-3
"""Seconds of one measurement at least: quicker calls are repeated."""

AMONG_ITS_LIKE = 5e-2
"""The same where one call is to follow another of its kind: the first after a call that left heap
and caches in another state is one of many then.
"""

MOST_ROUNDS, FEWEST_ROUNDS = 200, 5

PACKAGES = ("numpy", "scipy", "sympy", "numexpr", "numba")


def interleaved(
    calls: Mapping[str, Call], seconds: float, least: float = LEAST
) -> dict[str, float]:
    """Seconds of one call of each, all in this process: medians of `in_turn`."""
    return in_turn({name: partial(timed, call) for name, call in calls.items()}, seconds, least)


def in_turn(clocks: Mapping[str, Clock], seconds: float, least: float = LEAST) -> dict[str, float]:
    """Seconds of one call of each: medians over rounds, for about so many seconds.

    Each round times all in turn, so that a change of the machine's pace meets all of them; one
    measurement takes `least` seconds or one call.
    """
    once = {name: clock(1) for name, clock in clocks.items()}
    once = {name: min(t, clocks[name](1)) for name, t in once.items()}  # it is warm now
    repeats = {name: max(1, int(least / t)) for name, t in once.items()}
    a_round = sum(repeats[name] * t for name, t in once.items())
    rounds = max(FEWEST_ROUNDS, min(MOST_ROUNDS, int(seconds / a_round)))
    times: dict[str, list[float]] = {name: [] for name in clocks}
    for _ in range(rounds):
        for name, clock in clocks.items():
            times[name].append(clock(repeats[name]))
    return {name: median(column) for name, column in times.items()}


def timed(call: Call, repeat: int) -> float:
    """Seconds of one of so many calls."""
    began = perf_counter()
    for _ in range(repeat):
        call()
    return (perf_counter() - began) / repeat


def peak_over_result(call: Call) -> float:
    """Most memory held at once during a call, its result included, over the size of the result.

    NumPy's arrays are seen by tracemalloc; what compiled code holds by itself is not.
    """
    size = size_of(call())
    tracemalloc.start()
    try:
        kept = call()
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    del kept
    return peak / size


def size_of(result: Any) -> int:
    """Bytes of an array, or of the arrays in a tuple or list."""
    if isinstance(result, tuple | list):
        return sum(size_of(part) for part in result)
    return int(result.nbytes)


def versions() -> str:
    """Python and the packages that are there."""
    found = [f"Python {platform.python_version()}"]
    for name in PACKAGES:
        try:
            found.append(f"{name} {metadata.version(name)}")
        except metadata.PackageNotFoundError:
            found.append(f"{name} not there")
    return ", ".join(found)


def compiled_for() -> str:
    """What NumPy's logarithms are compiled for: log1p is fast where that is as new as log's."""
    found = {}
    for name in ("log", "log1p"):
        told = np.lib.introspect.opt_func_info(func_name=f"^{name}$", signature="float64")
        found[name] = next(iter(told[name].values()))["current"]
    return f"NumPy's log is compiled for {found['log']}, its log1p for {found['log1p']}"


def processor() -> str:
    """The kind of processor."""
    cpuinfo = Path("/proc/cpuinfo")
    if cpuinfo.exists():
        for line in cpuinfo.read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    return platform.processor() or platform.machine()
