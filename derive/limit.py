"""A time limit for a search.

In:  seconds.
Out: a block that raises LimitReached when they have passed.

Where the system has alarms, work in the main thread is interrupted; elsewhere the search ends the
next time it looks at the clock.
"""

import signal
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from time import monotonic
from types import FrameType

DEFAULT = 20.0
"""Seconds that the search for the closed forms of one body may take."""

_NO_LIMIT = 1e6
"""Seconds above which no alarm is set; some systems have no alarm that late."""

_AGAIN = 1.0
"""Seconds until the alarm rings again, in case the interrupted code has caught the exception."""

_SOON = 0.01
"""The same after a finaliser or the garbage collector, which cannot raise."""

LookAtClock = Callable[[], None]
"""Raises LimitReached when the time is up."""


class LimitReached(Exception):
    """The time given to a search is up."""


@contextmanager
def within(seconds: float) -> Iterator[LookAtClock]:
    """Run a block for at most so many seconds, and no longer than an enclosing block may run.

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
    """Where nothing can be raised, in finalisers and callbacks, the alarm rings again soon."""
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
