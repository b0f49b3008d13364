"""Problems with tractions between bounds."""

import numpy as np
import pytest

from tests.reference.bounded import Bounded, NoSolution
from tests.reference.kernel import Surface
from tests.reference.mesh import Floats, graded

X = graded([-1, 1], 40)
SURFACE = Surface(X)
PROBLEM = Bounded(SURFACE.influence, SURFACE.force[None, :], np.ones((1, len(X))))
BOUND = np.sqrt(1.0 - X**2)  # carries pi/2


def wavy(seed: int) -> Floats:
    """A polynomial of degree 9."""
    coefficients = 0.1 * np.random.default_rng(seed).normal(size=10)
    return coefficients @ np.cos(np.outer(np.arange(10), np.arccos(X)))


@pytest.mark.parametrize("seed", range(4))
def test_a_solution_meets_every_condition(seed: int) -> None:
    b = wavy(seed)
    t, s, _, places = PROBLEM.solve(b, -BOUND, BOUND, np.array([0.4]))
    assert SURFACE.force @ t == pytest.approx(0.4, rel=1e-12)
    assert np.all(np.abs(t) <= BOUND + 1e-12)
    inside = np.abs(t) < BOUND - 1e-12
    assert np.count_nonzero(~inside) > 3
    assert np.abs(s[inside]).max() <= 1e-12
    assert np.all(s * t <= 1e-9)
    np.testing.assert_array_equal(places[inside], 0)


@pytest.mark.parametrize("seed", range(4))
def test_the_guess_does_not_matter(seed: int) -> None:
    b, guess = wavy(seed), np.sign(wavy(seed + 100)).astype(np.int8)
    loads = np.array([0.4])
    plain = PROBLEM.solve(b, -BOUND, BOUND, loads)
    guess[20] = 0
    guessed = PROBLEM.solve(b, -BOUND, BOUND, loads, guess)
    np.testing.assert_allclose(guessed.traction, plain.traction, atol=1e-10)


def test_more_than_the_bounds_carry_is_refused() -> None:
    with pytest.raises(NoSolution):
        PROBLEM.solve(0 * X, -BOUND, BOUND, np.array([3.0]))
