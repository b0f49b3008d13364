"""The loads of a state, and the straight line between two states."""

from typing import NamedTuple


class State(NamedTuple):
    """P, M and Q per unit depth, and the differential bulk tension sigma."""

    P: float
    M: float = 0.0
    Q: float = 0.0
    sigma: float = 0.0

    def towards(self, other: "State", part: float) -> "State":
        """The state at a fraction of the way to another one, with all loads in phase.

        >>> State(1, 0, -1, 4).towards(State(3, 1, 1, 0), 0.5)
        State(P=2.0, M=0.5, Q=0.0, sigma=2.0)
        """
        return State(*(u + part * (v - u) for u, v in zip(self, other, strict=True)))
