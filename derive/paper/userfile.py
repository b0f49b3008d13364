"""A claims file in TOML: data only, of which nothing is ever executed.

    title = "..."
    seconds = 30                      # that the verdict on a claim, then its mending, may take
    body = "hertz"                    # whose sheet's formulas may be called, load(a, c) say

    [variables]                       # drawn at random; all else is written in them
    l = "half-width"                  # positive
    mu = { meaning = "x/l", low = -0.9, high = 0.9 }

    [symbols]                         # what the source's symbols are
    P = "load(l, l)"

    [latex]                           # spellings, where they are not the names
    "E^*" = "E_star"

    [[claims]]
    label = "half-width"
    place = "eq. (3)"
    printed = "a**2 = 4*P*R/(pi*E_star)"       # or latex = '...' and understood = "..."
    part = 1                                   # which statement of a display in LaTeX
    accepted = true                            # false in a draft: nobody has accepted it yet
    expected = "fails"                         # if it is known
    symbols = { M = "-moment(l, l)" }          # for this claim alone
    conventions = [{ what = "...", symbols = { ... }, contradicts = "..." }]

The body's parameters, E_star and f are variables from the start; x, s and xi are places, drawn on
both sides of zero where [variables] gives them no range of their own.
"""

import re
import tomllib
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any, TypeGuard, TypeVar

from sympy import Expr, Integral, Symbol
from sympy.core.function import AppliedUndef

from derive.derivation import derive_sheet
from derive.errors import BadClaimsFile, NotAccepted, UserError
from derive.library import is_in_library, library
from derive.limit import LimitReached, within
from derive.paper.bodies import at, formula
from derive.paper.claim import (
    SCALE,
    SIGNED,
    Claim,
    Convention,
    Meaning,
    Paper,
    Range,
    Verdict,
)
from derive.paper.formula import Names, UnknownName, equation, unknown, usable
from derive.paper.formula import formula as read_formula
from derive.paper.latex import Latex
from derive.paper.lines import heads, line_of
from derive.paper.mistakes import demand_none
from derive.paper.statements import statements
from derive.sheet import FormulaSheet
from derive.symbols import E_star, M, P, e, f, x

Read = TypeVar("Read")

_LARGEST = 200_000
"""Bytes of a claims file."""
_MOST = 500
"""Claims of a file."""
_SECONDS = 30.0
"""Seconds that the verdict on a claim may take, and then the search for a correction."""
_MOST_SECONDS = 86_400
_PLACES = {"x": x, "s": Symbol("s", real=True), "xi": Symbol("xi", real=True)}
_KEYS = frozenset({"title", "seconds", "body", "variables", "symbols", "latex", "claims"})
_OF_A_PROPOSAL = frozenset({"meaning", "proposal"})
_OF_A_VARIABLE = frozenset({"meaning", "low", "high"})
_OF_A_CONVENTION = frozenset({"what", "symbols", "contradicts"})
_OF_A_CLAIM = (
    frozenset(("label", "place", "says", "printed", "latex", "understood", "expected", "symbols"))
    | {"part", "accepted"}
    | {"conventions", "unchecked"}
)


@dataclass(frozen=True)
class Reading:
    """LaTeX whose reading the file does not accept yet.

    number  of the claim in the file, from 1
    """

    number: int
    label: str
    latex: str
    understood: str
    accepted: str


def read_claims(path: Path) -> Paper:
    """The claims of a file.

    Raises BadClaimsFile or BadFormula, and Mistakes where there are several.  A claim that lacks
    something, an accepted reading or the meaning of a symbol, is there as unchecked.
    """
    return _file(path).paper()


def open_readings(path: Path) -> list[Reading]:
    """Readings that wait for a person; raises as `read_claims`."""
    file = _file(path)
    file.paper()
    return file.readings


def _file(path: Path) -> "_File":
    text, data = source(path)
    return _File(str(path), data, text)


