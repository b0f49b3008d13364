"""Read a claims file in TOML, which is data only: no part of it is ever executed.

    title = "..."
    seconds = 30                      # time limit of a verdict, and then of a correction
    body = "hertz"                    # its formulas may be called, such as load(a, c);
    # body = { g = "x**2/(2*R)", units = { R = "m" } }    or another body, or a geometry file

    [variables]                       # drawn at random; all else is expressed by them
    l = "half-width"                  # positive
    mu = { meaning = "x/l", low = -0.9, high = 0.9, unit = "-" }

    [symbols]                         # meanings of the source's symbols, also by each other
    P = "load(l, l)"
    p_0 = { is = "2*P/(pi*l)", meaning = "largest pressure", unit = "Pa" }

    [latex]                           # LaTeX of symbols, if it differs from the names
    "E^*" = "E_star"

    [[claims]]
    label = "half-width"
    place = "eq. (3)"
    printed = "a**2 = 4*P*R/(pi*E_star)"       # or latex = '...' and understood = "..."
    part = 1                                   # the number of the statement in a LaTeX display
    accepted = true                            # false in a draft: not accepted yet
    expected = "fails"                         # the verdict, if it is known
    symbols = { M = "-moment(l, l)" }          # for this claim only, like `body`
    require = "b < w and x > 0"                # the conditions under which it is stated
    as = "c - x -> 0"                          # the ratio left/right tends to 1; or, with
    order = 1.5                                #   `order`, left - right is of this order
    given = ["(8)", "(11)"]                    # claims symbol = ... that are taken as true
    conventions = [{ what = "...", symbols = { ... }, contradicts = "..." }]
    ranges = { t = [0.4, 0.9] }                # ranges of variables in this claim
    through = "p = integral(h, s, 0, c)"       # the equation by which h = ... is judged
    allowed = { sigma = "..." }                # a bound is judged where it is just reached; it
    beyond = { sigma = "..." }                 #   must be true with `allowed`, not with `beyond`
    leading = true                             # ~ between leading terms is compared like =
    swaps = ["a", "c"]                         # symbols that may have been confused
    cases = [{ l = 1 }]                        # the only points that are used
    family = "large tension"                   # claims of one family share their points
    equation = "(3)"                           # the display to which it belongs
    against = "..."                            # what it is compared with, in words
    steps = ["..."]                            # the steps of the comparison
    consequence = "..."                        # the effect of the error on a user's results

    [signs]                                    # claims that show the sign of a quantity
    moment = ["(2)", "half-width"]

The body's parameters, E_star and f are always variables, and [variables] may give them a range.
The variables x, s and xi are positions, whose default range is symmetric about zero.
"""

import re
import tomllib
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from functools import cache, partial
from os.path import isdir
from pathlib import Path
from typing import Any, TypeGuard, TypeVar

from sympy import Expr, Limit, Rational, Symbol, false, true
from sympy.logic.boolalg import Boolean

from derive.errors import (
    BadClaimsFile,
    BadFormula,
    BadText,
    BadUnit,
    NotAccepted,
    NotProven,
    UserError,
)
from derive.files import Unreadable, bytes_of
from derive.library import is_in_library, library
from derive.limit import LimitReached, within
from derive.paper.bodies import Body, of_library
from derive.paper.claim import (
    SCALE,
    SIGNED,
    Bound,
    Claim,
    Convention,
    Meaning,
    Paper,
    Range,
    Relation,
    Rounded,
    Verdict,
)
from derive.paper.context import (
    PLACES,
    Context,
    Meant,
    Put,
    as_text,
    calls_in,
    free,
    integrals,
    with_real_bound,
)
from derive.paper.dimensions import Units
from derive.paper.formula import (
    IMPROPER,
    Names,
    UnknownName,
    approach,
    equation,
    may_be_rounded,
    rounded_in,
    unknown,
    usable,
)
from derive.paper.formula import condition as read_condition
from derive.paper.formula import formula as read_formula
from derive.paper.geometry_file import profile_of
from derive.paper.latex import Latex
from derive.paper.lines import heads, line_of
from derive.paper.mistakes import demand_none
from derive.paper.statements import statements
from derive.symbols import E_star, f
from derive.units import Dimension, parse_unit
from derive.writing.draft import Wanted, draft

Read = TypeVar("Read")

BUILT_IN = Path(__file__).parent / "andresen2020"
"""The claims files of the paper that introduced the method of this project."""

_LARGEST = 200_000
"""The largest size of a claims file, in bytes."""
_MOST = 500
"""The largest number of claims in a file."""
_SECONDS = 30.0
"""The default time limit of a verdict, and then of the search for a correction, in seconds."""
_MOST_SECONDS = 86_400
_FROM_THE_START: Mapping[str, Expr] = {**PLACES, "E_star": E_star, "f": f}
_KEYS = frozenset({"title", "seconds", "body", "variables", "symbols", "latex", "claims", "signs"})
_OF_A_SYMBOL = frozenset({"is", "meaning", "proposal", "unit"})
_OF_A_VARIABLE = frozenset({"meaning", "low", "high", "unit"})
_OF_A_BODY = frozenset({"g", "units"})
_OF_A_CONVENTION = frozenset({"what", "symbols", "contradicts"})
_OF_A_CLAIM = (
    frozenset(("label", "place", "says", "printed", "latex", "understood", "expected", "symbols"))
    | {"part", "accepted"}
    | {"conventions", "unchecked", "require", "as", "order", "given", "body", "ranges", "through"}
    | {"allowed", "beyond", "leading", "swaps", "cases", "family", "equation", "against", "steps"}
    | {"consequence"}
)
_BESIDE = ("as", "order", "require", "given")
"""The entries that are shown with a reading, because its verdict depends on them."""


@dataclass(frozen=True)
class Reading:
    """The reading of a claim's LaTeX that the file does not accept yet.

    number      the number of the claim in the file, counted from 1
    understood  the equation as text; empty if the LaTeX cannot be read
    accepted    the different reading that the file accepts; empty if there is none
    beside      the entries of the claim that its verdict depends on, such as `as` and `require`
    why         the reason why the claim cannot be judged even if this reading is accepted
    """

    number: int
    label: str
    latex: str
    understood: str
    accepted: str = ""
    beside: Mapping[str, str] = field(default_factory=dict)
    why: str = ""


