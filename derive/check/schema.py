"""Describe a claims file as typed records, and decode its tables into them.

msgspec decodes them, because it is strict and needs no other package: cattrs reads 5 as the text
"5", and pydantic takes three times as long to load and fifteen times as much space.

docs/claims.md describes every entry.  An entry of the wrong type raises BadClaimsFile with its
file, its line, and what the type of the entry allows.
"""

import re
from collections import Counter
from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, field, replace
from enum import StrEnum
from reprlib import repr as shortened
from typing import Annotated, Any, TypeVar

import msgspec

from derive.command.errors import BadClaimsFile

Record = TypeVar("Record", bound=msgspec.Struct)
Noted = Callable[[], AbstractContextManager[None]]

_TOKENS = re.compile(
    r"""#[^\n]*|"{3}(?:\\.|[^\\])*?"{3}|'{3}.*?'{3}|"(?:\\.|[^"\\\n])*"|'[^'\n]*'""", re.DOTALL
)
"""Comments and strings of TOML."""


def lines_in(text: str) -> dict[tuple[str, object], int]:
    """Return the lines of a TOML text on which claims and entries of tables begin.

    The keys are ("claims", number), counted from 1, and (table, name).
    """
    flat = _TOKENS.sub(lambda m: "\n" * m[0].count("\n") or m[0], text)
    found, table, count = dict[tuple[str, object], int](), "", Counter[str]()
    for number, line in enumerate(flat.split("\n"), 1):
        if head := re.match(r"\s*\[+\s*([^\s\]]+)", line):
            table = head[1]
            count[table] += 1
            found[table, count[table]] = number
        elif key := re.match(r"\s*[\"']?(.+?)[\"']?\s*=", line):
            found[table, key[1]] = number
    return found


@dataclass(frozen=True)
class Place:
    """A place in a file, for error messages: its line, if it is known, and what is there."""

    file: str
    lines: Mapping[tuple[str, object], int] = field(default_factory=dict, repr=False)
    line: int | None = None
    what: str = ""

    def __str__(self) -> str:
        return f"{self._at}, {self.what}" if self.what else self._at

    @property
    def _at(self) -> str:
        return f"{self.file}:{self.line}" if self.line else self.file

    def at(self, table: str, name: object, what: str = "") -> "Place":
        """Return the place of an entry of a table, or of a claim by its number."""
        return Place(self.file, self.lines, self.lines.get((table, name)), what)

    def inside(self, what: str) -> "Place":
        """Return the place of a part of what is at this place."""
        return replace(self, what=f"{self.what}: {what}" if self.what else what)

    def bad(self, why: str, remedy: str) -> BadClaimsFile:
        """Return an error at this place."""
        return BadClaimsFile(self._at, f"{self.what}: {why}" if self.what else why, remedy)

    def demand(self, is_right: bool, why: str, remedy: str) -> None:
        """Raise an error at this place if a condition is not met."""
        if not is_right:
            raise self.bad(why, remedy)


def decoded(
    kind: type[Record], given: Mapping[str, Any], place: Place, noted: Noted = nullcontext
) -> Record:
    """Return a table as a record; raises BadClaimsFile.

    noted: returns a context in which an error may be recorded; its entry then keeps its default.
    """
    while True:
        try:
            return msgspec.convert(given, kind)
        except msgspec.ValidationError as error:
            key, why, remedy = _wrong(str(error), kind, given)
        if not key or key not in given:  # the table itself is wrong
            raise place.bad(why, remedy)
        with noted():
            raise place.bad(why, remedy)
        given = {name: entry for name, entry in given.items() if name != key}


def _wrong(message: str, kind: type[msgspec.Struct], given: Any) -> tuple[str, str, str]:
    """Return the key that is wrong, why, and the remedy, from a message of msgspec."""
    what, _, path = message.partition(" - at `$")
    path = path.strip("`.")
    key = re.split(r"[.\[]", path)[0]
    if named := re.search(r"field `(.+)`", what):
        if "missing" in what:
            return key, f"there is no {named[1]}", f"write {named[1]} = ..."
        known = f"use one of {', '.join(sorted(kind.__struct_encode_fields__))}"
        remedy = f"leave it out of {path}" if path else known
        return key or named[1], f"the key {named[1]!r} is unknown", remedy
    if expected := re.match(r"Expected `(.+?)`(.*?)(, got .*)?$", what):
        words = [_MEANT[each] for each in expected[1].split(" | ") if each in _MEANT]
        limit = expected[2].replace(r" matching regex '\\S'", " that is not blank")
        remedy = " or ".join(dict.fromkeys(words)) + limit
    elif "enum" in what:
        remedy = f"one of {', '.join(Verdict)}"
    else:  # what a record demands itself
        return key, *what.split(": ", 1)  # type: ignore[return-value]
    wrong = f"{key} = {shortened(given[key])}" if key else shortened(given)
    return key, f"{wrong} is not allowed", f"{path or 'it'} must be {remedy}"


