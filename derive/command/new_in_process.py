"""Drafts a geometry file in a separate process, because SymPy can take very long for a short text.

This module does not import SymPy; only the other process does.
"""

from collections.abc import Mapping
from typing import NamedTuple

from derive.command.processes import Bounds, Report, in_processes

BOUNDS = Bounds(seconds=60, gigabytes=2)
"""The limits for one text; each body of the library takes about a second."""


class Asked(NamedTuple):
    """A user's description of a new geometry; see `derive.command.new_geometry.Wanted`."""

    name: str
    profile: str
    title: str
    units: Mapping[str, str]
    meanings: Mapping[str, str]


class Made(NamedTuple):
    """The text of the file, g(x), and the name, unit and meaning of each parameter."""

    text: str
    g: str
    parameters: tuple[tuple[str, str, str], ...]


def drafted(asked: Asked, bounds: Bounds = BOUNDS) -> Made:
    """The file for a new geometry.

    Raises RanAway if the process exceeds its limits, and the exceptions of `draft`.
    """
    (made,) = in_processes(_drafted, [asked], lambda *_: None, 1, bounds)
    return made


def _drafted(asked: Asked, report: Report) -> Made:
    from derive.command.new_geometry import Wanted, draft

    report(f"g of {asked.name!r}", "reading g(x)")
    made = draft(Wanted(*asked))
    parameters = tuple((p.name, p.unit, p.meaning) for p in made.geometry.parameters)
    return Made(made.text, str(made.geometry.g), parameters)