def read_claims(path: Path) -> Paper:
    """Read the claims of a file, or of all files in a folder in the order of their names.

    Raises BadClaimsFile or BadFormula for one error, and Mistakes for several.  A claim that cannot
    be read or compared is returned as unchecked, with the reason.
    """
    if not isdir(path):  # noqa: PTH112 - False for a name that no file can have
        return _file(path).paper()
    papers = [_file(each).paper() for each in sorted(path.glob("*.toml"))]
    if not papers:
        why = "the folder has no claims file"
        raise BadClaimsFile(str(path), why, "give a claims file, or a folder with such files")
    signs = dict[str, tuple[str, ...]]()
    for each in papers:
        signs |= {name: signs.get(name, ()) + labels for name, labels in each.signs.items()}
    return Paper(papers[0].title, tuple(c for each in papers for c in each.claims), signs)


@cache
def built_in() -> Paper:
    """Return the paper that introduced the method of this project."""
    return read_claims(BUILT_IN)


def open_readings(path: Path) -> list[Reading]:
    """Return the readings that are not accepted yet, and the LaTeX that cannot be read.

    Raises the errors of `read_claims`.
    """
    file = _file(path)
    file.paper()
    return file.readings


def _file(path: Path) -> "_File":
    text, data = source(path)
    return _File(str(path), data, text)


def source(path: Path) -> tuple[str, dict[str, Any]]:
    """Return a claims file as text and as data; raises BadClaimsFile."""
    remedy = "give a claims file such as examples/cattaneo_mindlin.toml"
    try:
        text = bytes_of(path, _LARGEST).decode("utf-8-sig")
        return text, tomllib.loads(text)
    except Unreadable as error:
        raise BadClaimsFile(str(path), str(error), remedy) from error
    except tomllib.TOMLDecodeError as error:
        raise BadClaimsFile(str(path), f"the file is not valid TOML ({error})", remedy) from error
    except UnicodeDecodeError as error:
        raise BadClaimsFile(str(path), "the file is not UTF-8 text", remedy) from error
    except (ValueError, RecursionError) as error:
        raise BadClaimsFile(str(path), f"the file cannot be read ({error})", remedy) from error