_MEANT = {
    **{"str": "a text", "int": "a number", "float": "a number", "bool": "true or false"},
    **{"array": "a list", "object": "a table"},
}
"""The types of msgspec, in the words of a user."""


class Verdict(StrEnum):
    """The verdict on a claim."""

    HOLDS = "holds"
    NUMERICAL = "numerical"
    DEFINITION = "by definition"
    CONVENTION = "convention"
    FAILS = "fails"
    UNCHECKED = "unchecked"


Text = Annotated[str, msgspec.Meta(pattern=r"\S")]
Seconds = Annotated[float, msgspec.Meta(gt=0, le=86_400)]
Number = Annotated[float, msgspec.Meta(gt=-1e6, lt=1e6)]
"""A bound of a range, or a value of a variable."""


Formula = str | int | float
"""The formula of a symbol; empty if it is not known yet."""


class Quantity(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What the entries of [symbols] and [variables] have in common."""

    meaning: str = ""
    unit: str | None = None


class DefinedSymbol(Quantity, frozen=True, forbid_unknown_fields=True):
    """An entry of [symbols]."""

    formula: Formula = msgspec.field(default="", name="is")
    proposal: str = ""

    @property
    def text(self) -> str:
        """The formula as text."""
        return str(self.formula).strip()


class Variable(Quantity, frozen=True, forbid_unknown_fields=True):
    """An entry of [variables]; positive, and of any size, if it has no bounds."""

    low: Number | None = None
    high: Number | None = None

    def __post_init__(self) -> None:
        """Refuse a single bound, and bounds that leave no room."""
        both = self.low is not None and self.high is not None
        if not (self.low < self.high if both else self.low is self.high):  # type: ignore[operator]
            why = "there is no valid range"
            raise ValueError(f"{why}: write {{ low = 0.1, high = 0.9 }}, or only its meaning")


MODULI = ("E_star", "E and nu", "E and nu, rigid", "mu and kappa", "mu and kappa, rigid")
"""The elastic constants in which a paper may be written; "rigid" if one body is rigid."""


class Answers(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The table [paper]: what the letters of a paper mean; its letters by ours."""

    symmetric: bool
    modulus: str = "E_star"
    letters: dict[str, Text] = {}

    def __post_init__(self) -> None:
        """Refuse an unknown modulus."""
        if self.modulus not in MODULI:
            known = ", ".join(map(repr, MODULI))
            raise ValueError(f"modulus = {self.modulus!r} is not known: write one of {known}")


class OwnBody(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A body that the file defines itself."""

    g: Text
    units: dict[str, str] = {}


class Reinterpretation(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """An entry of `conventions`."""

    what: Text
    symbols: dict[str, Formula] = {}


class Labelled(msgspec.Struct, frozen=True):
    """The entry that every table [[claims]] must have."""

    label: Text


class Entry(Labelled, frozen=True, forbid_unknown_fields=True):
    """A table [[claims]], as docs/claims.md describes it.

    What is printed comes first, then what it means and where it is to be true, and last what a
    person has found about it.
    """

    place: str = ""
    says: str = ""
    equation: str = ""
    printed: Text = ""
    latex: Text = ""
    understood: str = ""
    part: int | None = None
    accepted: bool = True

    unchecked: Text = ""
    body: Any = None
    symbols: dict[str, Formula] = {}
    given: list[str] | None = None
    require: Text | list[Text] = []
    approach: Text = msgspec.field(default="", name="as")
    order: float | None = None
    leading: bool = False
    through: Text = ""
    allowed: dict[str, Formula] | None = None
    beyond: dict[str, Formula] | None = None
    conventions: list[Reinterpretation] = []
    ranges: dict[str, tuple[Number, Number]] = {}
    cases: list[dict[str, Number]] = []
    swaps: list[str] | None = None
    family: str = ""

    expected: Verdict | None = None
    against: str = ""
    steps: list[str] = []
    consequence: str = ""

    @property
    def requirements(self) -> list[str]:
        """The conditions of `require`."""
        return [self.require] if isinstance(self.require, str) else self.require

    @property
    def beside(self) -> dict[str, str]:
        """The entries of the claim that its verdict depends on, as text."""
        order = "" if self.order is None else f"{self.order:g}"
        told = {
            "as": self.approach,
            "order": order,
            "require": " and ".join(self.requirements),
            "given": " and ".join(self.given or ()),
        }
        return {key: text for key, text in told.items() if text}


class ClaimsFile(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A claims file; the entries of its tables are decoded one by one."""

    title: str = ""
    seconds: Seconds = 30
    body: Any = None
    paper: dict[str, Any] | None = None
    variables: dict[str, Any] = {}
    symbols: dict[str, Any] = {}
    latex: dict[str, str] = {}
    claims: list[Any] = []
    signs: dict[str, list[str]] = {}
