"""A mistake says its facts, and is told in another process as it was told in its own."""

import pickle

import pytest

from derive.command import errors
from derive.command.errors import BadUnit, DimensionMismatch, UnknownGeometry, UserError

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


def test_facts_are_given_in_order_or_by_name_and_may_have_a_default() -> None:
    mistake = DimensionMismatch("g", expected="m", found="m**2")
    assert (mistake.where, mistake.found) == ("g", "m**2")
    assert mistake.message == (
        "the dimension of g is m**2, but must be m: check the units of the parameters and the "
        "powers of x"
    )
    assert "contains hertz, wedge:" in UnknownGeometry("sphere", ("hertz", "wedge")).message
    for facts in ({"given": "kg"}, {"given": "kg", "why": "", "colour": "red"}):
        with pytest.raises(TypeError):
            BadUnit(**facts)
