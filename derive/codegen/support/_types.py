"""What the generated functions return: named tuples of arrays, fields in a fixed order."""

from typing import Any, NamedTuple, TypeAlias

Array: TypeAlias = Any
"""A scalar or an array of any kind that broadcasts; float64 comes out."""


class Contact(NamedTuple):
    """The contact [-a, c] and its tilt."""

    a: Array
    c: Array
    alpha: Array


class Edges(NamedTuple):
    """One value at the left edge x = -a and one at the right edge x = c."""

    left: Array
    right: Array