@dataclass
class _File:
    """Reads a claims file; errors are collected and reported together at the end."""

    name: str
    data: Mapping[str, Any]
    text: str = ""
    ranges: dict[Symbol, Range] = field(default_factory=dict)
    declared: dict[str, Expr] = field(default_factory=dict)
    contexts: dict[str, Context] = field(default_factory=dict)
    mistakes: list[UserError] = field(default_factory=list)
    of_claims: list[UserError] = field(default_factory=list)
    readings: list[Reading] = field(default_factory=list)
    read: dict[str, tuple[Expr, Expr]] = field(default_factory=dict)
    units: dict[Symbol, Dimension] = field(default_factory=dict)
    followed: dict[int, Units] = field(default_factory=dict)

    def paper(self) -> Paper:
        """Return all claims."""
        for text in _texts(self.data):
            if not text.replace("\n", "").replace("\t", "").isprintable():
                self.mistakes.append(
                    self._bad(f"the text {text!r} holds a control character", "remove it")
                )
        demand_none(self.mistakes)
        with self._noted():
            self._demand_known(self.data, _KEYS, "the file")
        self.seconds = _SECONDS
        with self._noted():
            self.seconds = self._limit()
        self.context = Context(None, _FROM_THE_START, {})
        with self._noted():
            self.context = self._context(self.data.get("body"), self.name)
        with self._noted():
            for name, said in self._table("variables").items():
                with self._noted():
                    self._declare(name, said)
        self.contexts.clear()
        with self._noted():
            self.context = self._context(self.data.get("body"), self.name)
        self._read_symbols()
        claims = self._claims()
        signs = dict[str, tuple[str, ...]]()
        with self._noted():
            signs = {
                name: self._list(self._table("signs"), name, "signs")
                for name in self._table("signs")
            }
        if self.mistakes:
            demand_none([*self.mistakes, *self.of_claims])
        return Paper(str(self.data.get("title", self.name)), claims, signs)

    def _context(self, given: object, where: str) -> Context:
        """Return the context of a named or defined body; each body is derived only once."""
        key = repr(given)
        if key not in self.contexts:
            body = self._body(given, where)
            file, own = self.context, Context(body, {}, {}).parameters
            variables = {**_FROM_THE_START, **file.parameters, **self.declared, **own}
            units = file.sheet.geometry.dimensions if file.sheet else {}
            self.contexts[key] = Context(body, variables, self.units, units)
        return self.contexts[key]

    def _body(self, given: object, where: str) -> Body | None:
        if given is None or given == "none":
            return None
        if isinstance(given, dict):
            self._demand_known(given, _OF_A_BODY, f"{where}, body")
            profile = self._text(given, "g", f"{where}, body")
            units = self._inner(given, "units", f"{where}, body")
            told = tuple(sorted((name, str(unit)) for name, unit in units.items()))
            try:
                return _own_body(profile, told)
            except BadText as error:
                at = f"{where}, body"
                raise BadFormula(at, profile, error.column, error.why, error.remedy) from error
            except UserError as error:
                why = f"{where}, body: {error.message}"
                raise self._bad(why, "correct g or the units") from error
        if isinstance(given, str) and given.endswith(".py"):
            try:
                profile, units = profile_of(Path(self.name).parent / given)
                return _own_body(profile, tuple(sorted(units.items())))
            except UserError as error:
                why = f"{where}, body: {error.message}"
                raise self._bad(why, "correct the geometry file, or write g here") from error
        if not isinstance(given, str) or not is_in_library(given):
            known = ", ".join(library())
            why = f"{where}, body = {given!r} is not in the library"
            remedy = f"write one of {known}, a geometry file, or {{ g = 'x**2/(2*R)' }}"
            raise self._bad(why, remedy)
        return of_library(given)

    @contextmanager
    def _noted(self) -> Iterator[None]:
        """Leave the block at its first error and record this error."""
        try:
            yield
        except UserError as error:
            self.mistakes.append(error)

    def _read_symbols(self) -> None:
        """Read [symbols] and [latex]; report each error in them once, and allow empty symbols."""
        self.symbols = dict[str, Any]()
        with self._noted():
            self.symbols = self._table("symbols")
        taken = {**self.context.parameters, **self.declared}
        if self.context.body is not None:
            taken |= {"E_star": E_star, "f": f}
        for name, said in list(self.symbols.items()):
            with self._noted():
                line = line_of(self.text, "symbols", name)
                where = f"{self.name}:{line}" if line else self.name
                self._demand_name(name, ())
                if type(said) not in (str, int, float, dict):
                    why = f"{where}, the value of the symbol {name!r} is not a text"
                    raise self._bad(why, f'write {name} = "a formula"')
                if isinstance(said, dict):
                    with self._noted():
                        self._demand_known(said, _OF_A_SYMBOL, f"{where}, the symbol {name!r}")
                    symbol = taken.get(name, Symbol(name))
                    if symbol not in self.units and symbol not in self.context.parameters.values():
                        self._say_unit(symbol, said, f"{where}, the symbol {name!r}")
                if name in taken and not (name in PLACES and _formula_of(said)):
                    if _formula_of(said):
                        what = "a variable" if name in self.declared else "a parameter of the body"
                        why = f"{where}, the symbol {name!r} is already {what}"
                        raise self._bad(why, "remove the symbol, or rename one of them")
                    del self.symbols[name]  # it is that variable
        with self._noted():
            self._spellings()
        self.meant = dict[str, Meant]()
        tables = [self._meant(context) for context in self._all_contexts()]
        for name in self.symbols:
            if all(name in meant.wrong for meant in tables):
                self.mistakes.append(tables[0].wrong[name])

    def _all_contexts(self) -> list[Context]:
        """Return the contexts of the file's body and of the bodies of its claims."""
        contexts, claims = [self.context], self.data.get("claims", [])
        for given in claims if isinstance(claims, list) else []:
            with suppress(UserError):
                if isinstance(given, dict) and "body" in given:
                    contexts.append(self._context(given["body"], self.name))
        return contexts

    def _meant(self, context: Context, own: Mapping[str, Any] | None = None) -> Meant:
        """Return the meanings of all symbols for a body and a claim."""
        key = repr((id(context), sorted((own or {}).items(), key=str)))
        if key not in self.meant:
            self.meant[key] = Meant({}, {})
            if own and context is self.context:
                self.meant[key] = self._meant(context).without(own)
            symbols = {**self.symbols, **(own or {})}
            for name in symbols:
                self._define(name, symbols, context, self.meant[key], ())
        return self.meant[key]

    def _define(
        self,
        name: str,
        symbols: Mapping[str, Any],
        context: Context,
        meant: Meant,
        outer: tuple[str, ...],
    ) -> bool:
        """Add the meaning of a symbol and of those that it uses; return whether it has one."""
        symbol = Symbol(name)
        if symbol in meant.ours or name in meant.wrong:
            return symbol in meant.ours
        text = _formula_of(symbols[name])
        if not text:
            return False
        line = line_of(self.text, "symbols", name)
        where = f"{self.name}:{line}, symbols: {name}" if line else f"{self.name}, symbols: {name}"
        if name in outer:
            round_ = outer[outer.index(name) :]
            told = ", ".join(round_)
            why = f"{where} has a circular definition through {told}"
            error = self._bad(why, "define one of these symbols without the others")
            meant.wrong.update(dict.fromkeys(round_, error))
            return False
        others = {n: Symbol(n) for n in symbols if n != name}
        names = Names(where, {**context.variables, **others}, context.arities)
        try:
            found = self._in_time(where, lambda: read_formula(text, names))
            for inner in sorted(free(found) & set(others.values()), key=str):
                if not self._define(inner.name, symbols, context, meant, (*outer, name)):
                    if inner.name in meant.wrong:
                        meant.wrong.setdefault(name, meant.wrong[inner.name])
                    meant.lacks[name] = meant.lacks.get(inner.name, inner.name)
                    return False
            found = with_real_bound(found, others.values() - meant.ours.keys())
            written = found.xreplace(meant.written)
            ours = self._in_time(where, lambda: context.put_in(written))
        except UserError as error:
            meant.wrong[name] = error
            return False
        needed = {each.name for each in found.free_symbols}
        meant.needs[name] = needed.union(*(meant.needs.get(each, ()) for each in needed))
        meant.written[symbol], meant.ours[symbol] = written, ours
        return True

    def _claims(self) -> tuple[Claim, ...]:
        given = self.data.get("claims", [])
        if not isinstance(given, list) or not given or len(given) > _MOST:
            why = f"the number of [[claims]] is not between 1 and {_MOST}"
            self.mistakes.append(self._bad(why, "add claims, or split the file"))
            return ()
        lines = heads(self.text, len(given))
        made, labels = list[Claim](), set[str]()
        for number, each in enumerate(given, start=1):
            at = f"{self.name}:{lines[number - 1]}" if lines else self.name
            with self._noted():
                claim = self._claim(number, each, at)
                if claim.label in labels:
                    label = claim.label
                    why = f"{at}, two claims have the label {label!r}"
                    raise self._bad(why, "give each claim a different label")
                labels.add(claim.label)
                made.append(claim)
        return tuple(made)

    def _limit(self) -> float:
        given = self.data.get("seconds", _SECONDS)
        if type(given) not in (int, float) or not 0 < given <= _MOST_SECONDS:
            remedy = f"write a number above 0 and at most {_MOST_SECONDS}"
            raise self._bad(f"seconds = {given!r} is not a time limit", remedy)
        return float(given)

    def _in_time(self, where: str, read: Callable[[], Read]) -> Read:
        """Return the result of `read`; raise BadClaimsFile if it takes too long."""
        try:
            with within(self.seconds):
                return read()
        except LimitReached:
            why = f"{where} could not be read within {self.seconds:g} s"
            raise self._bad(why, "simplify it, or increase seconds") from None
        except RecursionError:
            raise self._bad(f"{where} is nested too deeply", "simplify it") from None
        except NotProven as error:
            why = f"{where} uses a formula that is not proven: {error}"
            raise self._bad(why, "use another formula, or a simpler body") from error

    def _declare(self, name: str, said: object) -> None:
        line = line_of(self.text, "variables", name)
        where = f"{self.name}:{line}, variable {name!r}" if line else f"variable {name!r}"
        self._demand_name(name, ())
        given: dict[str, Any] = said if isinstance(said, dict) else {}
        with self._noted():
            self._demand_known(given, _OF_A_VARIABLE, where)
        low, high = given.get("low"), given.get("high")
        if isinstance(said, str) or (given and low is high is None):
            self._drawn(name, SCALE, positive=True)
            return
        if not (_is_bound(low) and _is_bound(high)) or low >= high:
            why = f"{where} has no valid range"
            raise self._bad(why, "write { low = 0.1, high = 0.9 }, or only its meaning as text")
        self._drawn(name, Range(float(low), float(high)), positive=low >= 0)

    def _drawn(self, name: str, span: Range, positive: bool) -> None:
        """Declare a variable with its range; variables of the theory keep their own symbols."""
        known = Symbol(name, positive=True) if positive else Symbol(name, real=True)
        symbol = self.context.variables.get(name, known)
        assert isinstance(symbol, Symbol)
        self.declared[name] = symbol
        self._say_unit(symbol, self.data["variables"][name], f"variable {name!r}")
        if span != SCALE or name in PLACES:
            self.ranges[symbol] = span

    def _say_unit(self, symbol: Symbol, said: object, where: str) -> None:
        if not isinstance(said, dict) or "unit" not in said:
            return
        try:
            self.units[symbol] = parse_unit(said["unit"])
        except BadUnit as error:
            raise self._bad(f"{where}: {error.message}", "write a unit such as N/m") from error

    def _mismatch(self, context: Context, meant: Meant, text: str, names: Names) -> str:
        """Describe the units that do not fit in an equation, whether it is judged or not."""
        try:
            left, _, right = self._in_time(names.where, lambda: equation(text, names, rough=True))
        except (UserError, RecursionError):
            return ""
        key = id(meant)
        if key not in self.followed:
            self.followed[key] = context.followed(meant)
        return self.followed[key].mismatch(left, right)

    def _claim(self, number: int, given: object, at: str) -> Claim:
        if not isinstance(given, dict):
            why = f"{at}, claim {number} is not a table"
            raise self._bad(why, "write [[claims]] before each claim")
        label = self._text(given, "label", f"{at}, claim {number}")
        where = f"{at}, claim {label!r}"
        common: dict[str, Any] = {
            "label": label,
            "place": str(given.get("place", Path(self.name).name)),
            "says": str(given.get("says", label)),
            "latex": str(given.get("latex", "")),
            "equation": str(given.get("equation", "")),
            "consequence": str(given.get("consequence", "")),
            "seconds": self.seconds,
        }
        told = str(given.get("understood", given.get("printed", "")))
        try:
            return self._stated(number, given, where, told, common)
        except UserError as error:
            self.of_claims.append(error)
            return Claim(unchecked=_reason(error, where), source=told, **common)

    def _stated(
        self, number: int, given: Mapping[str, Any], where: str, told: str, common: dict[str, Any]
    ) -> Claim:
        """Return a claim; raise UserError if one of its entries is not allowed."""
        self._demand_known(given, _OF_A_CLAIM, where)
        common["steps"] = self._list(given, "steps", where)
        common["expected"] = self._verdict(given, where)
        context = self._context(given["body"], where) if "body" in given else self.context
        own = self._inner(given, "symbols", where)
        for name in own:
            self._demand_name(name, ())
        symbols = {**self.symbols, **own}
        names = self._names(where, symbols, context)
        meant = self._meant(context, own)
        common["units"] = self._mismatch(context, meant, told, names) if told else ""
        if "unchecked" in given:
            return Claim(unchecked=self._text(given, "unchecked", where), source=told, **common)
        try:
            text = self._in_time(where, lambda: self._printed(given, where, names))
            left, relation, right = self._in_time(
                where, lambda: equation(text, names, rough=_may_be_rough(given, text))
            )
        except NotAccepted as error:
            return self._waiting(number, given, common, error, names)
        except UnknownName as error:
            missing = unknown(error.given, names) or ["oo"]
            return _lacking(given, common, missing, meant)
        except BadFormula as error:
            if "latex" in given:
                why, latex = _reason(error, where), common["latex"]
                self.readings.append(Reading(number, common["label"], latex, "", why=why))
            raise
        if "given" in given:
            meant = self._follows(given, where, symbols, meant)
        open_ = {Symbol(name) for name in symbols} - meant.ours.keys()
        left, right = (with_real_bound(side, open_) for side in (left, right))
        self.read[common["label"]] = left, right
        through = self._through(given, where, left, names)
        sides = (left, right)
        if through is not None:
            sides = through[0].xreplace({left: right}), through[1].xreplace({left: right})
        held = free(*sides)
        lacking = [name for name in symbols if Symbol(name) in held & open_]
        if lacking:
            return _lacking(given, common, lacking, meant)
        read = _Read(given, where, text, left, relation, right, through)
        return self._judged(read, context, meant, common)

    def _judged(
        self, read: "_Read", context: Context, meant: Meant, common: dict[str, Any]
    ) -> Claim:
        """Return a claim that can be judged."""
        given, where, left, right = read.given, read.where, read.left, read.right
        compared = read.through or (left, right)
        calls = calls_in(left, right, *compared)
        named = {call: Symbol(as_text(call)) for call in calls}
        put = Put(context, named, meant.ours)
        left, right = (put.without_calls(side) for side in (left, right))
        compared = tuple(put.without_calls(side) for side in compared)
        called = {**meant.ours, **put.called(meant.ours)}
        self._demand_bound(where, left, right, called)
        held = _variables(*compared, called) - _inside(*compared, called)
        self._demand_one_parameter(read, context, meant, held)
        rounded = self._rounded(read, context, put)
        relation = read.relation
        if relation == Relation.LIKE and not given.keys() & {"as", "leading"}:
            relation = Relation.EQUAL
        conditions = self._conditions(read, context, meant, held)
        held = held.union(*(each.free_symbols for each in conditions))
        reached = self._reached(given, where, put, context)
        if reached is not None:
            changed = (*reached.allowed.values(), *reached.beyond.values())
            held = held.union(*(expr.free_symbols for expr in changed))
        ranges = self.ranges | self._ranges(given, where, context)
        return Claim(
            left=left,
            right=right,
            relation=relation,
            reached=reached,
            meaning=called,
            against=self._against(given, context),
            ranges=_places(held) | {s: r for s, r in ranges.items() if s in held},
            conditions=conditions,
            defined=_is_defined(read, meant),
            through=compared if read.through else None,
            cases=self._cases(given, where, context),
            family=str(given.get("family", "")),
            toward=self._toward(read, context, meant),
            order=self._order(given, where),
            rounded=rounded,
            conventions=self._conventions(given, where, put, context),
            source=read.text,
            reading=partial(_reading, Names(where, _known(context, put), context.arities), put),
            swaps=self._swaps(read, meant, context),
            unit_of=self._units_of(read, meant, context, held),
            **common,
        )

    def _against(self, given: Mapping[str, Any], context: Context) -> str:
        """Describe what a claim is compared with."""
        if "against" in given:
            return str(given["against"])
        sheet, claims = context.sheet, ", ".join(map(str, given.get("given", ())))
        told = f" and the formula sheet of {sheet.geometry.name}" if sheet else ""
        return f"the formulas of {self.name}{told}" + (f", given {claims}" if claims else "")

    def _through(
        self, given: Mapping[str, Any], where: str, left: Expr, names: Names
    ) -> tuple[Expr, Expr] | None:
        """Return both sides of the equation by which a definition is judged."""
        if "through" not in given:
            return None
        if not isinstance(left, Symbol):
            why = f"{where}: the left side is not a symbol, although through is given"
            raise self._bad(why, "write the claim in the form symbol = ...")
        text = self._text(given, "through", where)
        first, relation, second = self._in_time(where, lambda: equation(text, names))
        if relation != Relation.EQUAL or not (first.has(left) or second.has(left)):
            why = f"{where}: through is not an equation that contains {left}"
            raise self._bad(why, "write one that is true if the claim is true")
        if any(call.has(left) for call in calls_in(first, second)):
            why = f"{where}: through contains {left} as an argument of a formula of the body"
            raise self._bad(why, f"use {left} only outside such calls")
        return first, second

    def _reached(
        self, given: Mapping[str, Any], where: str, put: Put, context: Context
    ) -> Bound | None:
        """Return the replacements by which a bound is judged on both sides."""
        if not given.keys() & {"allowed", "beyond"}:
            return None
        tables = [self._inner(given, key, where) for key in ("allowed", "beyond")]
        if not all(tables):
            why = f"{where} has only one of allowed and beyond"
            raise self._bad(why, 'write both, as allowed = { sigma = "..." }')
        return Bound(*(self._changed(given, where, table, put, context) for table in tables))

    def _ranges(
        self, given: Mapping[str, Any], where: str, context: Context
    ) -> dict[Symbol, Range]:
        """Return the ranges of variables in one claim."""
        found = dict[Symbol, Range]()
        for name, ends in self._inner(given, "ranges", where).items():
            symbol = context.variables.get(name)
            if not isinstance(symbol, Symbol):
                raise self._bad(f"{where}: ranges: {name!r} is not a variable", "declare it")
            if not (isinstance(ends, list) and len(ends) == 2 and all(map(_is_bound, ends))):
                why = f"{where}: ranges: {name} does not have two ends"
                raise self._bad(why, "write two numbers, such as [0.1, 0.9]")
            if ends[0] >= ends[1] or (symbol.is_positive and ends[0] < 0):
                remedy = "write the lower end first, and none below zero for a positive variable"
                raise self._bad(f"{where}: ranges: {ends} is not a range of {name}", remedy)
            found[symbol] = Range(float(ends[0]), float(ends[1]))
        return found

    def _cases(
        self, given: Mapping[str, Any], where: str, context: Context
    ) -> tuple[Mapping[Symbol, str], ...]:
        """Return the points that a claim prescribes."""
        listed = given.get("cases", [])
        if not isinstance(listed, list) or not all(isinstance(each, dict) for each in listed):
            why = f"{where}: cases is not a list of tables"
            raise self._bad(why, "write a list such as [{ l = 1 }]")
        made = []
        for each in listed:
            for name, value in each.items():
                if not isinstance(context.variables.get(name), Symbol) or not _is_bound(value):
                    why = f"{where}: cases: {name} = {value!r} is not a variable with a number"
                    raise self._bad(why, "write [{ l = 1 }] with variables of the claim")
            made.append({context.variables[name]: str(value) for name, value in each.items()})
        return tuple(made)

    def _swaps(self, read: "_Read", meant: Meant, context: Context) -> tuple[Symbol, ...]:
        """Return the names that may have been confused, by default all names in the equation."""
        if "swaps" not in read.given:
            held = _names_in(read)
            defined = [s for s in meant.ours if s in held]
            return (*defined, *sorted(held - set(defined), key=str))
        named = self._list(read.given, "swaps", read.where)
        symbols = {**context.variables, **{s.name: s for s in meant.ours}}
        for name in named:
            if not isinstance(symbols.get(name), Symbol):
                raise self._bad(f"{read.where}: swaps: {name!r} is not a symbol", "declare it")
        return tuple(symbols[name] for name in named)

    def _units_of(
        self, read: "_Read", meant: Meant, context: Context, held: set[Symbol]
    ) -> dict[Symbol, str]:
        """Return the known units of the variables and of the names in the equation."""
        units = self.followed.get(id(meant)) or context.followed(meant)
        found = {s: units.unit_of(s) for s in sorted(_names_in(read) | held, key=str)}
        return {symbol: unit for symbol, unit in found.items() if unit}

    def _follows(
        self, given: Mapping[str, Any], where: str, symbols: Mapping[str, Any], meant: Meant
    ) -> Meant:
        """Return the meanings of symbols if other claims are true; open symbols are variables."""
        listed = given["given"]
        if not isinstance(listed, list) or not all(isinstance(each, str) for each in listed):
            raise self._bad(f"{where}: given is not a list of labels", 'write given = ["(8)"]')
        table = dict[Symbol, Expr]()
        for label in listed:
            if label not in self.read:
                why = f"{where}: given names {label!r}, which is not a claim before this one"
                raise self._bad(why, "name a claim that comes before this one and can be read")
            left, right = self.read[label]
            if not isinstance(left, Symbol):
                left, right = right, left
            if not isinstance(left, Symbol) or right.has(left):
                why = f"{where}: the given claim {label!r} does not define a symbol"
                raise self._bad(why, "give claims of the form symbol = ...")
            table[left] = right
        for name in symbols:
            if Symbol(name) not in meant.ours and Symbol(name) not in table:
                table[Symbol(name)] = Symbol(name, positive=True)
        free = {s: e for s, e in meant.ours.items() if s not in table}
        for _ in table:
            table = {s: expr.xreplace(table) for s, expr in table.items()}
        if any(expr.free_symbols & table.keys() for expr in table.values()):
            raise self._bad(f"{where}: the given claims are circular", "remove one of them")
        return Meant(table, {**free, **{s: expr.xreplace(free) for s, expr in table.items()}})

    def _conditions(
        self, read: "_Read", context: Context, meant: Meant, held: set[Symbol]
    ) -> tuple[Boolean, ...]:
        """Return the conditions of the formulas that are called, and those of the claim."""
        found, bound = set[Boolean](), set[Symbol]()
        for side in (read.left, read.right):
            written = side.xreplace(meant.written)
            found |= set(context.conditions(written))
            bound |= {over.limits[-1][0] for over in integrals(written)}
            bound |= {limit.args[1] for limit in written.atoms(Limit)}
        listed = read.given.get("require", [])
        for text in [listed] if isinstance(listed, str) else listed:
            names = self._names(f"{read.where}: require", [s.name for s in meant.ours], context)
            needed = self._in_time(read.where, partial(read_condition, str(text), names))
            found.add(needed.xreplace(meant.ours))
        inside = bound - held
        kept = [each for each in found if each != true and not each.free_symbols & inside]
        if false in found:
            why = f"{read.where}: its conditions are never satisfied"
            raise self._bad(why, "correct require, or the arguments of the formulas called")
        return tuple(sorted(kept, key=str))

    def _toward(self, read: "_Read", context: Context, meant: Meant) -> tuple[Expr, Expr] | None:
        if "as" not in read.given:
            return None
        names = self._names(f"{read.where}: as", [s.name for s in meant.ours], context)
        text = self._text(read.given, "as", read.where)
        first, end = self._in_time(read.where, lambda: approach(text, names))
        return context.put_in(first.xreplace(meant.ours)), context.put_in(end.xreplace(meant.ours))

    def _order(self, given: Mapping[str, Any], where: str) -> float | None:
        order = given.get("order")
        if order is not None and (type(order) not in (int, float) or "as" not in given):
            why = f"{where}: order = {order!r} is not a number, or as is missing"
            raise self._bad(why, "write order as a number, together with as")
        return None if order is None else float(order)

    def _rounded(self, read: "_Read", context: Context, put: Put) -> Rounded | None:
        """Return the rounded constant that is a factor of a side, if there is exactly one."""
        found = rounded_in(read.text)
        if len(found) != 1:
            return None
        (one,) = found
        constant = Symbol("constant", positive=True)
        text = f"{read.text[: one.start()]}constant{read.text[one.end() :]}"
        symbols = {**_known(context, put), "constant": constant}
        left, _, right = equation(text, Names(read.where, symbols, context.arities), rough=True)
        power = (right / left).as_independent(constant)[1].as_base_exp()
        if power[0] != constant or power[1] not in (1, -1):
            return None
        half = Rational(5, 10 ** (len(one[0].partition(".")[2]) + 1))
        return Rounded(Rational(one[0]), half, int(power[1]))

    def _waiting(
        self,
        number: int,
        given: Mapping[str, Any],
        common: dict[str, Any],
        error: NotAccepted,
        names: Names,
    ) -> Claim:
        """Return an unchecked claim whose reading is not accepted, and record the reading."""
        beside = {key: _shown(given[key]) for key in _BESIDE if key in given}
        why = ""
        try:
            equation(error.understood, names, rough=_may_be_rough(given, error.understood))
        except BadFormula as fault:
            why = _reason(fault, names.where)
        self.readings.append(
            Reading(
                number,
                common["label"],
                given["latex"],
                error.understood,
                error.accepted,
                beside,
                why,
            )
        )
        said = f"the file accepts {error.accepted}" if error.accepted else "this is not accepted"
        by_hand = "accepted = true"
        if given.get("accepted") is not False:
            by_hand = f'understood = "{error.understood}"'
        why = (
            f"the LaTeX was read as {error.understood}, but {said}: use --accept, or write "
            f"{by_hand}"
        )
        return Claim(unchecked=why, source=error.understood, **common)

    def _names(self, where: str, symbols: Iterable[str], context: Context) -> Names:
        """Return the names that a printed equation may hold: symbols, variables and formulas."""
        known = {**context.variables, **{name: Symbol(name) for name in symbols}}
        return Names(where, known, context.arities)

    def _printed(self, given: Mapping[str, Any], where: str, names: Names) -> str:
        if ("printed" in given) == ("latex" in given):
            why = f"{where} has both or neither of printed and latex"
            raise self._bad(why, "give exactly one of them")
        if "printed" in given:
            return self._text(given, "printed", where)
        spellings = {**{n: n for n in names.symbols}, **_usual(names), **self._spellings()}
        latex = self._part(given, where)
        understood = Latex(where, latex, spellings).understood()
        accepted = str(given.get("understood", ""))
        if given.get("accepted") is False:
            raise NotAccepted(where, understood, "")
        both = [equation(text, names, rough=True) for text in (accepted or understood, understood)]
        if not accepted or both[0] != both[1]:
            raise NotAccepted(where, understood, accepted)
        return accepted

    def _part(self, given: Mapping[str, Any], where: str) -> str:
        """Return the LaTeX of a claim, or of one statement in its display."""
        latex = self._text(given, "latex", where)
        if "part" not in given:
            return latex
        found, part = statements(where, latex), given["part"]
        if type(part) is not int or not 1 <= part <= len(found):
            why = f"{where}: part = {part!r} is not the number of a statement in this display"
            raise self._bad(why, f"write a number from 1 to {len(found)}")
        return found[part - 1].latex

    def _spellings(self) -> dict[str, str]:
        """Return [latex]; its names are declared in the file, or bound in the claims."""
        found = self._table("latex")
        for spelling, name in found.items():
            if not isinstance(name, str) or not usable(name):
                why = f"[latex] {spelling!r} = {name!r} is not a name"
                raise self._bad(why, "write a name of [symbols] or [variables]")
        return found

    def _demand_bound(self, where: str, left: Expr, right: Expr, meaning: Meaning) -> None:
        """Refuse variables of integration, except positions, that are also used outside."""
        meant = (meaning[s] for s in left.free_symbols | right.free_symbols if s in meaning)
        bound = {over.limits[-1][0] for over in integrals(left, right, *meant)}
        bound -= set(PLACES.values())
        table = {s: expr for s, expr in meaning.items() if s not in bound}
        held = left.xreplace(table).free_symbols | right.xreplace(table).free_symbols
        for along in sorted(bound & (held | meaning.keys()), key=str):
            why = f"{where}: {along} is a variable of integration and also used outside"
            raise self._bad(why, "use another variable of integration, such as s or xi")

    def _demand_one_parameter(
        self, read: "_Read", context: Context, meant: Meant, held: set[Symbol]
    ) -> None:
        """Refuse a parameter that a claim defines anew although formulas of the body hold it."""
        for name in self._inner(read.given, "symbols", read.where):
            symbol, ours = context.variables.get(name), meant.ours.get(Symbol(name))
            if ours is None or name not in {*context.parameters, "E_star", "f"}:
                continue
            if symbol in held - ours.free_symbols:
                why = f"{read.where}: {name} is {ours}, but formulas of the body hold {name} too"
                raise self._bad(why, f"express the other symbols by {name} instead")

    def _conventions(
        self,
        given: Mapping[str, Any],
        where: str,
        put: Put,
        context: Context,
    ) -> tuple[Convention, ...]:
        made = []
        listed = given.get("conventions", [])
        if not isinstance(listed, list):
            raise self._bad(f"{where}: conventions is not a list", "write [{ what = ... }]")
        for each in listed:
            if not isinstance(each, dict):
                raise self._bad(f"{where}: a convention is not a table", "write { what = ... }")
            self._demand_known(each, _OF_A_CONVENTION, f"{where}: a convention")
            what = self._text(each, "what", where)
            against = self._text(each, "contradicts", where)
            symbols = self._inner(each, "symbols", where)
            changed = self._changed(given, where, symbols, put, context)
            made.append(Convention(what, changed, against))
        return tuple(made)

    def _changed(
        self,
        given: Mapping[str, Any],
        where: str,
        symbols: Mapping[str, Any],
        put: Put,
        context: Context,
    ) -> Meaning:
        """Return the meanings that change if some symbols of a claim are redefined."""
        other = self._meant(context, {**self._inner(given, "symbols", where), **symbols}).ours
        changed = {s: expr for s, expr in other.items() if put.meaning.get(s) != expr}
        return {**changed, **put.called(other)}

    def _verdict(self, given: Mapping[str, Any], where: str) -> Verdict | None:
        if "expected" not in given:
            return None
        try:
            return Verdict(given["expected"])
        except ValueError:
            known = ", ".join(Verdict)
            raise self._bad(
                f"{where}: expected = {given['expected']!r} is not a verdict",
                f"write one of {known}",
            ) from None

    # -------------------------------------------------------------- reading the data

    def _table(self, key: str) -> dict[str, Any]:
        return self._inner(self.data, key, "the file")

    def _inner(self, data: Mapping[str, Any], key: str, where: str) -> dict[str, Any]:
        found = data.get(key, {})
        if not isinstance(found, dict):
            why = f"{key} of {where} is not a table"
            raise self._bad(why, f"write [{key}] with names below it, or {key} = {{ ... }}")
        return found

    def _text(self, data: Mapping[str, Any], key: str, where: str) -> str:
        found = data.get(key)
        if not isinstance(found, str) or not found.strip():
            raise self._bad(f"{where} has no {key}", f'write {key} = "..."')
        return found

    def _list(self, data: Mapping[str, Any], key: str, where: str) -> tuple[str, ...]:
        found = data.get(key, [])
        if not isinstance(found, list) or not all(isinstance(each, str) for each in found):
            raise self._bad(f"{where}: {key} is not a list of texts", f'write {key} = ["..."]')
        return tuple(found)

    def _demand_known(self, data: Mapping[str, Any], known: frozenset[str], where: str) -> None:
        wrong = ", ".join(repr(key) for key in data if key not in known)
        if wrong:
            why = f"{where}: the key {wrong} is unknown"
            raise self._bad(why, f"use one of {', '.join(sorted(known))}")

    def _demand_name(self, name: str, taken: object) -> None:
        if not usable(name):
            why = f"{name!r} is reserved or is not a valid name"
            raise self._bad(why, "use another name of letters, digits and _")
        if name in taken:  # type: ignore[operator]
            raise self._bad(f"{name!r} is declared twice", "choose another name")

    def _bad(self, why: str, remedy: str) -> BadClaimsFile:
        """Return an error; a file name and line at the start of `why` become its location."""
        found = re.match(rf"({re.escape(self.name)}(?::[0-9]+)?), ", why)
        if found:
            return BadClaimsFile(found[1], why[found.end() :], remedy)
        return BadClaimsFile(self.name, why, remedy)


