"""Types of options and arguments: paths, times and formulas."""

import unicodedata
from math import inf
from pathlib import Path

import click

from derive.command.errors import BadLimit, BadPath
from derive.command.limit import DEFAULT


class _Path(click.ParamType):
    """A path without control characters that is not empty, which would mean the current folder."""

    name = "path"

    def convert(
        self, value: str, param: click.Parameter | None, context: click.Context | None
    ) -> Path:
        if not value or any(unicodedata.category(character) == "Cc" for character in value):
            is_option = isinstance(param, click.Option)
            assert param is not None
            why = f"{value!a} contains a control character" if value else "is an empty path"
            raise BadPath(param.opts[0] if is_option else param.human_readable_name, why)
        return Path(value)


PATH = _Path()


def _time(context: click.Context, option: click.Parameter, seconds: float) -> float:
    """Return the seconds; raise BadLimit if they are not a valid time limit."""
    if not 0 < seconds < inf:
        raise BadLimit(f"{seconds:g}")
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
