"""Mistakes that a user can make.

The docstring of each kind of mistake is its message, with the facts of the mistake in braces.  A
message says what was given, what is wrong, what is allowed and what to do.  The command line prints
only the message and exits with status 2.
"""

from inspect import Parameter, Signature
from string import Formatter
from typing import TYPE_CHECKING, Any, ClassVar


class NotProven(Exception):
    """The proof of a formula, or of its rewritten form, is missing or insufficient."""


class UserError(Exception):
    """A mistake in the user's input; never a fault of the program.

    A mistake is made from its facts, in the order in which its message names them, or by their
    names.  They are its attributes.  An attribute of the class is the default of a fact.
    """

    sentence: ClassVar[str] = ""
    facts: ClassVar[tuple[str, ...]] = ()

    def __init_subclass__(cls) -> None:
        """Read the facts from the docstring; a docstring without any inherits those of its base."""
        text = " ".join((cls.__doc__ or "").split())
        if names := [name for _, name, *_ in Formatter().parse(text) if name]:
            cls.sentence, cls.facts = text, tuple(dict.fromkeys(names))

    def __init__(self, *given: object, **named: object) -> None:
        kind, none = Parameter.POSITIONAL_OR_KEYWORD, Parameter.empty
        takes = [Parameter(n, kind, default=getattr(type(self), n, none)) for n in self.facts]
        bound = Signature(takes).bind(*given, **named)
        bound.apply_defaults()
        super().__init__(*bound.args)  # they make the mistake anew in another process
        vars(self).update(bound.arguments)

    if TYPE_CHECKING:

        def __getattr__(self, fact: str) -> Any: ...
        def __setattr__(self, fact: str, value: Any) -> None: ...

    def __str__(self) -> str:
        return self.message

    @property
    def message(self) -> str:
        """The sentence with the facts of this mistake."""
        facts = {n: ", ".join(f) if isinstance(f, tuple) else f for n, f in vars(self).items()}
        return self.sentence.format_map(facts)


class BadName(UserError):
    """{what} {given!r} {why}; choose another name. A name consists of letters, digits and _, does
    not start with a digit, and is not a symbol of the theory, such as a, c, E, f, h, m, n, p, q, s,
    t or x"""


class BadUnit(UserError):
    """unit {given}: {why}; write a product of powers of m, Pa, N and rad, such as 'm', '1/m' or
    'N/m', or '-' for a pure number"""


class DimensionMismatch(UserError):
    """the dimension of {where} is {found}, but must be {expected}: {remedy}"""

    remedy = "check the units of the parameters and the powers of x"


class OpenUnits(UserError):
    """the units of {parameters} are not determined: g(x) must be a length in m, which leaves more
    than one choice of units; give units, such as {options}"""


class UnknownSymbol(UserError):
    """g of {geometry!r} contains the symbol {given!r}, but only derive's x and parameters are
    allowed: {remedy}"""


class BadProfile(UserError):
    """g of {geometry!r} {why}: {remedy}"""


class BadGeometryFile(UserError):
    """{given}: {why}; a geometry file is a Python file that defines `geometry = Geometry(name,
    g=...)`, as derive/geometries/hertz.py does"""


class UnknownGeometry(UserError):
    """there is no geometry {given!r}; the library contains {known}: choose one of these, or give
    the path of a geometry file"""


class NoSuchName(UserError):
    """{body} in {language}: {given!r} {why}; give it another name in a geometry file of your own"""


class BadFormula(UserError):
    """A formula of a claims file cannot be read, or can be read in two ways."""

    facts = ("where", "given", "column", "why", "remedy")

    @property
    def message(self) -> str:
        """What is wrong, and below it the formula with a caret under the mistake."""
        return f"{self.where}: {self.why}: {self.remedy}\n{_marked(self.given, self.column)}"


class BadText(UserError):
    """The text of g(x) cannot be read."""

    facts = ("given", "column", "why", "remedy", "allowed")

    @property
    def message(self) -> str:
        """What is wrong, a caret under it in part of the text, and what is allowed."""
        part = _marked(self.given, self.column, max(0, self.column - 48), self.column + 24)
        return f"{self.why}: {self.remedy}\n{part}\nallowed in g(x): {self.allowed}"


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


class BadClaimsFile(UserError):
    """{given}: {why}; {remedy}"""


class BadTable(UserError):
    """{given}: {why}; {remedy}"""


class BadOption(UserError):
    """{option} {given!r}: {why}; write {option} NAME=TEXT once for each parameter, such as {option}
    R={example}"""


class BadTarget(UserError):
    """{given} {why}; nothing was written: a path is written only if it does not exist or holds a
    page, table or package made by `derive`; choose another path with {option}"""

    option = "--out"


class NeedsOutput(UserError):
    """{given} {why}: say where to write the modules, as in `derive generate{sources} --out
    my_package`"""


class TwoOfOneName(UserError):
    """two geometries are named {name!r}, but each needs a module of its own: rename one of them"""


class RanAway(UserError):
    """{what}: the stage '{stage}' {why}: {remedy}"""


class OtherRuntime(UserError):
    """the package `generated` in {given} is of another version than `derive`: run the command in
    another folder, or rename that package"""


class MissingLibrary(UserError):
    """{given} is not installed, and {purpose} needs it: run pip install
    'contact-derive[{group}]'"""
