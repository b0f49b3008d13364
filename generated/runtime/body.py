"""A body, as the functions that are solved numerically take it."""

from collections.abc import Callable
from functools import cached_property
from typing import Any

from .inverse import solve
from .kernels import Law, handed


class Body:
    """A body: its law, which is compiled when it is first used, and where it is defined.

    module  name of the module that defines the body as _BODY
    law     pressure, state, slope, series and breaks, as `Law` describes them
    """

    def __init__(self, module: str, *law: Callable[..., Any]) -> None:
        self.__module__ = module
        self.functions = Law._make([*law, solve])

    @cached_property
    def law(self) -> Any:
        """The law in the form in which Python passes it to a loop."""
        return handed(self.functions)

    def __reduce__(self) -> str:
        return "_BODY"