@dataclass(frozen=True)
class _Read:
    """The entries of a claim, with its equation as text and as expressions."""

    given: Mapping[str, Any]
    where: str
    text: str
    left: Expr
    relation: Relation
    right: Expr
    through: tuple[Expr, Expr] | None = None


@cache
def _own_body(profile: str, units: tuple[tuple[str, str], ...]) -> Body:
    """Return a body whose profile is text in the claims file, which is never executed."""
    return Body(draft(Wanted("own_body", profile, units=dict(units))).geometry)


def _formula_of(said: object) -> str:
    """Return the formula of a symbol as text; empty if it is not defined yet."""
    text = said.get("is", "") if isinstance(said, dict) else said
    return str(text).strip()


def _is_defined(read: "_Read", meant: Meant) -> bool:
    """Whether one side is a symbol and the file defines it by the other side."""
    if read.given.keys() & {"given", "through", "allowed"}:
        return False
    for one, other in ((read.left, read.right), (read.right, read.left)):
        if one in meant.ours:
            words = meant.needs[one.name] | {one.name}
            table = {s: expr for s, expr in meant.written.items() if s.name in words}
            if one.xreplace(table) == other.xreplace(table):
                return True
    return False


def _may_be_rough(given: Mapping[str, Any], text: str) -> bool:
    """Whether an equation may use ~, because it has a limit or a rounded constant."""
    return bool(given.keys() & {"as", "leading"}) or may_be_rounded(text)


