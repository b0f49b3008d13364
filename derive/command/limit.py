"""A time limit for a search.

In:  seconds.
Out: a context manager that raises LimitReached when they have passed.

On systems with alarms, work in the main thread is interrupted.  Otherwise the search ends when it
next checks the clock.
"""

import signal
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from time import monotonic
from types import FrameType

DEFAULT = 20.0
"""Time limit, in seconds, of the search for the closed forms of one body."""

_NO_LIMIT = 1e6
"""Number of seconds above which no alarm is set; some systems do not support such late alarms."""

_AGAIN = 1.0
"""Seconds until the alarm is repeated, in case the interrupted code has caught the exception."""

_SOON = 0.01
"""The same after a finaliser or the garbage collector, from which nothing can be raised."""

LookAtClock = Callable[[], None]
"""Raises LimitReached when the time is up."""


class LimitReached(Exception):
    """The time limit of a search has been reached."""


@contextmanager
def within(seconds: float) -> Iterator[LookAtClock]:
    """Run a block for at most this many seconds, and within the limit of any enclosing block.

    Raises LimitReached.
    """
    end = monotonic() + seconds

    def look() -> None:
        if monotonic() >= end:
            raise LimitReached

    look()
    if not _has_alarms() or seconds > _NO_LIMIT:
        yield look
        return

    with _unraisable_again():
        before = signal.signal(signal.SIGALRM, _ring)
        outer, interval = signal.getitimer(signal.ITIMER_REAL)
        outer_end = monotonic() + outer if outer else float("inf")
        signal.setitimer(signal.ITIMER_REAL, min(seconds, outer or seconds), _AGAIN)
        try:
            yield look
        finally:
            try:
                left = max(outer_end - monotonic(), _SOON) if outer else 0.0
                signal.setitimer(signal.ITIMER_REAL, left, interval)
            finally:
                signal.signal(signal.SIGALRM, before)


def _ring(number: int, frame: FrameType | None) -> None:
    raise LimitReached


@contextmanager
def _unraisable_again() -> Iterator[None]:
    """Repeat the alarm soon if it occurs in a finaliser or callback, which cannot raise."""
    before = sys.unraisablehook

    def hook(what: "sys.UnraisableHookArgs") -> None:
        if issubclass(what.exc_type, LimitReached):
            signal.setitimer(signal.ITIMER_REAL, _SOON, _AGAIN)
        else:
            before(what)

    sys.unraisablehook = hook
    try:
        yield
    finally:
        sys.unraisablehook = before


def _has_alarms() -> bool:
    return hasattr(signal, "setitimer") and threading.current_thread() is threading.main_thread()
