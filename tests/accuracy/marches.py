"""A short history and what sticks in it: contacts from loads, and the patch of moderate tension.

Shear and tension rise from their least to their greatest value and fall again; the normal loads
stay or come with them.  An instant on the way up, one after the reversal.
"""

from collections.abc import Sequence

import numpy as np
from mpmath import mpf

from tests.accuracy.definitions import formula
from tests.accuracy.reference import Given, Problem
from tests.accuracy.tensions import patch

WAY = np.array([0.0, 0.3, 0.75, 1.0, 0.8, 0.4])
"""How far the loads have come, instant by instant."""

INSTANTS = {2: 0, 5: 3}
"""Instants that are judged, and when their half-cycles began."""

LOADS = ("P", "M", "Q", "sigma")

FIELDS = tuple(f"{name} {when}" for when in ("rising", "falling") for name in "acmn")


def at(name: str, instant: int) -> str:
    """What a load is called at an instant."""
    return f"{name}_{instant}"


def march(body: str) -> Problem:
    """Contact and stick zone at both instants."""
    load, moment = formula(body, "load"), formula(body, "moment")
    zone = patch(body)

    def contact(edges: Sequence[mpf], given: Given, instant: int) -> list[mpf]:
        there = {**given, "a": edges[0], "c": edges[1]}
        return [load(**there) - given[at("P", instant)], moment(**there) - given[at("M", instant)]]

    def off(unknowns: Sequence[mpf], given: Given) -> list[mpf]:
        found: list[mpf] = []
        pairs = [unknowns[i : i + 2] for i in range(0, len(unknowns), 2)]
        for (now, before), here, stuck, begun in zip(
            INSTANTS.items(), pairs[::3], pairs[1::3], pairs[2::3], strict=True
        ):
            sense = 1 if now < 3 else -1
            cycle = dict(given) | {"a": here[0], "c": here[1], "a_2": begun[0], "c_2": begun[1]}
            for name, load_name in (("dQ", "Q"), ("dsigma", "sigma")):
                cycle[name] = sense * (given[at(load_name, now)] - given[at(load_name, before)])
            found += [*contact(here, given, now), *zone(stuck, cycle)]
            found += contact(begun, given, before)
        return found

    def told(unknowns: Sequence[mpf], _: Given) -> list[mpf]:
        return [*unknowns[:4], *unknowns[6:10]]

    return Problem(off, told)
