"""What a user can get wrong: one small class a mistake, each with its facts.

Every message says what was given, what is allowed and what to do.  The command line prints the
message alone and leaves with status 2.
"""

from dataclasses import dataclass, fields
from difflib import get_close_matches


class NotProven(Exception):
    """A formula, or a rewritten form of one, whose proof is missing or falls short."""


class UserError(Exception):
    """A mistake in what the user gave; never a fault of the program."""

    def __str__(self) -> str:
        return self.message

    def __reduce__(self) -> tuple[type, tuple[object, ...]]:
        """Its facts, so that another process can be told of the mistake."""
        return type(self), tuple(_portable(getattr(self, f.name)) for f in fields(self))  # type: ignore[arg-type]

    @property
    def message(self) -> str:
        """One line: what was given, what is allowed, what to do."""
        raise AssertionError("each mistake writes its own message")


@dataclass(frozen=True)
class _Shown:
    """What another process could not rebuild, by how it is shown."""

    as_text: str
    as_repr: str

    def __str__(self) -> str:
        return self.as_text

    def __repr__(self) -> str:
        return self.as_repr


def _portable(fact: object) -> object:
    """Texts and numbers as they are, in tuples, too; of all else what a message shows of it."""
    if type(fact) is tuple:
        return tuple(map(_portable, fact))
    return fact if type(fact) in _PLAIN else _Shown(str(fact), repr(fact))


_PLAIN = (str, int, float, bool, type(None), _Shown)


@dataclass
class BadName(UserError):
    """A geometry or a parameter has a name that the generated code cannot carry."""

    what: str
    given: str
    why: str

    @property
    def message(self) -> str:
        """What was wrong with the name."""
        return (
            f"{self.what} {self.given!r} {self.why}; a name is letters, digits and "
            "_, does not start with a digit, and is none of the theory's own, such as a, c, E, "
            "f, h, m, n, p, q, s, t, x: choose another"
        )


@dataclass
class BadUnit(UserError):
    """A unit that is no product of powers of m, Pa, N and rad."""

    given: object
    why: str

    @property
    def message(self) -> str:
        """What was wrong with the unit."""
        return (
            f"unit {self.given!r}: {self.why}; write a product of powers of m, Pa, N, rad or '-', "
            "such as 'm', '1/m' or 'N/m'"
        )


@dataclass
class DimensionMismatch(UserError):
    """A formula whose terms, or whose two sides, differ in dimension."""

    where: str
    found: str
    expected: str
    remedy: str = "check the units of the parameters and the powers of x"

    @property
    def message(self) -> str:
        """Which dimensions do not agree."""
        return (
            f"{self.where} has the dimension {self.found} where {self.expected} is needed: "
            f"{self.remedy}"
        )


@dataclass
class UnknownSymbol(UserError):
    """g(x) holds a symbol that is neither x nor made by `parameter`."""

    geometry: str
    given: str
    remedy: str

    @property
    def message(self) -> str:
        """Which symbol is unknown, and the line that is missing."""
        return (
            f"g of {self.geometry!r} holds the symbol {self.given!r}; only derive's x and "
            f"parameters are allowed: {self.remedy}"
        )


@dataclass
class BadProfile(UserError):
    """g(x) is not the profile of one convex contact that can be derived."""

    geometry: str
    why: str
    remedy: str

    @property
    def message(self) -> str:
        """Why the profile is refused."""
        return f"g of {self.geometry!r} {self.why}: {self.remedy}"


@dataclass
class BadGeometryFile(UserError):
    """A file that does not define `geometry`, or is not there."""

    given: str
    why: str

    @property
    def message(self) -> str:
        """What is wrong with the file."""
        return (
            f"{self.given}: {self.why}; a geometry file is Python and ends in "
            "`geometry = Geometry(name, g=...)`, as in derive/geometries/hertz.py"
        )


@dataclass
class UnknownGeometry(UserError):
    """A name that is neither a geometry of the library nor a file."""

    given: str
    known: tuple[str, ...]

    @property
    def message(self) -> str:
        """Which names there are."""
        return (
            f"there is no geometry {self.given!r}; the library has {', '.join(self.known)}: "
            "name one of them, or give the path of a geometry file"
        )