def _no_meaning(names: list[str]) -> str:
    listed = ", ".join(names)
    if len(names) > 1:
        return f"the symbols {listed} have no meaning: define them in [symbols] or [variables]"
    return f"the symbol {listed} has no meaning: define it in [symbols] or [variables]"


def _lacking(
    given: Mapping[str, Any], common: dict[str, Any], names: list[str], meant: Meant
) -> Claim:
    """Return an unchecked claim, because some of its symbols have no meaning."""
    why = _no_meaning([*dict.fromkeys(meant.lacks.get(name, name) for name in names)])
    if wrong := next((name for name in names if name in meant.wrong), ""):
        told = _reason(meant.wrong[wrong], None)
        why = f"the symbol {wrong} has no meaning in this claim: {told}"
    printed = given.get("understood", given.get("printed", ""))
    return Claim(unchecked=why, source=str(printed), **common)


def _known(context: Context, put: Put) -> dict[str, Expr]:
    """Return the variables and the symbols that an equation may hold, by name."""
    return {**context.variables, **{symbol.name: symbol for symbol in put.meaning}}


def _reading(names: Names, put: Put, text: str) -> tuple[Expr, Expr] | None:
    """Read an equation with the same calls as the printed one; None if it has others."""
    try:
        left, _, right = equation(text, names, rough=True)
    except BadFormula:
        return None
    left, right = put.without_calls(left), put.without_calls(right)
    return None if calls_in(left, right) else (left, right)


