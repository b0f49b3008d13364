"""Collect the errors of a claims file, and describe them.

In:   errors in a file, each with its place.
Out:  one error that reports all of them; or the reason why one claim cannot be judged.
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TypeVar

from derive.check.schema import Place
from derive.command.errors import BadClaimsFile, BadFormula, UserError
from derive.command.limit import LimitReached, within

Read = TypeVar("Read")

_SHOWN = 4
_LONGEST = 80
"""The largest number of words and characters of a formula that show where an error occurred."""


@dataclass
class Mistakes(UserError):
    """Several errors in one file, each with its location."""

    messages: tuple[str, ...]

    @property
    def message(self) -> str:
        """The number of errors, then all messages, one on each line."""
        return "\n".join([f"The claims file has {len(self.messages)} errors:", *self.messages])


class Collected(list[UserError]):
    """The errors that have been found so far."""

    @contextmanager
    def noted(self) -> Iterator[None]:
        """Leave the block at its first error and record this error."""
        try:
            yield
        except UserError as error:
            self.append(error)

    def demand_none(self) -> None:
        """Raise a single error as it is, and several as Mistakes."""
        messages = tuple(dict.fromkeys(error.message for error in self))
        if messages:
            raise self[0] if len(messages) == 1 else Mistakes(messages)


def limited(seconds: float, place: Place, read: Callable[[], Read]) -> Read:
    """Return the result of `read`; raise BadClaimsFile if it fails or takes too long."""
    try:
        with within(seconds):
            return read()
    except UserError:
        raise
    except LimitReached:
        why = f"it could not be read within {seconds:g} s"
        remedy = "simplify it, or increase `seconds`"
    except Exception as error:  # an error in SymPy must not stop the other claims
        why = f"it could not be read: an error in the algebra ({type(error).__name__})"
        remedy = "write it in another form"
    raise place.bad(why, remedy)


def reason(error: UserError, place: Place | None = None) -> str:
    """Describe an error in one line, without the place of the claim in which it is."""
    if isinstance(error, BadFormula):
        part = error.where.removeprefix(str(place)).lstrip(": ") if place else ""
        rest = " ".join(error.given[error.column :].split()[:_SHOWN])[:_LONGEST]
        at = f"at `{rest}`" if rest else "at the end"
        return f"{part}{': ' * bool(part)}{error.why}, {at}: {error.remedy}"
    if isinstance(error, BadClaimsFile):
        why = error.why.removeprefix(place.what).lstrip(": ") if place else error.why
        return f"{why}: {error.remedy}"
    return error.message
