"""Random texts of g(x): an answer or one clear error, within the limits, and never a traceback."""

import random
import time

import pytest

from derive.command.errors import UserError
from derive.command.new_geometry import TEXT_LIMITS, Wanted, in_limited_process

ATOMS = ("x", "x", "R", "b", "phi", "2", "0.5", "1e300", "10**9", "pi", "1/0", "oo", "()", "")
CALLS = ("exp", "cosh", "Abs", "sqrt", "log", "Max", "tan", "atan2", "gamma", "eval", "__import__")
SIGNS = ("+", "-", "*", "/", "**", "^", "<", ",", " ", ";", "=")


def text(rng: random.Random, depth: int = 0) -> str:
    """A formula, or what looks like one."""
    kind = rng.random()
    if depth > 4 or kind < 0.25:
        return rng.choice(ATOMS)
    if kind < 0.65:
        sign = rng.choice(SIGNS[: rng.choice((5, 5, 11))])
        return f"{text(rng, depth + 1)}{sign}{text(rng, depth + 1)}"
    if kind < 0.9:
        return f"{rng.choice(CALLS)}({text(rng, depth + 1)})"
    return f"({text(rng, depth + 1)}"


@pytest.mark.slow
@pytest.mark.enough("0")
@pytest.mark.parametrize("part", range(200))
def test_every_text_gets_an_answer(part: int) -> None:
    """A thousand of them, five at a time."""
    rng = random.Random(part)
    for _ in range(5):
        profile = text(rng)
        began = time.monotonic()
        try:
            in_limited_process(Wanted("random_body", profile))
        except UserError as error:
            assert error.message, profile
        assert time.monotonic() - began < TEXT_LIMITS.seconds + 20, profile