def _names_in(read: "_Read") -> set[Symbol]:
    """Return the names in an equation, except the variables of integrals and limits."""
    sides = read.left, read.right
    along = {over.limits[-1][0] for over in integrals(*sides)}
    along |= {each.args[1] for side in sides for each in side.atoms(Limit, *IMPROPER)}
    return set().union(*(side.atoms(Symbol) for side in sides)) - along


def _variables(left: Expr, right: Expr, meaning: Meaning) -> set[Symbol]:
    """Return the variables in both sides or in the meanings of their symbols."""
    held = left.free_symbols | right.free_symbols
    return set().union(*(meaning.get(symbol, symbol).free_symbols for symbol in held))


def _inside(left: Expr, right: Expr, meaning: Meaning) -> set[Symbol]:
    """Return the variables of integration on which neither side depends."""
    along = {over.limits[-1][0] for over in integrals(left, right)}
    table = dict(meaning)
    return along - left.xreplace(table).free_symbols - right.xreplace(table).free_symbols


def _places(held: set[Symbol]) -> dict[Symbol, Range]:
    """Return the default range of positions, which is symmetric about zero."""
    return {place: SIGNED for place in PLACES.values() if place in held}


def _is_bound(given: object) -> TypeGuard[float]:
    return isinstance(given, int | float) and abs(given) < _FAR


