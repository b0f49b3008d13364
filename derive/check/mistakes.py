"""Collect the errors of a claims file, and describe them.

In:   errors in a file, each with its place.
Out:  one error that reports all of them; or the reason why one claim cannot be judged.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field

from derive.check.entries import Place
from derive.command.errors import BadClaimsFile, BadFormula, UserError

_SHOWN = 30
"""The largest number of characters of a formula that a reason shows."""


@dataclass
class Mistakes(UserError):
    """Several errors in one file, each with its location."""

    messages: tuple[str, ...]

    @property
    def message(self) -> str:
        """The number of errors, then all messages, one on each line."""
        return "\n".join([f"The claims file has {len(self.messages)} errors:", *self.messages])


def demand_none(errors: list[UserError]) -> None:
    """Raise a single error as it is, and several as Mistakes."""
    messages = tuple(dict.fromkeys(error.message for error in errors))
    if len(messages) == 1:
        raise errors[0]
    if messages:
        raise Mistakes(messages)


@dataclass
class Collected:
    """The errors of a file that have been found so far."""

    errors: list[UserError] = field(default_factory=list)

    @contextmanager
    def noted(self) -> Iterator[None]:
        """Leave the block at its first error and record this error."""
        try:
            yield
        except UserError as error:
            self.errors.append(error)


def reason(error: UserError, place: Place | None = None) -> str:
    """Describe an error in one line, without the place of the claim in which it is."""
    if isinstance(error, BadFormula):
        part = error.where.removeprefix(str(place)).lstrip(": ") if place else ""
        rest = " ".join(error.given[error.column :].split())
        at = f"at {_cut(rest)}" if rest else "at the end"
        return f"{part}{': ' * bool(part)}{error.why}, {at}: {error.remedy}"
    if isinstance(error, BadClaimsFile):
        why = error.why.removeprefix(place.what).lstrip(": ") if place else error.why
        return f"{why}: {error.remedy}"
    return error.message


def _cut(text: str) -> str:
    return text if len(text) <= _SHOWN else f"{text[:_SHOWN]}..."
