"""A mistake is told in another process as it was told in its own."""

import dataclasses
import pickle

import pytest

from derive.command import errors
from derive.command.errors import BadUnit, UserError

FACTS = {
    "str": "some 'text', α",
    "int": 3,
    "float": 2.5,
    "float | None": 2.5,
    "tuple[str, ...]": ("hertz", "wedge"),
    "object": object(),
}


def example(kind: type[UserError]) -> UserError:
    """One mistake, made by the names of its facts."""
    return kind(**{fact.name: FACTS[annotation(fact)] for fact in dataclasses.fields(kind)})


def annotation(fact: "dataclasses.Field[object]") -> str:
    return fact.type.__name__ if isinstance(fact.type, type) else str(fact.type)


MISTAKES = [
    example(kind)
    for kind in vars(errors).values()
    if dataclasses.is_dataclass(kind) and issubclass(kind, UserError)
]


def there_and_back(error: UserError) -> UserError:
    return pickle.loads(pickle.dumps(error))


@pytest.mark.parametrize("mistake", MISTAKES, ids=lambda mistake: type(mistake).__name__)
def test_a_mistake_travels_with_its_message(mistake: UserError) -> None:
    arrived = there_and_back(mistake)
    assert type(arrived) is type(mistake)
    assert arrived.message == str(arrived) == mistake.message


def test_what_cannot_travel_is_told_by_how_it_is_shown() -> None:
    """A function without a name in a module that nobody can import."""
    mistake = BadUnit(lambda: 3, "is no text")
    assert there_and_back(mistake).message == mistake.message
