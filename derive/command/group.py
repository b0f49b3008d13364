"""How a command begins and ends: messages about what is wrong, and exit statuses."""

import errno
import os
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from traceback import walk_tb
from typing import Any

import click

from derive.command.errors import NotProven, UserError
from derive.command.processes import end
from derive.command.terminal import command, complain, output, remark

FELL_SHORT, BAD_INPUT, INTERRUPTED, UNREAD = 1, 2, 130, 141
"""Exit statuses: a check failed; the input is invalid; what a shell reports for SIGINT, and for
SIGPIPE if the reader of the output has closed it."""


class Commands(click.Group):
    """Show a user's mistake as a single message, and exit with the matching status."""

    def make_context(self, *args: Any, **more: Any) -> click.Context:
        """Read the arguments; `--help` and `--version` print here."""
        with _stopped_from_outside():
            return super().make_context(*args, **more)

    def invoke(self, ctx: click.Context) -> object:
        """Run a command."""
        try:
            with _stopped_from_outside():
                done = super().invoke(ctx)
                sys.stdout.flush()
                return done
        except UserError as error:
            complain("Error", error.message.replace("`derive ", f"`{command()} "))
            ctx.exit(BAD_INPUT)
        except NotProven as error:
            complain("Not proven", str(error))
            ctx.exit(FELL_SHORT)

    def main(self, *args: Any, **more: Any) -> Any:
        """Run a command, and report what the system refused."""
        try:
            _demand_surroundings()
            signal.signal(signal.SIGTERM, end)
            return super().main(*args, **more)
        except OSError as error:
            complain("Error", _what_failed(error))
            _forget_the_output()
            sys.exit(BAD_INPUT)


@contextmanager
def _stopped_from_outside() -> Iterator[None]:
    """End with the status that shells use if Ctrl-C is pressed, or the output is closed."""
    try:
        yield
    except (KeyboardInterrupt, click.Abort):  # a question ends with Abort
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        remark("Interrupted")
        sys.exit(INTERRUPTED)
    except BrokenPipeError:
        _forget_the_output()
        sys.exit(UNREAD)


def _what_failed(error: OSError) -> str:
    """What the system refused, and where."""
    passed = [frame.f_code for frame, _ in walk_tb(error.__traceback__)]
    flushing = passed[-1] is Commands.invoke.__code__
    if flushing or {click.echo.__code__, output.__code__} & {*passed}:
        return f"standard output cannot be written: {error.strerror}"
    return f"{error.strerror}{f': {error.filename}' if error.filename else ''}"


def _demand_surroundings() -> None:
    """Check that there is a standard output and a working directory.

    A closed standard error becomes the null device; the next file would otherwise take its place.
    """
    if sys.stdout is None:
        raise OSError(errno.EBADF, "the standard output is closed, so nothing can be printed")
    if sys.stderr is None:
        os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
        os.set_inheritable(2, True)
        sys.stderr = os.fdopen(2, "w", closefd=False)
    try:
        Path.cwd()
    except OSError as error:
        why = "the working directory no longer exists: change to another directory"
        raise OSError(error.errno, why) from error


def _forget_the_output() -> None:
    """Prevent a second attempt, at the end of the process, to write the output that failed."""
    with suppress(OSError, AttributeError):  # closed, or not a file
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