@dataclass
class BadOutput(UserError):
    """A directory that `derive generate --out` must not replace."""

    given: str
    why: str

    @property
    def message(self) -> str:
        """Why the directory is refused."""
        return (
            f"{self.given} {self.why}; a package is written to a directory that does not exist, is "
            "empty, or was made by `derive generate`: choose another by --out, or clear this one"
        )


@dataclass
class BadPage(UserError):
    """A file or directory that `derive show --html` must not replace, or cannot write."""

    given: str
    why: str

    @property
    def message(self) -> str:
        """Why it is refused, and what may be replaced."""
        return (
            f"{self.given} {self.why}; pages are written where nothing is, or where pages made by "
            "`derive show --html` are: choose another place by --out"
        )


@dataclass
class NeedsOutput(UserError):
    """A geometry outside the library, and no directory for its module."""

    given: str

    @property
    def message(self) -> str:
        """What to add."""
        return (
            f"{self.given} is not in the library, and the package `generated` holds nothing else: "
            f"say where its module goes, as in `derive generate {self.given} --out my_package`"
        )


@dataclass
class TwoOfOneName(UserError):
    """Two geometries that would become one module."""

    name: str

    @property
    def message(self) -> str:
        """Which name occurs twice."""
        return f"two geometries are named {self.name!r}, one module each is needed: rename one"


@dataclass
class NoSuchName(UserError):
    """A name of a body that another language cannot carry."""

    body: str
    language: str
    given: str
    why: str

    @property
    def message(self) -> str:
        """Which name, and what to do."""
        return (
            f"{self.body} in {self.language}: {self.given!r} {self.why}; give it another name in "
            "a geometry file of your own"
        )


@dataclass
class LostProcess(UserError):
    """One of several processes that ended before its work was done."""

    jobs: int

    @property
    def message(self) -> str:
        """What may have happened, and what to try."""
        return (
            f"one of {self.jobs} processes ended before its body was done, as when memory runs "
            f"out: build fewer at once, as by --jobs {self.jobs // 2}"
        )


@dataclass
class RanAway(UserError):
    """Work on a body that went beyond its time or its memory, or brought its process down."""

    what: str
    stage: str
    seconds: float
    gigabytes: float

    @property
    def message(self) -> str:
        """Where it was, what it had, and what to try."""
        return (
            f"{self.what or 'this body'}: {self.stage or 'starting'} went beyond its limits of "
            f"{self.seconds:g} s and {self.gigabytes:g} GB of memory: write g(x) with fewer kinks, "
            "parameters or functions of functions"
        )


@dataclass
class BadText(UserError):
    """A text of g(x) that cannot be read; the message shows where."""

    given: str
    column: int
    why: str
    remedy: str
    allowed: str

    _BEFORE, _AFTER = 48, 24
    """Characters shown on each side of the place."""

    @property
    def message(self) -> str:
        """What is wrong, a caret under it, and what is allowed."""
        start, end = max(0, self.column - self._BEFORE), self.column + self._AFTER
        place = _marked(self.given, self.column, start, end)
        return f"{self.why}: {self.remedy}\n{place}\nallowed in g(x): {self.allowed}"


def _marked(text: str, column: int, start: int = 0, end: int | None = None) -> str:
    """A text, or the part of it from `start` to `end`, and a caret under the column."""
    left = "..." if start else ""
    right = "..." if end is not None and end < len(text) else ""
    shown = "".join(_visible(character) for character in text[start:end])
    caret = " " * (len(left) + column - start) + "^"
    return f"    {left}{shown}{right}\n    {caret}"


def _visible(character: str) -> str:
    """One column for one character."""
    if character.isspace():
        return " "
    return character if character.isprintable() else "?"


