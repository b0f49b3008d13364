"""Collect all errors of a claims file and report them together."""

from dataclasses import dataclass

from derive.errors import UserError


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
