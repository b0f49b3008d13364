"""The relation between the two sides of an equation."""

from enum import StrEnum


class Relation(StrEnum):
    """The relation between the two sides.

    LIKE is judged like an equation, by the leading terms.
    """

    EQUAL = "="
    LIKE = "~"
    BELOW = "<"
    AT_MOST = "<="
    ABOVE = ">"
    AT_LEAST = ">="

    @property
    def is_strict(self) -> bool:
        """Whether the relation is a strict inequality."""
        return self in (Relation.BELOW, Relation.ABOVE)

    @property
    def is_ordered(self) -> bool:
        """Whether the relation is an inequality."""
        return self[0] in "<>"

    @property
    def turned(self) -> "Relation":
        """The opposite inequality, with the same strictness."""
        return Relation(self.translate(str.maketrans("<>", "><")))
