"""Describe a claims file as typed records, and decode its tables into them.

msgspec decodes them, because it is strict and needs no other package: cattrs reads 5 as the text
"5", and pydantic takes three times as long to load and fifteen times as much space.

docs/claims.md describes every entry.  An entry of the wrong type raises BadClaimsFile with its
file, its line and a remedy, which the type of the entry states.
"""

import re
from collections import Counter
from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, field, replace
from enum import StrEnum
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


def records(
    data: Mapping[str, Any], place: Place, *kinds: type[msgspec.Struct], noted: Noted = nullcontext
) -> list[Any]:
    """Return a table as one record of each kind, which share its keys.

    noted: returns a context in which an error may be recorded; its entry then keeps its default.
    """
    fields = [(kind, each) for kind in kinds for each in msgspec.structs.fields(kind)]
    known = {each.encode_name for _, each in fields}
    values: dict[type, dict[str, Any]] = {kind: {} for kind in kinds}
    with noted():
        if wrong := ", ".join(repr(key) for key in data if key not in known):
            raise place.bad(f"the key {wrong} is unknown", f"use one of {', '.join(sorted(known))}")
    for kind, each in fields:
        key = each.encode_name
        if key in data or each.required:
            with noted():
                values[kind][each.name] = value(key, data.get(key, ""), each.type, place)
    return [kind(**values[kind]) for kind in kinds]


def record(
    kind: type[Record], data: Mapping[str, Any], place: Place, noted: Noted = nullcontext
) -> Record:
    """Return a table as a record."""
    (made,) = records(data, place, kind, noted=noted)
    return made


def value(key: str, given: object, kind: Any, place: Place) -> Any:
    """Return an entry as a value of a type; raise BadClaimsFile with what is wrong with it."""
    why, remedy = _WRONG.get(kind, ("", ""))
    try:
        if key in _FILLED and isinstance(given, str) and not given.strip():
            raise place.bad(f"there is no {key}", remedy.format(key=key))
        return msgspec.convert(given, kind)
    except msgspec.ValidationError:
        raise place.bad(why.format(key=key, given=given), remedy.format(key=key)) from None


class Verdict(StrEnum):
    """The verdict on a claim."""

    HOLDS = "holds"
    NUMERICAL = "numerical"
    DEFINITION = "by definition"
    CONVENTION = "convention"
    FAILS = "fails"
    UNCHECKED = "unchecked"


Seconds = Annotated[float, msgspec.Meta(gt=0, le=86_400)]
Number = Annotated[float, msgspec.Meta(gt=-1e6, lt=1e6)]
"""A bound of a range, or a value of a variable."""
Texts = list[str]
Lists = dict[str, list[str]]
Table = dict[str, Any]
Tables = list[dict[str, Any]]
Ranges = dict[str, tuple[Number, Number]]
Points = list[dict[str, Number]]

NO_RANGE = "there is no valid range"
A_RANGE = "write {{ low = 0.1, high = 0.9 }}, or only its meaning as text"
_NO_TEXTS = "{key} is not a list of strings", 'write {key} = ["..."]'
_NO_TABLE = "{key} is not a table", "write [{key}] with names below it, or {key} = {{ ... }}"
_NO_ORDER = "`order` = {given!r} is not a number, or `as` is missing"
_NO_PART = "{key} = {given!r} is not the number of a statement in this display"
_NOT_ALLOWED = "{key} = {given!r} is not allowed"

_WRONG: dict[Any, tuple[str, str]] = {
    str: ("{key} = {given!r} is not a string", 'write {key} = "..."'),
    Texts: _NO_TEXTS,
    Texts | None: _NO_TEXTS,
    str | Texts: _NO_TEXTS,
    Table: _NO_TABLE,
    Table | None: _NO_TABLE,
    Tables: ("{key} is not a list of tables", "write {key} = [{{ what = ... }}]"),
    Points: ("{key} is not a list of tables with numbers", "write {key} = [{{ l = 1 }}]"),
    Ranges: ("{key} does not give two ends to a variable", "write two numbers, such as [0.1, 0.9]"),
    Lists: ("{key} does not list labels for each quantity", 'write lines such as M = ["(2)"]'),
    Seconds: (
        "{key} = {given!r} is not a valid time limit",
        "write a number above 0 and at most 86400",
    ),
    Number | None: (NO_RANGE, A_RANGE),
    Verdict | None: ("{key} = {given!r} is not a verdict", f"write one of {', '.join(Verdict)}"),
    bool: (_NOT_ALLOWED, "write {key} = true or {key} = false"),
    bool | None: (_NOT_ALLOWED, "write {key} = true"),
    float | None: (_NO_ORDER, "give `order` as a number, together with `as`"),
    int | None: (_NO_PART, "write a number from 1"),
    list[Any]: ("the file has no [[claims]]", "add at least one"),
}
"""For each type, what is wrong with another value, and the remedy."""
_FILLED = frozenset(
    {"label", "printed", "latex", "unchecked", "as", "require", "through", "g", "what"}
) | {"contradicts"}
"""Texts that must not be blank."""


class ClaimsFile(msgspec.Struct, frozen=True):
    """A claims file; the entries of its tables are decoded one by one."""

    title: str = ""
    seconds: Seconds = 30
    body: Any = None
    variables: Table = {}
    symbols: Table = {}
    latex: Table = {}
    claims: list[Any] = []
    signs: Lists = {}


class Variable(msgspec.Struct, frozen=True):
    """An entry of [variables] that is a table."""

    meaning: str = ""
    low: Number | None = None
    high: Number | None = None
    unit: Any = None


class DefinedSymbol(msgspec.Struct, frozen=True):
    """An entry of [symbols] that is a table."""

    formula: Any = msgspec.field(default="", name="is")
    meaning: str = ""
    proposal: str = ""
    unit: Any = None


class OwnBody(msgspec.Struct, frozen=True):
    """A body that the file defines itself."""

    g: str
    units: Table = {}


class Reinterpretation(msgspec.Struct, frozen=True):
    """An entry of `conventions`."""

    what: str
    contradicts: str
    symbols: Table = {}


class AsPrinted(msgspec.Struct, frozen=True):
    """A claim as printed in the source.

    equation  the number of the displayed equation to which it belongs
    text      the equation as text, which keeps its form; if it is given in LaTeX, its reading
    """

    label: str
    place: str = ""
    says: str = ""
    equation: str = ""
    text: str = msgspec.field(default="", name="printed")
    latex: str = ""
    understood: str = ""
    part: int | None = None
    accepted: bool = True


class Terms(msgspec.Struct, frozen=True):
    """The entries of a claim that say what its equation means, and where it is to be true."""

    unchecked: str = ""
    body: Any = None
    symbols: Table = {}
    given: Texts | None = None
    require: str | Texts = []
    approach: str = msgspec.field(default="", name="as")
    order: float | None = None
    leading: bool | None = None
    through: str = ""
    allowed: Table | None = None
    beyond: Table | None = None
    conventions: Tables = []
    ranges: Ranges = {}
    cases: Points = []
    swaps: Texts | None = None
    family: str = ""


class AsExpected(msgspec.Struct, frozen=True):
    """What a person has found about a claim, and how it is compared.

    verdict      the verdict that was found when a person last examined the claim
    against      what the claim is compared with, in words
    consequence  the effect of the error on a user's results
    """

    verdict: Verdict | None = msgspec.field(default=None, name="expected")
    against: str = ""
    steps: Texts = []
    consequence: str = ""
