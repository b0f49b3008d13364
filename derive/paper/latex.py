r"""Reads an equation given as LaTeX, if it can be read in one way only.

LaTeX is no formula: `f(x)` may be a call or a product, and a parser that must not fail guesses.
So the text is first cut into symbols that the claims file declares, numbers, and a few commands;
everything else is refused where it stands.  A declared symbol is never a function.  A product
without a sign gets one, except where it may stand below a slash; braces that do not print hold one
factor at most; where the argument of a function, a sum or an integral ends must be plain from the
print.  What comes out is text for derive.paper.formula, term by term in the order of the print, so
that a person can hold one against the other; the claims file must accept it.
"""

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import NoReturn

from derive.errors import BadFormula
from derive.paper.claim import Relation

_LONGEST = 2000
"""Characters that an equation may have."""
_DEEPEST = 60
"""Groups inside each other."""

_TOKEN = re.compile(
    r"\\(?:begin|end)\s*\{[A-Za-z]+\*?\}|\\[A-Za-z]+|\\.|[0-9]+(?:\.[0-9]+)?|[A-Za-z]"
    r"|[-+*/=<>()\[\]{}^_|']|\s+|.",
    re.DOTALL,
)
_SPACES = frozenset((r"\,", r"\;", r"\:", r"\!", r"\ ", r"\quad", r"\qquad", r"\left", r"\right"))
_FUNCTIONS = {
    rf"\{name}": name for name in ("sin", "cos", "tan", "sinh", "cosh", "tanh", "exp", "log")
} | {
    r"\arcsin": "asin",
    r"\arccos": "acos",
    r"\arctan": "atan",
    r"\ln": "log",
    r"\sgn": "sign",
    r"\cot": "1/tan",
    r"\sec": "1/cos",
    r"\csc": "1/sin",
    r"\max": "Max",
    r"\min": "Min",
    r"\Gamma": "gamma_function",
}
_OF_SEVERAL = frozenset((r"\max", r"\min"))
_INVERSES = {r"\sin": "asin", r"\cos": "acos", r"\tan": "atan"} | {
    rf"\{name}": f"a{name}" for name in ("sinh", "cosh", "tanh")
}
_FRACTIONS = (r"\frac", r"\dfrac", r"\tfrac", r"\cfrac", r"\nicefrac")
_INTEGRALS = {r"\int": "integral", r"\pvint": "pv"}
_BIG = (*_INTEGRALS, r"\sum", r"\lim")
_CASES, _ENDCASES = r"\begin{cases}", r"\end{cases}"
_WORDS = frozenset((r"\whereword", r"\andword", r"\caserow", r"\casecol"))
_COMMANDS = frozenset(
    (*_FUNCTIONS, *_FRACTIONS, *_BIG, *_WORDS, _CASES, _ENDCASES, r"\sqrt", r"\cdot", r"\times")
) | {r"\dd", "_", ",", r"\to", r"\rightarrow", r"\infty"}
_CLOSING = {"(": ")", "{": "}", "[": "]", _CASES: _ENDCASES}
_ENDS = frozenset(("+", "-", ")", "}", "]", "|", ",", r"\dd", _ENDCASES, *_WORDS))
"""What may follow the argument of a function."""
_OPERATORS = {"*": "*", "/": "/", r"\cdot": "*", r"\times": "*"}
_AFTER_BRACKETS = frozenset((*_OPERATORS, *_FUNCTIONS, *_FRACTIONS, r"\sqrt"))
"""What may, too, where parentheses show the end of the argument."""
_PLAIN = frozenset("-+*/(){}^|[]")
_RELATIONS = {
    "=": "=",
    "<": "<",
    ">": ">",
    r"\le": "<=",
    r"\leq": "<=",
    r"\leqslant": "<=",
    r"\ge": ">=",
    r"\geq": ">=",
    r"\geqslant": ">=",
    **dict.fromkeys((r"\sim", r"\simeq", r"\approx", r"\cong"), "~"),
}
_SUM, _PRODUCT, _POWER, _ATOM = range(4)