_FAR = 1e6
"""The bounds of a variable's range must be smaller than this in magnitude."""


def _texts(data: object) -> Iterator[str]:
    """Yield all keys and texts of a file, at any nesting depth."""
    left = [data]
    while left:
        each = left.pop()
        if isinstance(each, str):
            yield each
        elif isinstance(each, Mapping):
            yield from each
            left += each.values()
        elif isinstance(each, list):
            left += each


def _reason(error: UserError, where: str | None) -> str:
    """Describe an error of one claim, or of its symbols, in one line without its location."""
    if isinstance(error, BadFormula):
        place = error.where.removeprefix(where).lstrip(": ") if where else ""
        rest = " ".join(error.given[error.column :].split())
        at = f"at {_cut(rest)}" if rest else "at the end"
        return f"{place}{': ' * bool(place)}{error.why}, {at}: {error.remedy}"
    if isinstance(error, BadClaimsFile):
        label = where.partition(", ")[2] if where else ""
        return f"{error.why.removeprefix(label).lstrip(': ')}: {error.remedy}"
    return error.message


def _cut(text: str) -> str:
    return text if len(text) <= _SHOWN else f"{text[:_SHOWN]}..."


_SHOWN = 30
"""The largest number of characters of a formula that a reason shows."""


def _shown(entry: object) -> str:
    return " and ".join(map(str, entry)) if isinstance(entry, list) else str(entry)


def _usual(names: Names) -> dict[str, str]:
    r"""Return the usual LaTeX of names: a_{1} for a_1, \alpha for alpha, \alpha_0 for alpha_0."""
    found = {}
    for name in names.symbols:
        stem, _, index = name.partition("_")
        letter = stem if len(stem) == 1 else rf"\{stem}"
        if index:
            found[f"{letter}_{{{index}}}"] = name
            if len(index) == 1:
                found[f"{letter}_{index}"] = name
        else:
            found[letter] = name
    return found