@dataclass
class BadOption(UserError):
    """A `--unit` or a `--meaning` that says nothing of any parameter of g(x)."""

    option: str
    given: str
    why: str

    @property
    def message(self) -> str:
        """What is wrong with the option."""
        return (
            f"{self.option} {self.given!r}: {self.why}; write {self.option} NAME=TEXT once for a "
            f"parameter, such as {self.option} R={'m' if self.option == '--unit' else 'radius'}"
        )


@dataclass
class BadLimit(UserError):
    """A `--limit` that is no time which can pass."""

    given: str

    @property
    def message(self) -> str:
        """What may stand there."""
        return (
            f"--limit {self.given}: the search for closed forms takes a number of seconds above "
            "zero, and not without end; write one, such as --limit 20"
        )


@dataclass
class OpenUnits(UserError):
    """Units that g(x) being a length does not fix."""

    parameters: tuple[str, ...]
    enough: tuple[str, ...]

    @property
    def message(self) -> str:
        """Which units are open, and which of them would be enough."""
        options = " ".join(f"--unit {name}=m" for name in self.enough)
        return (
            f"the units of {', '.join(self.parameters)} are open: g(x) must be a length in m, and "
            f"more than one choice makes it one; say which, such as {options}"
        )


@dataclass
class BadTarget(UserError):
    """A place where `derive new` must not, or cannot, write."""

    given: str
    why: str

    @property
    def message(self) -> str:
        """Why nothing was written."""
        return (
            f"{self.given} {self.why}; nothing was written: choose a new file by "
            "--out, a directory that exists or a path that ends in .py"
        )


@dataclass
class InstalledPackage(UserError):
    """The package `generated` of an installation, which is not written to."""

    given: str

    @property
    def message(self) -> str:
        """Why it is left alone, and what to add."""
        return (
            f"{self.given} belongs to an installed package and is left as it is: say where the "
            "modules go, as in `derive generate --out my_package`"
        )


@dataclass
class MissingLibrary(UserError):
    """A library that only some of the package needs, and that is not installed."""

    given: str
    purpose: str
    group: str

    @property
    def message(self) -> str:
        """What needs it, and how to install it."""
        return (
            f"{self.given} is not installed, and {self.purpose} needs it: "
            f"pip install 'contact-derive[{self.group}]'"
        )


@dataclass
class UnknownClaim(UserError):
    """A label that no claim of the source bears."""

    given: str
    known: tuple[str, ...]

    _NEAREST = 8
    """Labels that a message shows."""

    @property
    def message(self) -> str:
        """Which labels come nearest."""
        alike = get_close_matches(self.given, self.known, n=self._NEAREST, cutoff=0.3)
        shown = ", ".join(alike or self.known[: self._NEAREST])
        return (
            f"there is no claim {self.given!r} among {len(self.known)}; the nearest are {shown}: "
            "name one of them, `derive check` lists all"
        )


@dataclass
class _BadFile(UserError):
    """A file that is not what a command reads."""

    given: str
    why: str
    remedy: str

    @property
    def message(self) -> str:
        """What is wrong with the file, and where."""
        return f"{self.given}: {self.why}; {self.remedy}"


class BadClaimsFile(_BadFile):
    """A claims file that cannot be read, or says something of a claim that it cannot."""


class BadTable(_BadFile):
    """A table that cannot be read, or is none of a contact."""


@dataclass
class BadFormula(UserError):
    """A formula of a claims file that cannot be read, or can be read in two ways."""

    where: str
    given: str
    column: int
    why: str
    remedy: str

    @property
    def message(self) -> str:
        """What is wrong, and a caret under it."""
        return f"{self.where}: {self.why}: {self.remedy}\n{_marked(self.given, self.column)}"


@dataclass
class NotAccepted(UserError):
    """LaTeX whose reading the claims file does not accept."""

    where: str
    understood: str
    accepted: str

    @property
    def message(self) -> str:
        """What was understood, and how to accept it."""
        said = f"the file accepts `{self.accepted}`" if self.accepted else "the file accepts none"
        return (
            f"{self.where}: the LaTeX was understood as\n    {self.understood}\n"
            f"and {said}; if that is what is printed, write\n"
            f'    understood = "{self.understood}"'
        )
