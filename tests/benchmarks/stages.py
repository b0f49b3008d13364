"""How long each geometry takes to become a module, stage by stage."""

from collections import defaultdict
from collections.abc import Callable
from time import perf_counter

from derive.library import library
from derive.pipeline import STAGES, build

Seconds = dict[str, dict[str, float]]
"""Seconds by body and stage."""


def stages(bodies: tuple[str, ...] = (), report: Callable[[str], None] = print) -> Seconds:
    """Every body of the library built from its g(x), one after the other, nothing kept."""
    found: Seconds = defaultdict(dict)
    for body in bodies or library():
        report(body)
        begun: list[tuple[str, float]] = []

        def entered(_: str, stage: str, begun: list[tuple[str, float]] = begun) -> None:
            begun.append((stage, perf_counter()))

        build(body, entered)
        ends = [at for _, at in begun[1:]] + [perf_counter()]
        for (stage, start), end in zip(begun, ends, strict=True):
            found[body][stage] = end - start
    assert all([*row] == [*STAGES] for row in found.values())
    return found
