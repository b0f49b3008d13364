"""Bodies with kinks, cut there for quadrature, and contacts around these."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from generated._profile import Branch, Curve, Piece, Profile


def profile(
    kinks: Sequence[float],
    corners: Sequence[float],
    curve: Callable[[int, Any], Curve],
    straight: Sequence[int] = (),
    degree: int | None = None,
) -> Profile:
    """The body of which `curve` gives each piece, by its number, at places x."""

    def branch(number: int, place: float, sense: int) -> Branch:
        return lambda t: curve(number, place + sense * t)

    pieces = []
    for number in range(len(kinks) + 1):
        left = branch(number, kinks[number - 1], 1) if number else None
        right = branch(number, kinks[number], -1) if number < len(kinks) else None
        pieces.append(Piece(left, right, straight=number in straight))
    return Profile(lambda: tuple(kinks), lambda: tuple(corners), tuple(pieces), degree=degree)


def contacts(kinks: Sequence[float], seed: int, count: int = 400) -> tuple[Any, Any]:
    """Contacts with edges anywhere, some of them beside a kink."""
    rng = np.random.default_rng(seed)
    left, width = rng.uniform(-3, 1.5, count), 10 ** rng.uniform(-2, 0.7, count)
    near = rng.choice(kinks, count) + rng.choice([-1, 1], count) * 10 ** rng.uniform(-9, -1, count)
    left = np.where(rng.random(count) < 0.4, near, left)
    return -left, left + width
