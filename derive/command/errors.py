"""Mistakes that a user can make: one small class for each kind, which holds the details.

Every message says what was given, what is wrong, what is allowed and what to do.  The command line
prints only the message and exits with status 2.
"""

import errno
import os
from dataclasses import dataclass, fields
from difflib import get_close_matches


class NotProven(Exception):
    """The proof of a formula, or of its rewritten form, is missing or insufficient."""


class UserError(Exception):
    """A mistake in the user's input; never a fault of the program."""

    def __str__(self) -> str:
        return self.message

    def __reduce__(self) -> tuple[type, tuple[object, ...]]:
        """Pickle the mistake as its details, so that it can be sent to another process."""
        return type(self), tuple(_portable(getattr(self, f.name)) for f in fields(self))  # type: ignore[arg-type]

    @property
    def message(self) -> str:
        """The message in one line: what was given, what is allowed and what to do."""
        raise AssertionError("each kind of mistake must define its own message")


@dataclass(frozen=True)
class _Shown:
    """A detail that cannot be sent to another process, replaced by its text."""

    as_text: str
    as_repr: str

    def __str__(self) -> str:
        return self.as_text

    def __repr__(self) -> str:
        return self.as_repr


def _portable(fact: object) -> object:
    """Return text, numbers and tuples of them unchanged; replace anything else by its text."""
    if type(fact) is tuple:
        return tuple(map(_portable, fact))
    return fact if type(fact) in _PLAIN else _Shown(str(fact), repr(fact))


_PLAIN = (str, int, float, bool, type(None), _Shown)


@dataclass
class BadName(UserError):
    """The name of a geometry or of a parameter cannot be used in the generated code."""

    what: str
    given: str
    why: str

    @property
    def message(self) -> str:
        """Explain why the name is refused and which names are allowed."""
        return (
            f"{self.what} {self.given!r} {self.why}; choose another name. A name consists of "
            "letters, digits and _, does not start with a digit, and is not a symbol of the "
            "theory, such as a, c, E, f, h, m, n, p, q, s, t or x"
        )


@dataclass
class BadUnit(UserError):
    """A unit is not a product of powers of m, Pa, N and rad."""

    given: object
    why: str

    @property
    def message(self) -> str:
        """Explain why the unit is refused, and which units are allowed."""
        return (
            f"unit {self.given!r}: {self.why}; write a product of powers of m, Pa, N and rad, such "
            "as 'm', '1/m' or 'N/m', or '-' for a pure number"
        )


@dataclass
class DimensionMismatch(UserError):
    """The terms of a formula, or its two sides, differ in dimension."""

    where: str
    found: str
    expected: str
    remedy: str = "check the units of the parameters and the powers of x"

    @property
    def message(self) -> str:
        """State which dimensions do not agree."""
        return (
            f"the dimension of {self.where} is {self.found}, but must be {self.expected}: "
            f"{self.remedy}"
        )


@dataclass
class UnknownSymbol(UserError):
    """g(x) contains a symbol that is neither x nor made by `parameter`."""

    geometry: str
    given: str
    remedy: str

    @property
    def message(self) -> str:
        """State which symbol is unknown, and which line is missing."""
        return (
            f"g of {self.geometry!r} contains the symbol {self.given!r}, but only derive's x and "
            f"parameters are allowed: {self.remedy}"
        )


@dataclass
class BadProfile(UserError):
    """g(x) is not the profile of one convex contact for which formulas can be derived."""

    geometry: str
    why: str
    remedy: str

    @property
    def message(self) -> str:
        """Explain why the profile is refused."""
        return f"g of {self.geometry!r} {self.why}: {self.remedy}"


@dataclass
class BadGeometryFile(UserError):
    """A geometry file does not exist or does not define `geometry`."""

    given: str
    why: str

    @property
    def message(self) -> str:
        """State what is wrong with the file, and what it must contain."""
        return (
            f"{self.given}: {self.why}; a geometry file is a Python file that defines "
            "`geometry = Geometry(name, g=...)`, as derive/geometries/hertz.py does"
        )


@dataclass
class UnknownGeometry(UserError):
    """A name is neither a geometry of the library nor a file."""

    given: str
    known: tuple[str, ...]

    @property
    def message(self) -> str:
        """State which names the library contains."""
        return (
            f"there is no geometry {self.given!r}; the library contains {', '.join(self.known)}: "
            "choose one of these, or give the path of a geometry file"
        )


_FREE = "the disk is full: free some space, then run the command again"


def _is_full(why: str) -> bool:
    """Whether the system refused to write because of a full disk, a quota or a limit on size."""
    codes = (errno.ENOSPC, errno.EFBIG, getattr(errno, "EDQUOT", errno.ENOSPC))
    return any(os.strerror(code) in why for code in codes)