def source(path: Path) -> tuple[str, dict[str, Any]]:
    """A claims file as text and as data; raises BadClaimsFile."""
    remedy = "give a claims file as in examples/cattaneo_mindlin.toml"
    try:
        if path.stat().st_size > _LARGEST:
            raise BadClaimsFile(str(path), f"is larger than {_LARGEST} bytes", "split it")
        text = path.read_bytes().decode("utf-8-sig")
        return text, tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise BadClaimsFile(str(path), f"is no TOML ({error})", remedy) from error
    except UnicodeDecodeError as error:
        raise BadClaimsFile(str(path), "is no text in UTF-8", remedy) from error
    except (OSError, ValueError, RecursionError) as error:
        why = getattr(error, "strerror", None) or str(error)
        raise BadClaimsFile(str(path), f"cannot be read ({why})", remedy) from error


@dataclass
class _File:
    """A claims file as it is read; mistakes are noted, and told together at the end."""

    name: str
    data: Mapping[str, Any]
    text: str = ""
    ranges: dict[Symbol, Range] = field(default_factory=dict)
    variables: dict[str, Expr] = field(default_factory=dict)
    mistakes: list[UserError] = field(default_factory=list)
    readings: list[Reading] = field(default_factory=list)

    def paper(self) -> Paper:
        """All claims."""
        for text in _texts(self.data):
            if not text.replace("\n", "").replace("\t", "").isprintable():
                self.mistakes.append(
                    self._bad(f"{text!r} holds a control character", "leave it out")
                )
        demand_none(self.mistakes)
        self._demand_known(self.data, _KEYS, "the file")
        self.sheet, self.seconds = None, _SECONDS
        with self._noted():
            self.sheet = self._sheet()
        with self._noted():
            self.seconds = self._limit()
        self.variables = {**_PLACES, "E_star": E_star, "f": f, **self._parameters()}
        with self._noted():
            for name, said in self._table("variables").items():
                with self._noted():
                    self._declare(name, said)
        self._read_symbols()
        claims = self._claims()
        demand_none(self.mistakes)
        return Paper(str(self.data.get("title", self.name)), claims)

    @contextmanager
    def _noted(self) -> Iterator[None]:
        """A block that is left at its first mistake, which is told in the end."""
        try:
            yield
        except UserError as error:
            self.mistakes.append(error)

    def _read_symbols(self) -> None:
        """[symbols] and [latex], each mistake in them once; those left empty wait for a person."""
        self.symbols, self.common = dict[str, Any](), dict[Symbol, Expr]()
        with self._noted():
            self.symbols = self._table("symbols")
        for name, text in self.symbols.items():
            with self._noted():
                line = line_of(self.text, "symbols", name)
                where = f"{self.name}:{line}" if line else self.name
                self._demand_name(name, ())
                if name in self._parameters():
                    why = f"{where}, the symbol {name!r} is a parameter of the body already"
                    raise self._bad(why, "leave it out, or name the parameter's symbol otherwise")
                self.common.update(self._meaning(f"{where}, symbols", {name: text}))
        with self._noted():
            self._spellings(self._names(self.name, self.symbols))

    def _claims(self) -> tuple[Claim, ...]:
        given = self.data.get("claims", [])
        if not isinstance(given, list) or not given or len(given) > _MOST:
            self.mistakes.append(self._bad("has no [[claims]]", f"write one to {_MOST} of them"))
            return ()
        lines = heads(self.text, len(given))
        made, labels = list[Claim](), set[str]()
        for number, each in enumerate(given, start=1):
            at = f"{self.name}:{lines[number - 1]}" if lines else self.name
            with self._noted():
                claim = self._claim(number, each, at)
                if claim.label in labels:
                    label = claim.label
                    raise self._bad(f"{at}, two claims have the label {label!r}", "name each once")
                labels.add(claim.label)
                made.append(claim)
        return tuple(made)

    def _sheet(self) -> FormulaSheet | None:
        from derive.library import load_geometry

        body = self.data.get("body")
        if body is None:
            return None
        if not isinstance(body, str) or not is_in_library(body):
            known = ", ".join(library())
            raise self._bad(f"body = {body!r} is not in the library", f"name one of {known}")
        return derive_sheet(load_geometry(body))

    def _limit(self) -> float:
        given = self.data.get("seconds", _SECONDS)
        if type(given) not in (int, float) or not 0 < given <= _MOST_SECONDS:
            remedy = f"write a number above 0, at most {_MOST_SECONDS}"
            raise self._bad(f"seconds = {given!r} is no limit in time", remedy)
        return float(given)

    def _in_time(self, where: str, read: Callable[[], Read]) -> Read:
        """What comes of reading a text; raises BadClaimsFile where it takes too long."""
        try:
            with within(self.seconds):
                return read()
        except LimitReached:
            why = f"{where} is not read within {self.seconds:g} s"
            raise self._bad(why, "write it plainer, or raise seconds") from None
        except RecursionError:
            raise self._bad(f"{where} is nested too deep", "write it plainer") from None

    def _parameters(self) -> dict[str, Expr]:
        if self.sheet is None:
            return {}
        return {q.name: q.symbol for q in self.sheet.geometry.parameters}

    def _declare(self, name: str, said: object) -> None:
        line = line_of(self.text, "variables", name)
        where = f"{self.name}:{line}, variable {name!r}" if line else f"variable {name!r}"
        self._demand_name(name, self.variables.keys() - _PLACES.keys())
        if isinstance(said, str):
            self._drawn(name, SCALE, positive=True)
            return
        given: dict[str, Any] = said if isinstance(said, dict) else {}
        self._demand_known(given, _OF_A_VARIABLE, where)
        low, high = given.get("low"), given.get("high")
        if not (_is_bound(low) and _is_bound(high)) or low >= high:
            raise self._bad(f"{where} has no range", "write { low = 0.1, high = 0.9 }, or a text")
        self._drawn(name, Range(float(low), float(high)), positive=low >= 0)

    def _drawn(self, name: str, span: Range, positive: bool) -> None:
        """A variable with where it is drawn; a place stays the sheet's own symbol."""
        known = Symbol(name, positive=True) if positive else Symbol(name, real=True)
        symbol = _PLACES.get(name, known)
        self.variables[name] = symbol
        if span != SCALE or name in _PLACES:
            self.ranges[symbol] = span

    def _claim(self, number: int, given: object, at: str) -> Claim:
        if not isinstance(given, dict):
            raise self._bad(f"{at}, claim {number} is no table", "write [[claims]] before each")
        label = self._text(given, "label", f"{at}, claim {number}")
        where = f"{at}, claim {label!r}"
        self._demand_known(given, _OF_A_CLAIM, where)
        common: dict[str, Any] = {
            "label": label,
            "place": str(given.get("place", Path(self.name).name)),
            "says": str(given.get("says", label)),
        }
        with self._noted():
            common["expected"] = self._verdict(given, where)
        if "unchecked" in given:
            told = str(given.get("understood", given.get("printed", "")))
            return Claim(unchecked=self._text(given, "unchecked", where), source=told, **common)
        own = self._inner(given, "symbols", where)
        symbols = {**self.symbols, **own}
        names = self._names(where, symbols)
        try:
            left, relation, right = self._in_time(
                where, lambda: equation(self._printed(given, where, names), names)
            )
        except NotAccepted as error:
            return self._waiting(number, given, common, error)
        except UnknownName as error:
            missing = unknown(error.given, names) or ["a name"]
            return _lacking(given, common, missing)
        lacking = [n for n in symbols if _awaits(symbols[n]) and _held(n, left, right)]
        if lacking:
            return _lacking(given, common, lacking)
        meaning = {**self.common, **self._meaning(where, own)}
        named = {call: Symbol(str(call)) for call in _calls(left, right)}
        spread_out = any(_calls_along(over) for over in _integrals(left, right))
        left, right = (self._without_calls(side, named, meaning) for side in (left, right))
        called = {**meaning, **self._called(named, meaning)}
        self._demand_bound(where, left, right, called)
        self._demand_single(where, left, right, called)
        held = _variables(left, right, called)
        return Claim(
            left=left,
            right=right,
            relation=relation,
            meaning=called,
            against=f"the formulas of {self.name}"
            + (f" and the sheet of {self.sheet.geometry.name}" if self.sheet else ""),
            ranges=_places(held) | {s: r for s, r in self.ranges.items() if s in held},
            conventions=self._conventions(given, where, named, meaning),
            source=self._text(given, "printed", where) if spread_out else "",
            seconds=self.seconds,
            swaps=tuple(Symbol(name) for name in symbols if _held(name, left, right)),
            **common,
        )

    def _waiting(
        self, number: int, given: Mapping[str, Any], common: dict[str, Any], error: NotAccepted
    ) -> Claim:
        """A claim whose reading nobody has accepted."""
        self.readings.append(
            Reading(number, common["label"], given["latex"], error.understood, error.accepted)
        )
        said = f"the file accepts {error.accepted}" if error.accepted else "nobody has accepted it"
        by_hand = "accepted = true"
        if given.get("accepted") is not False:
            by_hand = f'understood = "{error.understood}"'
        why = (
            f"the LaTeX was understood as {error.understood}, and {said}: see it with --accept, "
            f"or write {by_hand}"
        )
        return Claim(unchecked=why, source=error.understood, **common)

    def _names(self, where: str, symbols: Mapping[str, Any]) -> Names:
        """What a printed equation may hold: the source's symbols, and the variables."""
        for name in symbols:
            self._demand_name(name, ())
        known = {**self.variables, **{name: Symbol(name) for name in symbols}}
        return Names(where, known, self._arities())

    def _arities(self) -> dict[str, int]:
        """The body's formulas, with how many arguments each takes."""
        return {name: len(known.arguments) for name, known in (self.sheet or {}).items()}

    def _printed(self, given: Mapping[str, Any], where: str, names: Names) -> str:
        if ("printed" in given) == ("latex" in given):
            raise self._bad(f"{where} has not one of printed and latex", "give one of them")
        if "printed" in given:
            return self._text(given, "printed", where)
        spellings = {**{n: n for n in names.symbols}, **_usual(names), **self._spellings(names)}
        latex = self._part(given, where)
        understood = Latex(where, latex, spellings).understood()
        accepted = str(given.get("understood", ""))
        if given.get("accepted") is False:
            raise NotAccepted(where, understood, "")
        if not accepted or equation(accepted, names) != equation(understood, names):
            raise NotAccepted(where, understood, accepted)
        return accepted

    def _part(self, given: Mapping[str, Any], where: str) -> str:
        """The LaTeX of a claim: all of it, or one statement of a display."""
        latex = self._text(given, "latex", where)
        if "part" not in given:
            return latex
        found, part = statements(where, latex), given["part"]
        if type(part) is not int or not 1 <= part <= len(found):
            why = f"{where}: part = {part!r} is no statement of this display"
            raise self._bad(why, f"write a number from 1 to {len(found)}")
        return found[part - 1].latex

    def _spellings(self, names: Names) -> dict[str, str]:
        found = self._table("latex")
        for spelling, name in found.items():
            if not isinstance(name, str) or name not in names.symbols:
                why = f"[latex] {spelling!r} = {name!r} is no declared name"
                raise self._bad(why, "declare it")
        return found

    def _meaning(self, where: str, symbols: Mapping[str, Any]) -> Meaning:
        names = Names(where, self.variables, self._arities())
        return {
            Symbol(name): self._put_in(
                self._in_time(f"{where}: {name}", partial(read_formula, str(text), names))
            )
            for name, text in symbols.items()
            if not _awaits(text)
        }

    def _stands_for(self, call: Expr, meaning: Meaning) -> Expr:
        """A call of a formula, what its arguments mean put in, written out."""
        return self._put_in(call.xreplace(dict(meaning)))

    def _called(self, named: Mapping[Expr, Symbol], meaning: Meaning) -> Meaning:
        """What the calls of a printed equation stand for, which are symbols in it."""
        return {symbol: self._stands_for(call, meaning) for call, symbol in named.items()}

    def _without_calls(self, side: Expr, named: Mapping[Expr, Symbol], meaning: Meaning) -> Expr:
        """A printed side with calls as symbols; put in where they change along an integral."""
        for over in _integrals(side):
            table = {call: self._stands_for(call, meaning) for call in _calls_along(over)}
            inside = Integral(over.function.xreplace(table), *over.limits)
            side = side.xreplace({over: inside})
        return side.xreplace(dict(named))

    def _demand_bound(self, where: str, left: Expr, right: Expr, meaning: Meaning) -> None:
        """No variable of integration that means something outside its integral, places apart."""
        held = _variables(left, right, meaning)
        meant = (meaning[s] for s in left.free_symbols | right.free_symbols if s in meaning)
        for over in _integrals(left, right, *meant):
            along = over.limits[0][0]
            if along in _PLACES.values() or along not in held | meaning.keys():
                continue
            why = f"{where}: {along} is a variable of integration and also used outside"
            raise self._bad(why, "integrate along another letter, s or xi")

    def _demand_single(self, where: str, left: Expr, right: Expr, meaning: Meaning) -> None:
        """No integral inside another, once the symbols are put in."""
        for side in (left, right):
            for over in side.xreplace(dict(meaning)).atoms(Integral):
                inside = [over.function, *over.limits[0][1:]]
                if len(over.limits) > 1 or any(part.has(Integral) for part in inside):
                    why = f"{where}: an integral inside an integral is not computed"
                    raise self._bad(why, "do one of them by hand")

    def _put_in(self, expr: Expr) -> Expr:
        """Calls of the sheet's formulas replaced by what they stand for, each proven."""
        while calls := expr.atoms(AppliedUndef):
            call = min(calls, key=lambda c: (len(str(c)), str(c)))
            assert self.sheet is not None
            sheet = self.sheet[call.func.__name__]
            body = formula(self.sheet.geometry.name, sheet.name).xreplace({e: M / P})
            table = dict(zip(sheet.arguments, call.args, strict=True))
            expr = expr.xreplace({call: at(body.subs(table, simultaneous=True), *_EDGES)})
        return expr

    def _conventions(
        self,
        given: Mapping[str, Any],
        where: str,
        named: Mapping[Expr, Symbol],
        meaning: Meaning,
    ) -> tuple[Convention, ...]:
        made = []
        listed = given.get("conventions", [])
        if not isinstance(listed, list):
            raise self._bad(f"{where}: conventions is no list", "write [{ what = ... }]")
        for each in listed:
            if not isinstance(each, dict):
                raise self._bad(f"{where}: a convention is no table", "write { what = ... }")
            self._demand_known(each, _OF_A_CONVENTION, f"{where}: a convention")
            what = self._text(each, "what", where)
            against = self._text(each, "contradicts", where)
            symbols = self._inner(each, "symbols", where)
            other = self._meaning(where, symbols)
            other = {**other, **self._called(named, {**meaning, **other})}
            made.append(Convention(what, other, against))
        return tuple(made)

    def _verdict(self, given: Mapping[str, Any], where: str) -> Verdict | None:
        if "expected" not in given:
            return None
        try:
            return Verdict(given["expected"])
        except ValueError:
            known = ", ".join(Verdict)
            raise self._bad(
                f"{where}: expected = {given['expected']!r} is no verdict", f"write one of {known}"
            ) from None

    # -------------------------------------------------------------- reading the data

    def _table(self, key: str) -> dict[str, Any]:
        return self._inner(self.data, key, "the file")

    def _inner(self, data: Mapping[str, Any], key: str, where: str) -> dict[str, Any]:
        found = data.get(key, {})
        if not isinstance(found, dict):
            raise self._bad(f"{key} of {where} is no table", f"write [{key}] and names below it")
        return found

    def _text(self, data: Mapping[str, Any], key: str, where: str) -> str:
        found = data.get(key)
        if not isinstance(found, str) or not found.strip():
            raise self._bad(f"{where} has no {key}", f'write {key} = "..."')
        return found

    def _demand_known(self, data: Mapping[str, Any], known: frozenset[str], where: str) -> None:
        for key in data:
            if key not in known:
                allowed = ", ".join(sorted(known))
                why = f"{where} has {key!r}, which means nothing here"
                self.mistakes.append(self._bad(why, f"known: {allowed}"))

    def _demand_name(self, name: str, taken: object) -> None:
        if not usable(name):
            raise self._bad(f"{name!r} cannot be a name", "use letters, digits and _")
        if name in taken:  # type: ignore[operator]
            raise self._bad(f"{name!r} is declared twice", "choose another name")

    def _bad(self, why: str, remedy: str) -> BadClaimsFile:
        """A mistake at the place that its text begins with: the file, and a line if it is known."""
        found = re.match(rf"({re.escape(self.name)}(?::[0-9]+)?), ", why)
        if found:
            return BadClaimsFile(found[1], why[found.end() :], remedy)
        return BadClaimsFile(self.name, why, remedy)