@dataclass(frozen=True)
class _Piece:
    """A declared symbol, a number, or a token of LaTeX, with its column.

    size: of how many tokens it is made; TeX takes one where there are no braces.
    """

    text: str
    column: int
    size: int = 1

    @property
    def is_mark(self) -> bool:
        """Whether it is a symbol or a number."""
        return self.text.startswith("=") and self.text != "="

    @property
    def is_number(self) -> bool:
        """Whether it is a number."""
        return self.is_mark and self.text[1].isdigit()


@dataclass(frozen=True)
class _Code:
    """A piece of text, and how closely what is in it is bound together."""

    text: str
    level: int

    def at(self, level: int) -> str:
        """The text for a place that binds as closely as `level`."""
        return self.text if self.level >= level else f"({self.text})"


@dataclass(frozen=True)
class Latex:
    """A LaTeX equation of one claim.

    where      for messages
    text       as it stands in the source
    spellings  LaTeX of a symbol -> its name in the claims file
    """

    where: str
    text: str
    spellings: Mapping[str, str]

    def understood(self) -> str:
        """The equation as text; raises BadFormula where it cannot be read in one way only."""
        sides, between = self._sides()
        if len(between) != 1:
            column = between[1].column if between else len(self.text)
            why = "there are two relations here" if between else "there is no relation here"
            raise self.refusal(column, why, "give one equation, with one relation")
        return f"{sides[0]} {Relation(_RELATIONS[between[0].text])} {sides[1]}"

    def condition(self) -> str:
        """A chain of relations as text, such as -a < x < c; raises BadFormula."""
        sides, between = self._sides()
        if not between:
            raise self.refusal(0, "this is no condition", "write it as text")
        signs = [_RELATIONS[each.text] for each in between]
        return sides[0] + "".join(f" {s} {side}" for s, side in zip(signs, sides[1:], strict=True))

    def approach(self) -> str:
        r"""What goes where, as c - x -> 0 for c-x \to 0; raises BadFormula."""
        pieces = self._pieces()
        at = [n for n, piece in enumerate(pieces) if piece.text in (r"\to", r"\rightarrow")]
        if len(at) != 1:
            raise self.refusal(0, "this is no limit", "write it as text")
        sides = (pieces[: at[0]], pieces[at[0] + 1 :])
        return " -> ".join(self.side(part, len(self.text)).text for part in sides)

    def _sides(self) -> tuple[list[str], list[_Piece]]:
        parts, between = _divided(self._pieces(), _RELATIONS)
        ends = [each.column for each in between] + [len(self.text)]
        for part in parts if len(between) == 1 else ():
            self._demand_plain(part)
        return [self.side(part, end).text for part, end in zip(parts, ends, strict=True)], between

    def _pieces(self) -> list[_Piece]:
        if len(self.text) > _LONGEST:
            raise self.refusal(_LONGEST, "the equation is too long", f"stay below {_LONGEST}")
        return self._braced(self._marked())

    def side(self, pieces: list[_Piece], end: int, depth: int = 0) -> _Code:
        """One side, or what stands in a group, as text."""
        if depth > _DEEPEST:
            raise self.refusal(end, "this is nested too deep", "write it plainer")
        return _Side(self, pieces, end, depth).whole()

    def _marked(self) -> list[_Piece]:
        """The tokens, every declared symbol and number as one."""
        pieces = [
            _Piece(found.group(), found.start())
            for found in _TOKEN.finditer(self.text)
            if not found.group().isspace() and found.group() not in _SPACES
        ]
        marked, place = [], 0
        integrates = any(piece.text in _INTEGRALS for piece in pieces)
        while place < len(pieces):
            if integrates and pieces[place].text == r"\dd":
                marked.append(pieces[place])
                place += 1
                continue
            length, name = self._longest(pieces, place)
            if length:
                marked.append(_Piece(f"={name}", pieces[place].column, length))
                place += length
                continue
            marked.append(self._known(pieces[place]))
            place += 1
        return marked

    def _longest(self, pieces: list[_Piece], place: int) -> tuple[int, str]:
        """The longest declared symbol that starts here."""
        best = (0, "")
        for spelling, name in self._cut:
            length = len(spelling)
            if length > best[0] and [p.text for p in pieces[place : place + length]] == spelling:
                best = (length, name)
        return best

    @cached_property
    def _cut(self) -> list[tuple[list[str], str]]:
        """The tokens of every spelling."""
        return [
            ([t for t in _TOKEN.findall(spelling) if not t.isspace() and t not in _SPACES], name)
            for spelling, name in self.spellings.items()
        ]

    def _known(self, piece: _Piece) -> _Piece:
        text = re.sub(r"\s", "", piece.text)
        if text[0].isdigit():
            return _Piece(f"={text}", piece.column, len(text))
        if text in (r"\pi", r"\infty"):
            return _Piece("=pi" if text == r"\pi" else "=oo", piece.column)
        if text in _COMMANDS or text in _PLAIN or text in _RELATIONS:
            return _Piece(text, piece.column)
        why = f"{text} is no declared symbol and no command that is known here"
        remedy = "declare it under [latex], or write the claim as text"
        raise self.refusal(piece.column, why, remedy)

    def _braced(self, pieces: list[_Piece]) -> list[_Piece]:
        r"""The pieces with braces about what \frac and \sqrt take where there are none."""
        made, place = list[_Piece](), 0
        while place < len(pieces):
            head = pieces[place]
            made.append(head)
            place += 1
            if head.text in _FRACTIONS:
                place = self._arguments(pieces, place, made)
            elif head.text == r"\sqrt" and place < len(pieces) and _is_one(pieces[place]):
                made += _in_braces(pieces[place])
                place += 1
        return made

    def _arguments(self, pieces: list[_Piece], place: int, made: list[_Piece]) -> int:
        """Both arguments of a fraction put to what is made, and where they end."""
        wanted = 2
        while wanted and place < len(pieces):
            piece = pieces[place]
            if piece.text == "{":
                end = self.group(pieces, place)
                made += [piece, *self._braced(pieces[place + 1 : end - 1]), pieces[end - 1]]
                place, wanted = end, wanted - 1
                continue
            digits = piece.text[1:]
            if not _is_one(piece) and not (piece.is_number and wanted == len(digits) == 2):
                why = "what this fraction is of is unclear"
                raise self.refusal(piece.column, why, "put both of its parts into braces")
            for part in digits if piece.is_number else [digits]:
                made += _in_braces(_Piece(f"={part}", piece.column))
                wanted -= 1
            place += 1
        return place

    def group(self, pieces: list[_Piece], start: int) -> int:
        """Where the symbol, or the group in brackets, that starts here ends."""
        opened = pieces[start].text
        if opened not in _CLOSING:
            return start + 1
        depth = 0
        for place in range(start, len(pieces)):
            depth += pieces[place].text == opened
            depth -= pieces[place].text == _CLOSING[opened]
            if depth == 0:
                return place + 1
        raise self.refusal(pieces[start].column, "this is not closed", f"add {_CLOSING[opened]}")

    def _demand_plain(self, pieces: list[_Piece]) -> None:
        """No power, root or product that looks unlike what it says."""
        ends = _Piece("", len(self.text))
        for place, piece in enumerate(pieces):
            after = pieces[place + 1] if place + 1 < len(pieces) else ends
            if piece.text == "^":
                self._demand_exponent(pieces, place + 1, after)
            if piece.text == r"\sqrt" and after.text not in ("{", "[") and not _is_one(after):
                raise self.refusal(after.column, "where this root ends is unclear", "use braces")
            if piece.is_number and after.is_number and after.text != "=oo":
                why = "two numbers stand side by side"
                raise self.refusal(after.column, why, "put \\cdot between them")
            if piece.is_number and _is_number_over_number(pieces[place + 1 :]):
                why = "a number before a fraction of numbers may be a sum, as in 3 1/2"
                raise self.refusal(after.column, why, "put \\cdot or + between them")

    def _demand_exponent(self, pieces: list[_Piece], place: int, after: _Piece) -> None:
        if after.text != "{" and not _is_one(after):
            why = "TeX takes one character as the exponent where there are no braces"
            raise self.refusal(after.column, why, "put the exponent into braces")
        end = self.group(pieces, place)
        if end < len(pieces) and pieces[end].text == "^":
            why = "a power of a power without braces"
            raise self.refusal(pieces[end].column, why, "put one of them into braces")

    def refusal(self, column: int, why: str, remedy: str) -> BadFormula:
        """The error for what stands at a column."""
        return BadFormula(self.where, self.text, column, why, remedy)


