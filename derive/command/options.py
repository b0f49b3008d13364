"""Types of options and arguments: paths, times, texts by name and formulas."""

import unicodedata
from collections.abc import Iterable
from functools import partial
from math import inf
from pathlib import Path

import click

from derive.command.errors import BadOption
from derive.command.limit import DEFAULT


class _Path(click.ParamType):
    """A path without control characters that is not empty, which would mean the current folder."""

    name = "path"

    def convert(
        self, value: str, param: click.Parameter | None, context: click.Context | None
    ) -> Path:
        if not value or any(unicodedata.category(character) == "Cc" for character in value):
            why = f"{value!a} contains a control character" if value else "it is empty"
            self.fail(f"{why}: give the path of a file or directory", param, context)
        return Path(value)


PATH = _Path()


def positive(context: click.Context, option: click.Parameter, value: float) -> float:
    """Return the value of an option, which must be a finite number above zero."""
    if not 0 < value < inf:
        raise click.BadParameter(f"{value:g} is not a finite number above zero", context, option)
    return value


name_values = partial(
    click.option,
    multiple=True,
    callback=lambda context, option, given: parse_name_values(option.opts[0], given),
)
"""An option NAME=TEXT that may be repeated: the text for each name."""


time_limit = click.option(
    "--limit",
    type=float,
    callback=positive,
    default=DEFAULT,
    show_default=True,
    metavar="SECONDS",
    help="Time limit for the search for closed forms of one body's integrals.",
)


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


class WithFormula(click.Command):
    """Accept a formula such as -x + b as an argument; -h is the only one-letter option."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Read the arguments; a blank before a formula keeps it from being an option."""
        shielded = [
            f" {arg}" if arg[:1] == "-" != arg[1:2] and arg != "-h" else arg for arg in args
        ]
        return super().parse_args(ctx, shielded)