def _awaits(meaning: object) -> bool:
    """Whether a symbol has no meaning yet."""
    return meaning == "" or (isinstance(meaning, dict) and meaning.keys() <= _OF_A_PROPOSAL)


def _lacking(given: Mapping[str, Any], common: dict[str, Any], names: list[str]) -> Claim:
    """A claim with symbols of which nobody has said what they are."""
    listed = ", ".join(names)
    why = f"nothing says what {listed} is: write it in [symbols] or [variables]"
    if len(names) > 1:
        why = f"nothing says what {listed} are: write it in [symbols] or [variables]"
    printed = given.get("understood", given.get("printed", ""))
    return Claim(unchecked=why, source=str(printed), **common)


_EDGES = (Symbol("a", real=True), Symbol("c", real=True))


def _variables(left: Expr, right: Expr, meaning: Meaning) -> set[Symbol]:
    """What both sides, or what their symbols stand for, depend on; some may cancel in the end."""
    held = left.free_symbols | right.free_symbols
    return set().union(*(meaning.get(symbol, symbol).free_symbols for symbol in held))


def _integrals(*exprs: Expr) -> list[Integral]:
    return sorted({over for expr in exprs for over in expr.atoms(Integral)}, key=str)


def _calls(*exprs: Expr) -> list[Expr]:
    """Calls of the sheet's formulas."""
    return sorted({call for expr in exprs for call in expr.atoms(AppliedUndef)}, key=str)


def _calls_along(over: Integral) -> list[Expr]:
    """Calls under an integral that change along it."""
    return [call for call in _calls(over.function) if call.has(over.limits[0][0])]


def _places(held: set[Symbol]) -> dict[Symbol, Range]:
    """Places that nobody gave a range are drawn on both sides of zero."""
    return {place: SIGNED for place in _PLACES.values() if place in held}


def _is_bound(given: object) -> TypeGuard[float]:
    return isinstance(given, int | float) and abs(given) < _FAR


_FAR = 1e6
"""Bound of a variable's range."""


def _texts(data: object) -> Iterator[str]:
    """All keys and texts of a file."""
    if isinstance(data, str):
        yield data
    elif isinstance(data, Mapping):
        for key, value in data.items():
            yield key
            yield from _texts(value)
    elif isinstance(data, list):
        for each in data:
            yield from _texts(each)


def _held(name: str, *sides: Expr) -> bool:
    return any(side.has(Symbol(name)) for side in sides)


def _usual(names: Names) -> dict[str, str]:
    r"""How a name is usually spelled: a_1 as a_{1}, alpha as \alpha, alpha_0 as \alpha_0."""
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
