"""Types of options and arguments: paths, times and formulas."""

import unicodedata
from math import inf
from pathlib import Path

import click

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


def _time(context: click.Context, option: click.Parameter, seconds: float) -> float:
    """Return the seconds, a finite number above zero."""
    if not 0 < seconds < inf:
        raise click.BadParameter(f"{seconds:g} is not a valid time, such as 20", context, option)
    return seconds


time_limit = click.option(
    "--limit",
    type=float,
    callback=_time,
    default=DEFAULT,
    show_default=True,
    metavar="SECONDS",
    help="Time limit for the search for closed forms of one body's integrals.",
)


class WithFormula(click.Command):
    """Accept a formula such as -x + b as an argument; -h is the only one-letter option."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Read the arguments; a blank before a formula keeps it from being an option."""
        shielded = [
            f" {arg}" if arg[:1] == "-" != arg[1:2] and arg != "-h" else arg for arg in args
        ]
        return super().parse_args(ctx, shielded)
