"""All that is wrong with a claims file, told in one run."""

from dataclasses import dataclass

from derive.errors import UserError


@dataclass
class Mistakes(UserError):
    """Several mistakes of one file, each a message with its place."""

    messages: tuple[str, ...]

    @property
    def message(self) -> str:
        """All of them, one under the other."""
        return "\n".join([f"{len(self.messages)} mistakes", *self.messages])


def demand_none(found: list[UserError]) -> None:
    """Raise what was found: the one mistake itself, or all of them as Mistakes."""
    messages = tuple(dict.fromkeys(error.message for error in found))
    if len(messages) == 1:
        raise found[0]
    if messages:
        raise Mistakes(messages)
