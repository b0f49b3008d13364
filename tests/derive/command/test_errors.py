"""A mistake says its facts, and is told in another process as it was told in its own."""

import pickle

import pytest

from derive.command import errors
from derive.command.errors import BadUnit, UserError

KINDS = [k for k in vars(errors).values() if isinstance(k, type) and issubclass(k, UserError)]
MISTAKES = [
    kind(**{name: 3 if name == "column" else f"some '{name}', α" for name in kind.facts})
    for kind in KINDS
    if kind is not UserError
]


@pytest.mark.parametrize("mistake", MISTAKES, ids=lambda mistake: type(mistake).__name__)
def test_a_mistake_tells_its_facts_and_travels_with_them(mistake: UserError) -> None:
    mistake.remedy = "changed"  # as what knows more about the mistake may do
    for name in mistake.facts:
        assert name in mistake.message or name in ("column", "remedy"), name
    arrived = pickle.loads(pickle.dumps(mistake))
    assert type(arrived) is type(mistake)
    assert arrived.message == str(arrived) == mistake.message


@pytest.mark.parametrize("facts", [{"given": "kg"}, {"given": "kg", "why": "", "colour": "red"}])
def test_a_mistake_is_not_made_without_its_facts_or_with_others(facts: dict[str, str]) -> None:
    with pytest.raises(TypeError):
        BadUnit(**facts)
