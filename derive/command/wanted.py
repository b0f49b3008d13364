"""A user's description of a new geometry, and its file, made in a process with limits.

SymPy can take very long for a short text.  This module does not import it; the other process does.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

from derive.command.errors import BadOption
from derive.command.processes import Bounds, Report, in_processes

TEXT_LIMITS = Bounds(seconds=60, gigabytes=2)
"""The limits for the text of one g(x); each body of the library takes about a second."""


@dataclass(frozen=True)
class Wanted:
    """A user's description of a new geometry.

    units, meanings: those of the parameters, by name; both are optional
    """

    name: str
    profile: str
    title: str = ""
    units: Mapping[str, str] = field(default_factory=dict)
    meanings: Mapping[str, str] = field(default_factory=dict)


class Made(NamedTuple):
    """The text of the file, g(x), and the name, unit and meaning of each parameter."""

    text: str
    g: str
    parameters: tuple[tuple[str, str, str], ...]


def in_limited_process(wanted: Wanted, bounds: Bounds = TEXT_LIMITS) -> Made:
    """The file for a new geometry.

    Raises RanAway if the process exceeds its limits, and the exceptions of `new_geometry`.
    """
    (made,) = in_processes(_made, [wanted], lambda *_: None, 1, bounds)
    return made


def _made(wanted: Wanted, report: Report) -> Made:
    from derive.command.new_geometry import new_geometry

    report(f"g of {wanted.name!r}", "reading g(x)")
    geometry, text = new_geometry(wanted)
    parameters = tuple((p.name, p.unit, p.meaning) for p in geometry.parameters)
    return Made(text, str(geometry.g), parameters)


def parse_name_values(option: str, given: Iterable[str]) -> dict[str, str]:
    """The text that an option NAME=TEXT gives for each parameter.

    Raises BadOption.

    >>> parse_name_values("--unit", ["R=m", "phi = rad"])
    {'R': 'm', 'phi': 'rad'}
    """
    texts: dict[str, str] = {}
    for each in given:
        name, equals, text = (part.strip() for part in each.partition("="))
        if not (name and equals and text):
            raise bad_option(option, each, "is not of the form NAME=TEXT")
        if name in texts:
            raise bad_option(option, each, f"{name} is given a second time")
        texts[name] = text
    return texts


def bad_option(option: str, given: str, why: str) -> BadOption:
    """The error for one option, with an example of how to write it."""
    return BadOption(option, given, why, "m" if option == "--unit" else "radius")
