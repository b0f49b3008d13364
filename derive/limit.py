"""A limit on the time that a search may take.

In:  seconds.
Out: a block that is left by LimitReached when they are over.

Where the system has alarms, whatever is at work in the main thread is broken off; elsewhere the
search ends at the next place where it looks at the clock.
"""

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from time import monotonic
from types import FrameType

DEFAULT = 20.0
"""Seconds that the search for the closed forms of one body may take."""

_NO_LIMIT = 1e6
"""Seconds that no search takes; some systems have no alarm that late."""

_AGAIN = 1.0
"""Seconds until it rings once more, if what was at work has swallowed it."""

LookAtClock = Callable[[], None]
"""Raises LimitReached when the time is over."""


class LimitReached(Exception):
    """The time that a search was given is over."""


@contextmanager
def within(seconds: float) -> Iterator[LookAtClock]:
    """Run a block for so many seconds at most.

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

    def ring(number: int, frame: FrameType | None) -> None:
        raise LimitReached

    before = signal.signal(signal.SIGALRM, ring)
    signal.setitimer(signal.ITIMER_REAL, seconds, _AGAIN)
    try:
        yield look
    finally:
        try:
            signal.setitimer(signal.ITIMER_REAL, 0)
        finally:
            signal.signal(signal.SIGALRM, before)


def _has_alarms() -> bool:
    return hasattr(signal, "setitimer") and threading.current_thread() is threading.main_thread()