@dataclass
class BadOutput(UserError):
    """`derive generate --out` must not replace the given directory."""

    given: str
    why: str

    @property
    def message(self) -> str:
        """Explain why the directory is refused, and which directories are allowed."""
        if _is_full(self.why):
            return f"{self.given} {self.why}; {_FREE}"
        return (
            f"{self.given} {self.why}; a package is only written to a directory that does not "
            "exist, is empty, or was made by `derive generate`: choose another directory with "
            "--out, or clear this one"
        )


@dataclass
class BadPage(UserError):
    """A command must not replace, or cannot write, a page, a table or a directory of pages."""

    given: str
    why: str
    option: str = "--out"

    @property
    def message(self) -> str:
        """Explain why the path is refused, and what may be replaced."""
        if _is_full(self.why):
            return f"{self.given} {self.why}; {_FREE}"
        return (
            f"{self.given} {self.why}; a path is written only if it does not exist or was made by "
            f"`derive`: choose another path with {self.option}"
        )


@dataclass
class NeedsOutput(UserError):
    """A geometry is not in the library, and no directory was given for its module."""

    given: str

    @property
    def message(self) -> str:
        """State which option is missing."""
        return (
            f"{self.given} is not in the library, and the package `generated` contains only bodies "
            "of the library: say where to write its module, as in "
            f"`derive generate {self.given} --out my_package`"
        )


@dataclass
class TwoOfOneName(UserError):
    """Two geometries have the same name and would be written to the same module."""

    name: str

    @property
    def message(self) -> str:
        """State which name occurs twice."""
        return (
            f"two geometries are named {self.name!r}, but each needs a module of its own: rename "
            "one of them"
        )


@dataclass
class NoSuchName(UserError):
    """The name of a body cannot be used in another programming language."""

    body: str
    language: str
    given: str
    why: str

    @property
    def message(self) -> str:
        """State which name cannot be used, and what to do."""
        return (
            f"{self.body} in {self.language}: {self.given!r} {self.why}; give it another name in "
            "a geometry file of your own"
        )


@dataclass
class LostProcess(UserError):
    """One of several processes ended before its work was done."""

    jobs: int

    @property
    def message(self) -> str:
        """State what may have happened, and what to try."""
        return (
            f"one of {self.jobs} processes ended before its body was finished, possibly because "
            f"memory ran out: build fewer bodies at once, as with --jobs {self.jobs // 2}"
        )


@dataclass
class RanAway(UserError):
    """The work on a body exceeded its limit of time or memory, or crashed."""

    what: str
    stage: str
    seconds: float | None = None
    gigabytes: float | None = None
    remedy: str = ""

    @property
    def message(self) -> str:
        """State which stage was reached, which limit was exceeded, if any, and what to try."""
        if self.seconds is not None:
            why = f"took longer than the limit of {self.seconds:g} s"
            remedy = "simplify the profile, or the file that defines it"
        elif self.gigabytes is not None:
            why = f"needed more memory than the limit of {self.gigabytes:g} GB"
            remedy = "simplify the profile, or the file that defines it"
        else:
            why = "crashed, which can happen if numbers are too large"
            remedy = "simplify the profile, for example with fewer terms or nested functions"
        what, stage = self.what or "this body", self.stage or "starting"
        return f"{what}: the stage '{stage}' {why}: {self.remedy or remedy}"


@dataclass
class BadText(UserError):
    """The text of g(x) cannot be read; the message shows where."""

    given: str
    column: int
    why: str
    remedy: str
    allowed: str

    _BEFORE, _AFTER = 48, 24
    """Characters shown before and after the column of the mistake."""

    @property
    def message(self) -> str:
        """State what is wrong, a caret under it, and what is allowed."""
        start, end = max(0, self.column - self._BEFORE), self.column + self._AFTER
        place = _marked(self.given, self.column, start, end)
        return f"{self.why}: {self.remedy}\n{place}\nallowed in g(x): {self.allowed}"


def _marked(text: str, column: int, start: int = 0, end: int | None = None) -> str:
    """A text, or its part from `start` to `end`, and below it a caret under the column."""
    left = "..." if start else ""
    right = "..." if end is not None and end < len(text) else ""
    shown = "".join(_visible(character) for character in text[start:end])
    caret = " " * (len(left) + column - start) + "^"
    return f"    {left}{shown}{right}\n    {caret}"


def _visible(character: str) -> str:
    """Replace a character by one that is exactly one column wide."""
    if character.isspace():
        return " "
    return character if character.isprintable() else "?"


@dataclass
class BadOption(UserError):
    """A `--unit` or `--meaning` option does not refer to a parameter of g(x)."""

    option: str
    given: str
    why: str

    @property
    def message(self) -> str:
        """State what is wrong with the option, and how to write it."""
        text = "m" if self.option == "--unit" else "radius"
        return (
            f"{self.option} {self.given!r}: {self.why}; write {self.option} NAME=TEXT once for "
            f"each parameter, such as {self.option} R={text}"
        )


