"""What partial slip needs of a body: its functions, and the places where its curve is cut."""

from collections.abc import Callable
from typing import Any, NamedTuple

from ._types import Array, Contact


class Law(NamedTuple):
    """The functions of one body that partial slip is made of; the integrand is the pressure.

    kinks: places where the curve is cut.
    third: coefficients of s**(5/2) in the pressure next to the edges; None if nothing gives them.
    smooth: numbers of the cuts that one curve goes across.
    """

    contact: Callable[..., Contact]
    contact_at_tilt: Callable[..., Contact]
    tilt: Callable[..., Array]
    load: Callable[..., Array]
    moment: Callable[..., Array]
    pressure: Callable[..., Array]
    integrand: Callable[..., Array]
    K_N: Callable[..., Any]
    L_N: Callable[..., Any]
    kinks: Callable[..., tuple[Array, ...]]
    third: Callable[..., Any] | None = None
    smooth: tuple[int, ...] = ()

    def tilt_of(self, a: Array, c: Array, constants: dict[str, Array]) -> Array:
        """alpha; of all constants those that are the profile's."""
        return self.tilt(a, c, **_profile(constants))

    def places(self, constants: dict[str, Array]) -> tuple[Array, ...]:
        """Where its curve is cut."""
        return self.kinks(**_profile(constants))

    def bends(self, constants: dict[str, Array]) -> tuple[Array, ...]:
        """Where one curve ends and another begins."""
        found = enumerate(self.places(constants))
        return tuple(place for i, place in found if i not in self.smooth)


def _profile(constants: dict[str, Array]) -> dict[str, Array]:
    return {name: value for name, value in constants.items() if name != "E_star"}