class _Side:
    """Recursive descent through one side, or one group of it."""

    def __init__(self, latex: Latex, pieces: list[_Piece], end: int, depth: int) -> None:
        self.latex, self.pieces, self.end, self.depth = latex, pieces, end, depth
        self.place = 0

    def whole(self) -> _Code:
        """All of it."""
        made = self._sum()
        if self.place < len(self.pieces):
            self._unread()
        return made

    @property
    def here(self) -> _Piece:
        """The piece that is read next."""
        if self.place < len(self.pieces):
            return self.pieces[self.place]
        return _Piece("", self.end)

    def _inner(self, pieces: list[_Piece], end: int) -> _Code:
        return self.latex.side(pieces, end, self.depth + 1)

    def _group(self) -> list[_Piece]:
        """What stands in the group here, or the one piece; the place moves behind it."""
        start = self.place
        if start == len(self.pieces):
            self._unread()
        self.place = self.latex.group(self.pieces, start)
        found = self.pieces[start : self.place]
        return found[1:-1] if found[0].text in _CLOSING else found

    def _grouped(self) -> _Code:
        """The same as text."""
        inner = self._group()
        return self._inner(inner, self.pieces[self.place - 1].column)

    def _sum(self) -> _Code:
        text, level = "", _PRODUCT
        if self.here.text in ("+", "-"):
            text, level = self.here.text.strip("+"), _SUM
            self.place += 1
        term = self._product()
        text, level = text + term.at(_PRODUCT), min(level, term.level)
        if self.here.text not in ("+", "-"):
            return _Code(text, _SUM if text[0] == "-" else term.level)
        while self.here.text in ("+", "-"):
            sign = self.here.text
            self.place += 1
            text += f" {sign} {self._product().at(_PRODUCT)}"
        return _Code(text, _SUM)

    def _product(self) -> _Code:
        made, below = self._factor(), False
        while True:
            head = self.here
            operator = _OPERATORS.get(head.text, "")
            if operator:
                self.place += 1
                below = below or operator == "/"
            elif not self._starts_factor():
                return made
            elif below:
                why = "whether this stands below the slash is unclear"
                self._refuse(why, "write \\frac, or parentheses")
            factor = self._factor()
            operator = operator or "*"
            least = _POWER if operator == "/" else _PRODUCT
            made = _Code(f"{made.at(_PRODUCT)}{operator}{factor.at(least)}", _PRODUCT)

    def _starts_factor(self) -> bool:
        text = self.here.text
        if text == "|":
            return any(piece.text == "|" for piece in self.pieces[self.place + 1 :])
        starts = (*_CLOSING, r"\sqrt", *_FRACTIONS, *_FUNCTIONS, *_BIG)
        return self.here.is_mark or text in starts

    def _factor(self) -> _Code:
        """A factor with its power."""
        base = self._base()
        if self.here.text != "^":
            return base
        self.place += 1
        exponent = self._grouped()
        return _Code(f"{base.at(_ATOM)}**{exponent.at(_ATOM)}", _POWER)

    def _base(self) -> _Code:
        head = self.here
        if not self._starts_factor():
            if head.text == "|":
                raise self.latex.refusal(head.column, "this is not closed", "add |")
            if head.text in ("_", r"\dd"):
                self._refuse(f"{head.text} cannot stand here", "leave it out")
            self._unread()
        if head.is_mark:
            self.place += 1
            return _Code(head.text[1:], _ATOM)
        if head.text in _FUNCTIONS:
            return self._application()
        return self._readers[head.text](self)

    def _parenthesised(self) -> _Code:
        return self._grouped()

    def _in_braces(self) -> _Code:
        """Braces, which do not print: one factor stands in them."""
        column = self.here.column
        inner = self._group()
        side = _Side(self.latex, inner, self.pieces[self.place - 1].column, self.depth + 1)
        if self.depth > _DEEPEST:
            self._refuse("this is nested too deep", "write it plainer")
        starts = bool(inner) and (side._starts_factor() or inner[0].text == "|")
        made = side._factor() if starts else None
        if made is None or side.place != len(inner):
            raise self.latex.refusal(
                column, "braces do not print, and here they would matter", "use parentheses"
            )
        return made

    def _modulus(self) -> _Code:
        start, depth = self.place, 0
        for place in range(start + 1, len(self.pieces)):
            text = self.pieces[place].text
            depth += (text in _CLOSING) - (text in _CLOSING.values())
            if depth == 0 and text == "|":
                self.place = place + 1
                inner = self._inner(self.pieces[start + 1 : place], self.pieces[place].column)
                return _Code(f"abs({inner.text})", _ATOM)
        raise self.latex.refusal(self.pieces[start].column, "this is not closed", "add |")

    def _fraction(self) -> _Code:
        self.place += 1
        over = self._grouped()
        under = self._grouped()
        return _Code(f"{over.at(_PRODUCT)}/{under.at(_POWER)}", _PRODUCT)

    def _root(self) -> _Code:
        self.place += 1
        degree = self._grouped() if self.here.text == "[" else None
        inner = self._grouped()
        if degree is None:
            return _Code(f"sqrt({inner.text})", _ATOM)
        return _Code(f"{inner.at(_ATOM)}**(1/{degree.at(_POWER)})", _POWER)

    def _application(self) -> _Code:
        """A function with its argument."""
        head = self.here
        power, name = "", _FUNCTIONS[head.text]
        if head.text in _INVERSES and self._is_inverse():
            name = _INVERSES[head.text]
            self.place += 6
        else:
            self.place += 1
            power = self._power_of_function()
        if self.place == len(self.pieces):
            raise self.latex.refusal(self.end, f"{head.text} has no argument", "write it")
        inner = self._argument(head)
        over, _, name = name.rpartition("/")
        call = f"{name}({inner}){power}"
        return _Code(f"1/{call}", _PRODUCT) if over else _Code(call, _POWER if power else _ATOM)

    def _is_inverse(self) -> bool:
        after = [piece.text for piece in self.pieces[self.place + 1 : self.place + 6]]
        return after == ["^", "{", "-", "=1", "}"]

    def _power_of_function(self) -> str:
        """The power of a function that stands before its argument: a whole number from 2 on."""
        if self.here.text != "^":
            return ""
        column = self.here.column
        self.place += 1
        inner = self._group()
        digits = inner[0].text[1:] if len(inner) == 1 else ""
        if not digits.isdigit() or int(digits) < 2:
            why = "this power of a function may mean its inverse"
            raise self.latex.refusal(column, why, "write \\arcsin, or a fraction")
        return f"**{digits}"

    def _argument(self, head: _Piece) -> str:
        """The argument of a function; raises BadFormula where its end is unclear."""
        first, start = self.here, self.place
        if first.text in _FRACTIONS:
            text = self._fraction().text
        elif first.text == r"\sqrt":
            text = self._root().text
        elif first.text == "|":
            text = self._modulus().text
        elif first.text in ("(", "{", "[") or first.is_mark:
            inner = self._group()
            if first.text == "{" and any(piece.text in ("+", "-") for piece in inner):
                why = "braces do not print, so that this sum is not seen to be the argument"
                raise self.latex.refusal(first.column, why, "use parentheses")
            if not inner:
                raise self.latex.refusal(head.column, f"{head.text} has no argument", "write it")
            parts, _ = _divided(inner, {",": ","} if head.text in _OF_SEVERAL else {})
            end = self.pieces[self.place - 1].column
            text = ", ".join(self._inner(part, end).text for part in parts)
        else:
            raise self.latex.refusal(
                first.column, "this is no argument of a function", "add ( and )"
            )
        shown = self.pieces[start].text in ("(", "|", "[")
        allowed = _ENDS | _AFTER_BRACKETS if shown else _ENDS
        if self.here.text and self.here.text not in allowed:
            why = "where the argument of the function ends is unclear"
            remedy = "put the function and its argument into parentheses, as in (\\sin(a)) b"
            self._refuse(why, remedy)
        return text

    def _limits(self) -> dict[str, list[_Piece]]:
        """What stands below and above a big operator."""
        found = dict[str, list[_Piece]]()
        while self.here.text in ("_", "^") and self.here.text not in found:
            sign = self.here.text
            self.place += 1
            found[sign] = self._group()
        return found

    def _integral(self) -> _Code:
        r"""An integral, up to its differential, which is written \dd s."""
        head = self.here
        self.place += 1
        limits = self._limits()
        if len(limits) != 2 or not all(limits.values()):
            raise self.latex.refusal(head.column, "this integral has not both limits", "write them")
        low, high = (self._inner(limits[sign], head.column).text for sign in "_^")
        start, depth, inner = self.place, 0, 1
        for end in range(start, len(self.pieces)):
            text = self.pieces[end].text
            depth += (text in _CLOSING) - (text in _CLOSING.values())
            if depth < 0:
                break
            inner += (depth == 0) and text in _INTEGRALS
            inner -= (depth == 0) and text == r"\dd"
            if depth == 0 and text == r"\dd" and not inner:
                along = self.pieces[end + 1] if end + 1 < len(self.pieces) else _NOTHING
                if not along.is_mark or along.is_number:
                    break
                column = self.pieces[end].column
                inside = self._inner(self.pieces[start:end], column).text if end > start else "1"
                self.place = end + 2
                name = _INTEGRALS[head.text]
                return _Code(f"{name}({inside}, {along.text[1:]}, {low}, {high})", _ATOM)
        why = "where this integral ends is unclear"
        raise self.latex.refusal(head.column, why, "end it by its differential, as \\mathrm{d}s")

    def _all_sum(self) -> _Code:
        r"""\sum_{k=1}^{n} with the product that follows."""
        head = self.here
        self.place += 1
        limits = self._limits()
        below = limits.get("_", [])
        if len(limits) != 2 or len(below) < 3 or not below[0].is_mark or below[1].text != "=":
            why = "this sum has not both limits"
            raise self.latex.refusal(head.column, why, "write \\sum_{k=1}^{n}")
        low = self._inner(below[2:], head.column).text
        high = self._inner(limits["^"], head.column).text
        along, inside = below[0].text, self._product().text
        if self.here.text in ("+", "-") and any(p.text == along for p in self.pieces[self.place :]):
            self._refuse("whether this belongs to the sum is unclear", "use parentheses")
        return _Code(f"sum({inside}, {along[1:]}, {low}, {high})", _ATOM)

    def _limit(self) -> _Code:
        r"""\lim_{x \to a} with the product that follows."""
        head = self.here
        self.place += 1
        below = self._limits().get("_", [])
        if len(below) < 3 or not below[0].is_mark or below[1].text not in (r"\to", r"\rightarrow"):
            raise self.latex.refusal(head.column, "this is no limit", "write \\lim_{x \\to a}")
        end = self._inner(below[2:], head.column).text
        inside = self._product().text
        if self.here.text in ("+", "-"):
            self._refuse("whether this belongs to the limit is unclear", "use parentheses")
        return _Code(f"limit({inside}, {below[0].text[1:]}, {end})", _ATOM)

    def _cases(self) -> _Code:
        r"""\begin{cases}: a value and a condition in each row."""
        column = self.here.column
        rows, _ = _divided(self._group(), (r"\caserow",))
        pairs = [self._row(row, column) for row in rows if row]
        if not pairs:
            raise self.latex.refusal(column, "this has no cases", "write them")
        return _Code(f"Piecewise({', '.join(pairs)})", _ATOM)

    def _row(self, row: list[_Piece], column: int) -> str:
        cut = next((n for n, p in enumerate(row) if p.text in (r"\casecol", r"\whereword")), None)
        if cut is None:
            parts, _ = _divided(row, (",",))
            row, rest = parts[0], [piece for part in parts[1:] for piece in part]
        else:
            row, rest = row[:cut], row[cut:]
        row = row[:-1] if row and row[-1].text == "," else row
        rest = [piece for piece in rest if piece.text not in (r"\casecol", r"\whereword")]
        value = self._inner(row, column).text
        listed, _ = _divided(rest, (",", r"\andword"))
        told = " and ".join(self._condition(part, column) for part in listed if part)
        return f"({value}, {told or 'True'})"

    def _condition(self, pieces: list[_Piece], column: int) -> str:
        sides, between = _divided(pieces, _RELATIONS)
        if not between:
            raise self.latex.refusal(pieces[0].column, "this is no condition", "write x < a")
        texts = [self._inner(side, column).text for side in sides]
        pairs = zip(between, texts[1:], strict=True)
        return texts[0] + "".join(f" {_RELATIONS[sign.text]} {text}" for sign, text in pairs)

    def _unread(self) -> NoReturn:
        why = "the LaTeX cannot be read from here on"
        self._refuse(why, "put \\cdot between factors, or write the claim as text")

    def _refuse(self, why: str, remedy: str) -> NoReturn:
        raise self.latex.refusal(self.here.column, why, remedy)

    _readers: Mapping[str, Callable[["_Side"], _Code]] = {
        "(": _parenthesised,
        "[": _parenthesised,
        "{": _in_braces,
        "|": _modulus,
        r"\sqrt": _root,
        r"\sum": _all_sum,
        r"\lim": _limit,
        _CASES: _cases,
        **dict.fromkeys(_FRACTIONS, _fraction),
        **dict.fromkeys(_INTEGRALS, _integral),
    }