@dataclass
class BadLimit(UserError):
    """The value of `--limit` is not a valid time."""

    given: str

    @property
    def message(self) -> str:
        """State which values are allowed."""
        return (
            f"--limit {self.given} is not a valid time: give the search for closed forms a finite "
            "number of seconds above zero, such as --limit 20"
        )


@dataclass
class OpenUnits(UserError):
    """The requirement that g(x) be a length does not determine all units."""

    parameters: tuple[str, ...]
    enough: tuple[str, ...]

    @property
    def message(self) -> str:
        """State which units are undetermined, and which of them suffice."""
        options = " ".join(f"--unit {name}=m" for name in self.enough)
        return (
            f"the units of {', '.join(self.parameters)} are not determined: g(x) must be a length "
            f"in m, which leaves more than one choice of units; give units, such as {options}"
        )


@dataclass
class BadPath(UserError):
    """An option or an argument is an empty path, or one with a control character."""

    given_as: str
    path: str

    @property
    def message(self) -> str:
        """State what is wrong with the path."""
        wrong = f"{self.path!a} contains a control character" if self.path else "is an empty path"
        return f"{self.given_as} {wrong}: give the path of a file or directory"


@dataclass
class BadTarget(UserError):
    """`derive new` must not, or cannot, write to the given path."""

    given: str
    why: str

    @property
    def message(self) -> str:
        """Explain why nothing was written, and which paths are allowed."""
        if _is_full(self.why):
            return f"{self.given} {self.why}; {_FREE}"
        return (
            f"{self.given} {self.why}; nothing was written: with --out, give an existing "
            "directory, or the path of a new file that ends in .py"
        )


@dataclass
class InstalledPackage(UserError):
    """The package `generated` belongs to an installation and is not overwritten."""

    given: str

    @property
    def message(self) -> str:
        """Explain why the package is not changed, and which option is missing."""
        return (
            f"{self.given} belongs to an installed package and is not changed: say where to write "
            "the modules, as in `derive generate --out my_package`"
        )


@dataclass
class OtherRuntime(UserError):
    """Python found a package `generated` whose runtime is of another version than this program."""

    given: str

    @property
    def message(self) -> str:
        """Say which folder was found, and what to do."""
        return (
            f"the package `generated` in {self.given} is of another version than `derive`: run the "
            "command in another folder, or rename that package"
        )


@dataclass
class MissingLibrary(UserError):
    """A library that only part of the package needs is not installed."""

    given: str
    purpose: str
    group: str

    @property
    def message(self) -> str:
        """State what needs the library, and how to install it."""
        return (
            f"{self.given} is not installed, and {self.purpose} needs it: run "
            f"pip install 'contact-derive[{self.group}]'"
        )


@dataclass
class UnknownClaim(UserError):
    """No claim of the source has the given name or label."""

    given: str
    known: tuple[str, ...]

    _NEAREST = 8
    """Number of names that a message shows."""

    @property
    def message(self) -> str:
        """State which names are most similar."""
        alike = get_close_matches(self.given, self.known, n=self._NEAREST, cutoff=0.3)
        shown = "; ".join(map(repr, alike or self.known[: self._NEAREST]))
        return (
            f"none of the {len(self.known)} claims is named {self.given!r}; the most similar "
            f"names are {shown}: give one of them, or list all with `derive check`"
        )


@dataclass
class _BadFile(UserError):
    """A file is not of the kind that a command reads."""

    given: str
    why: str
    remedy: str

    @property
    def message(self) -> str:
        """State what is wrong with the file, and where."""
        return f"{self.given}: {self.why}; {_FREE if _is_full(self.why) else self.remedy}"


class BadClaimsFile(_BadFile):
    """A claims file cannot be read, or contains an entry that is not allowed."""


class BadTable(_BadFile):
    """A table cannot be read, or is not the table of a contact."""


@dataclass
class BadFormula(UserError):
    """A formula of a claims file cannot be read, or can be read in two ways."""

    where: str
    given: str
    column: int
    why: str
    remedy: str

    @property
    def message(self) -> str:
        """State what is wrong, and below it the formula with a caret under the mistake."""
        return f"{self.where}: {self.why}: {self.remedy}\n{_marked(self.given, self.column)}"


@dataclass
class NotAccepted(UserError):
    """The claims file does not accept the way in which its LaTeX was read."""

    where: str
    understood: str
    accepted: str

    @property
    def message(self) -> str:
        """State how the LaTeX was read, and how to accept this reading."""
        accepts = f"accepts `{self.accepted}`" if self.accepted else "does not accept a reading"
        return (
            f"{self.where}: the LaTeX was understood as\n    {self.understood}\n"
            f"but the file {accepts}; if this is what is printed, write\n"
            f'    understood = "{self.understood}"'
        )
