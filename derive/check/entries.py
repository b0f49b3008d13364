"""Read typed entries of a table in a TOML file.

In:   a table as data, and its place in the file.
Out: strings, lists and tables.  An entry of another type raises BadClaimsFile with its place.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any, TypeVar

from derive.command.errors import BadClaimsFile, NotProven, UserError
from derive.command.limit import LimitReached, within

Read = TypeVar("Read")


@dataclass(frozen=True)
class Place:
    """A place in a file, for error messages: its line, if it is known, and what is there."""

    file: str
    line: int | None = None
    what: str = ""

    def __str__(self) -> str:
        return f"{self._at}, {self.what}" if self.what else self._at

    @property
    def _at(self) -> str:
        return f"{self.file}:{self.line}" if self.line else self.file

    def inside(self, what: str) -> "Place":
        """Return the place of a part of what is at this place."""
        return replace(self, what=f"{self.what}: {what}" if self.what else what)

    def bad(self, why: str, remedy: str) -> BadClaimsFile:
        """Return an error at this place."""
        return BadClaimsFile(self._at, f"{self.what}: {why}" if self.what else why, remedy)


@dataclass(frozen=True)
class Entries:
    """The entries of one table."""

    place: Place
    data: Mapping[str, Any]

    def table(self, key: str) -> dict[str, Any]:
        """Return an inner table, which is empty if there is none."""
        found = self.data.get(key, {})
        if not isinstance(found, dict):
            remedy = f"write [{key}] with names below it, or {key} = {{ ... }}"
            raise self.place.bad(f"{key} is not a table", remedy)
        return found

    def text(self, key: str) -> str:
        """Return a string; the entry must be present."""
        self.demand_texts(key)
        found = str(self.data.get(key, ""))
        if not found.strip():
            raise self.place.bad(f"there is no {key}", f'write {key} = "..."')
        return found

    def texts(self, key: str) -> tuple[str, ...]:
        """Return a list of strings, or an empty list if the entry is missing."""
        found = self.data.get(key, [])
        if not isinstance(found, list) or not all(isinstance(each, str) for each in found):
            raise self.place.bad(f"{key} is not a list of strings", f'write {key} = ["..."]')
        return tuple(found)

    def tables(self, key: str, example: str) -> list[dict[str, Any]]:
        """Return a list of tables, which is empty if there is none."""
        found = self.data.get(key, [])
        if not isinstance(found, list) or not all(isinstance(each, dict) for each in found):
            raise self.place.bad(f"{key} is not a list of tables", f"write {key} = {example}")
        return found

    def demand_texts(self, *keys: str) -> None:
        """Reject entries that are not strings; they may be missing."""
        for key in keys:
            if not isinstance(self.data.get(key, ""), str):
                why = f"{key} = {self.data[key]!r} is not a string"
                raise self.place.bad(why, f'write {key} = "..."')

    def demand_known(self, known: frozenset[str]) -> None:
        """Reject unknown keys."""
        wrong = ", ".join(repr(key) for key in self.data if key not in known)
        if wrong:
            remedy = f"use one of {', '.join(sorted(known))}"
            raise self.place.bad(f"the key {wrong} is unknown", remedy)


@dataclass(frozen=True)
class TimeLimit:
    """The time limit for reading one formula, in seconds."""

    seconds: float

    def read(self, place: Place, read: Callable[[], Read]) -> Read:
        """Return the result of `read`; raise BadClaimsFile if it fails or takes too long."""
        try:
            with within(self.seconds):
                return read()
        except LimitReached:
            why = f"it could not be read within {self.seconds:g} s"
            raise place.bad(why, "simplify it, or increase `seconds`") from None
        except RecursionError:
            raise place.bad("it is nested too deeply", "simplify it") from None
        except NotProven as error:
            why = f"it uses a formula that is not proven: {error}"
            raise place.bad(why, "use another formula, or a simpler body") from error
        except UserError:
            raise
        except Exception as error:  # an error in SymPy must not stop the other claims
            why = f"it could not be read ({type(error).__name__}: {error})"
            raise place.bad(why, "write it in another form") from error