_NOTHING = _Piece("", 0)


def _divided(pieces: list[_Piece], at: object) -> tuple[list[list[_Piece]], list[_Piece]]:
    """The pieces cut where one of these stands outside all groups, and what they are cut at."""
    parts, between, depth = [list[_Piece]()], list[_Piece](), 0
    for piece in pieces:
        depth += (piece.text in _CLOSING) - (piece.text in _CLOSING.values())
        if depth == 0 and piece.text in at:  # type: ignore[operator]
            between.append(piece)
            parts.append([])
        else:
            parts[-1].append(piece)
    return parts, between


def _in_braces(piece: _Piece) -> list[_Piece]:
    return [_Piece("{", piece.column), piece, _Piece("}", piece.column)]


def _is_number_over_number(pieces: list[_Piece]) -> bool:
    """Whether a fraction stands first, of two plain numbers; its braces are written already."""
    if not pieces or pieces[0].text not in _FRACTIONS or len(pieces) < 7:
        return False
    return all(
        pieces[n].text == "{" and pieces[n + 1].is_number and pieces[n + 2].text == "}"
        for n in (1, 4)
    )


def _is_one(piece: _Piece) -> bool:
    """Whether TeX takes it as a whole where there are no braces."""
    return piece.is_mark and piece.size == 1
