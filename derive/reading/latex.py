r"""Read an equation given as LaTeX, provided that it can be read in only one way.

LaTeX is ambiguous as a formula: `f(x)` may be a call or a product, and a parser that never fails
has to guess.  Therefore the text is first split into the symbols that the claims file declares,
numbers, and a few commands; anything else is refused, with its position.  A declared symbol is
never a function.  An implied product gets a multiplication sign, unless it could be part of a
denominator after a slash.  Invisible braces may hold at most one factor.  The end of the argument
of a function, of a sum or of an integral must be clear from what is printed.  The result is text
for derive.reading.formula, term by term in the printed order, so that a user can compare the two.
The claims file must accept this text.
"""

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import NoReturn

from derive.command.errors import BadFormula
from derive.reading.relation import Relation
from derive.reading.spellings import GREEK, letter_name
from derive.reading.words import COMMANDS, FUNCTIONS

_LONGEST = 2000
"""The largest number of characters in an equation."""
_DEEPEST = 60
"""The largest nesting depth of groups."""

_TOKEN = re.compile(
    r"\\(?:begin|end)\s*\{[A-Za-z]+\*?\}|\\text\{[^{}]*\}|\\[A-Za-z]+|\\.|[0-9]+(?:\.[0-9]+)?"
    r"|[A-Za-z]|[-+*/=<>()\[\]{}^_|']|\s+|.",
    re.DOTALL,
)
_SPACES = frozenset((r"\,", r"\;", r"\:", r"\!", r"\ ", r"\quad", r"\qquad", r"\left", r"\right"))
_FUNCTIONS = COMMANDS | {r"\cot": "1/tan", r"\sec": "1/cos", r"\csc": "1/sin"}
_CIRCULAR = frozenset(
    name for name in _FUNCTIONS if name.endswith(("sin", "cos", "tan", "sinh", "cosh", "tanh"))
) | {r"\cot", r"\sec", r"\csc"}
"""Functions of angles and their inverses: the name of the next function ends their argument."""
_NEXT = _CIRCULAR | {r"\exp", r"\log", r"\ln"}
_OF_SEVERAL = frozenset((r"\max", r"\min"))
_INVERSES = {command: f"a{n}" for command, n in COMMANDS.items() if f"a{n}" in FUNCTIONS}
_FRACTIONS = (r"\frac", r"\dfrac", r"\tfrac", r"\cfrac", r"\nicefrac")
_INTEGRALS = {r"\int": "integral", r"\pvint": "pv"}
_BIG = (*_INTEGRALS, r"\sum", r"\lim")
_UNEQUAL = (r"\ne", r"\neq")
_CASES, _ENDCASES = r"\begin{cases}", r"\end{cases}"
_WORDS = frozenset((r"\whereword", r"\andword", r"\orword", r"\elseword", r"\caserow", r"\casecol"))
_COMMANDS = frozenset(
    (*_FUNCTIONS, *_FRACTIONS, *_BIG, *_WORDS, _CASES, _ENDCASES, r"\sqrt", r"\cdot", r"\times")
) | {r"\dd", "_", ",", r"\to", r"\rightarrow", r"\infty", r"\euler", *_UNEQUAL}
_CLOSING = {"(": ")", "{": "}", "[": "]", _CASES: _ENDCASES}
_ENDS = frozenset(("+", "-", ")", "}", "]", "|", ",", r"\dd", _ENDCASES, *_WORDS))
"""Tokens that may follow the argument of a function."""
_OPERATORS = {"*": "*", "/": "/", r"\cdot": "*", r"\times": "*"}
_AFTER_BRACKETS = frozenset((*_OPERATORS, *_FUNCTIONS, *_FRACTIONS, r"\sqrt"))
"""Further tokens that may follow an argument whose end is shown by brackets or bars."""
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
    """A declared symbol, a number, or a LaTeX token, with its column.

    size: the number of tokens that it consists of; without braces, TeX takes only one.
    """

    text: str
    column: int
    size: int = 1

    @property
    def is_mark(self) -> bool:
        """Whether the piece is a symbol or a number."""
        return self.text.startswith("=") and self.text != "="

    @property
    def is_number(self) -> bool:
        """Whether the piece is a number."""
        return self.is_mark and self.text[1].isdigit()


@dataclass(frozen=True)
class _Code:
    """A piece of text and its precedence level."""

    text: str
    level: int

    def at(self, level: int) -> str:
        """Return the text for use at precedence `level`, in parentheses if they are needed."""
        return self.text if self.level >= level else f"({self.text})"


@dataclass(frozen=True)
class Latex:
    """The LaTeX equation of one claim.

    where      the location of the claim, for error messages
    text       the equation as in the source
    spellings  the LaTeX of each symbol -> its name in the claims file
    """

    where: str
    text: str
    spellings: Mapping[str, str]

    def understood(self) -> str:
        """Return the equation as text; raise BadFormula if there is not exactly one reading."""
        sides, between = self._sides()
        if len(between) != 1:
            column = between[1].column if between else len(self.text)
            why = "there are two relations here" if between else "there is no relation here"
            raise self.refusal(column, why, "write one equation with exactly one relation")
        return f"{sides[0]} {Relation(_RELATIONS[between[0].text])} {sides[1]}"

    def condition(self) -> str:
        """Return a condition such as -a < x < c and b > 0 as text; raises BadFormula."""
        side = _Side(self, self._pieces(), len(self.text), 0)
        return side.conditions(side.pieces, 0)

    def approach(self) -> str:
        r"""Return a limit as text, such as c - x -> 0 for c-x \to 0; raises BadFormula."""
        pieces = self._pieces()
        at = [n for n, piece in enumerate(pieces) if piece.text in (r"\to", r"\rightarrow")]
        if len(at) != 1:
            raise self.refusal(0, "this is not a limit", "write it as text, such as x -> 0")
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
            why = f"the equation has {len(self.text)} characters, and at most {_LONGEST} are read"
            raise self.refusal(_LONGEST, why, "split the equation, or shorten it with new symbols")
        return self._braced(self._marked())

    def side(self, pieces: list[_Piece], end: int, depth: int = 0) -> _Code:
        """Return one side of the equation, or the content of a group, as text."""
        if depth > _DEEPEST:
            raise self.refusal(end, "the groups are nested too deeply", "use fewer brackets")
        return _Side(self, pieces, end, depth).whole()

    def _marked(self) -> list[_Piece]:
        """Return the tokens, with every declared symbol and number as one piece."""
        pieces = [
            _Piece(match.group(), match.start())
            for match in _TOKEN.finditer(self.text)
            if not match.group().isspace() and match.group() not in _SPACES
        ]
        marked, position = [], 0
        integrates = any(piece.text in _INTEGRALS for piece in pieces)
        bound = _bound(pieces)
        while position < len(pieces):
            if integrates and pieces[position].text == r"\dd":
                marked.append(pieces[position])
                position += 1
                continue
            length, name = self._longest(pieces, position)
            if length:
                marked.append(_Piece(f"={name}", pieces[position].column, length))
                position += length
                continue
            known = pieces[position].text in bound
            text = f"={letter_name(pieces[position].text)}"
            marked.append(
                _Piece(text, pieces[position].column) if known else self._known(pieces[position])
            )
            position += 1
        return marked

    def _longest(self, pieces: list[_Piece], position: int) -> tuple[int, str]:
        """Find the longest declared symbol that starts here; return its length and name."""
        best = (0, "")
        for spelling, name in self._cut:
            length = len(spelling)
            if (
                length > best[0]
                and [p.text for p in pieces[position : position + length]] == spelling
            ):
                best = (length, name)
        return best

    @cached_property
    def _cut(self) -> list[tuple[list[str], str]]:
        """The tokens and the name of every spelling."""
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
        if text.startswith(r"\text{"):
            why = f"the words {piece.text[6:-1]!r} are not understood here"
            remedy = "write the claim as text, with numbers in the units of the file"
            raise self.refusal(piece.column, why, remedy)
        why = f"{text} is neither a declared symbol nor a supported command"
        remedy = "declare it under [latex], or write the claim as text"
        raise self.refusal(piece.column, why, remedy)

    def _braced(self, pieces: list[_Piece]) -> list[_Piece]:
        r"""Add the braces that are missing around the arguments of \frac and \sqrt."""
        braced, position = list[_Piece](), 0
        while position < len(pieces):
            head = pieces[position]
            braced.append(head)
            position += 1
            if head.text in _FRACTIONS:
                position = self._arguments(pieces, position, braced)
            elif head.text == r"\sqrt" and position < len(pieces) and _is_one(pieces[position]):
                braced += _in_braces(pieces[position])
                position += 1
        return braced

    def _arguments(self, pieces: list[_Piece], position: int, braced: list[_Piece]) -> int:
        """Append both arguments of a fraction to `braced`, and return where they end."""
        wanted = 2
        while wanted and position < len(pieces):
            piece = pieces[position]
            if piece.text == "{":
                end = self.group(pieces, position)
                braced += [piece, *self._braced(pieces[position + 1 : end - 1]), pieces[end - 1]]
                position, wanted = end, wanted - 1
                continue
            digits = piece.text[1:]
            if not _is_one(piece) and not (piece.is_number and wanted == len(digits) == 2):
                why = "the numerator and denominator of this fraction are unclear"
                raise self.refusal(piece.column, why, "put each of them in braces")
            for part in digits if piece.is_number else [digits]:
                braced += _in_braces(_Piece(f"={part}", piece.column))
                wanted -= 1
            position += 1
        return position

    def group(self, pieces: list[_Piece], start: int) -> int:
        """Return the end of the symbol or bracketed group that starts at `start`."""
        opened = pieces[start].text
        if opened not in _CLOSING:
            return start + 1
        depth = 0
        for position in range(start, len(pieces)):
            depth += pieces[position].text == opened
            depth -= pieces[position].text == _CLOSING[opened]
            if depth == 0:
                return position + 1
        why = f"this {opened} is not closed"
        raise self.refusal(pieces[start].column, why, f"add {_CLOSING[opened]}")

    def _demand_plain(self, pieces: list[_Piece]) -> None:
        """Refuse powers, roots and products whose appearance is misleading."""
        ends = _Piece("", len(self.text))
        for position, piece in enumerate(pieces):
            after = pieces[position + 1] if position + 1 < len(pieces) else ends
            if piece.text == "^":
                self._demand_exponent(pieces, position + 1, after)
            if piece.text == r"\sqrt" and after.text not in ("{", "[") and not _is_one(after):
                raise self.refusal(after.column, "the end of this root is unclear", "use braces")
            if piece.is_number and after.is_number and after.text != "=oo":
                why = "there are two numbers with no operator between them"
                raise self.refusal(after.column, why, "put \\cdot between them")
            if piece.is_number and _is_number_over_number(pieces[position + 1 :]):
                why = "a number before a numerical fraction may mean a sum, as in 3 1/2"
                raise self.refusal(after.column, why, "put \\cdot or + between them")

    def _demand_exponent(self, pieces: list[_Piece], position: int, after: _Piece) -> None:
        if after.text != "{" and not _is_one(after):
            why = "without braces, TeX takes only one character as the exponent"
            raise self.refusal(after.column, why, "put the exponent in braces")
        end = self.group(pieces, position)
        if end < len(pieces) and pieces[end].text == "^":
            why = "a power of a power needs braces"
            raise self.refusal(pieces[end].column, why, "put one of the powers in braces")

    def refusal(self, column: int, why: str, remedy: str) -> BadFormula:
        """Return the error for the text at a column."""
        return BadFormula(self.where, self.text, column, why, remedy)


class _Side:
    """Recursive descent through one side, or one group of it."""

    def __init__(self, latex: Latex, pieces: list[_Piece], end: int, depth: int) -> None:
        self.latex, self.pieces, self.end, self.depth = latex, pieces, end, depth
        self.position = 0

    def whole(self) -> _Code:
        """Read all pieces."""
        made = self._sum()
        if self.position < len(self.pieces):
            self._unread()
        return made

    @property
    def here(self) -> _Piece:
        """The next piece to be read."""
        if self.position < len(self.pieces):
            return self.pieces[self.position]
        return _Piece("", self.end)

    def _inner(self, pieces: list[_Piece], end: int) -> _Code:
        return self.latex.side(pieces, end, self.depth + 1)

    def _group(self) -> list[_Piece]:
        """Read the content of the group that starts here, or one piece, and move past it."""
        start = self.position
        if start == len(self.pieces):
            self._unread()
        self.position = self.latex.group(self.pieces, start)
        pieces = self.pieces[start : self.position]
        return pieces[1:-1] if pieces[0].text in _CLOSING else pieces

    def _grouped(self) -> _Code:
        """Read the group that starts here, or one piece, as text."""
        inner = self._group()
        return self._inner(inner, self.pieces[self.position - 1].column)

    def _sum(self) -> _Code:
        text, level = "", _PRODUCT
        if self.here.text in ("+", "-"):
            text, level = self.here.text.strip("+"), _SUM
            self.position += 1
        term = self._product()
        text, level = text + term.at(_PRODUCT), min(level, term.level)
        if self.here.text not in ("+", "-"):
            return _Code(text, _SUM if text[0] == "-" else term.level)
        while self.here.text in ("+", "-"):
            sign = self.here.text
            self.position += 1
            text += f" {sign} {self._product().at(_PRODUCT)}"
        return _Code(text, _SUM)

    def _product(self) -> _Code:
        product, after_slash = self._factor(), False
        while True:
            head = self.here
            operator = _OPERATORS.get(head.text, "")
            if operator:
                self.position += 1
                after_slash = after_slash or operator == "/"
            elif not self._starts_factor():
                return product
            elif after_slash:
                why = "it is unclear whether this belongs to the denominator"
                self._refuse(why, "write \\frac, or use parentheses")
            factor = self._factor()
            operator = operator or "*"
            least = _POWER if operator == "/" else _PRODUCT
            product = _Code(f"{product.at(_PRODUCT)}{operator}{factor.at(least)}", _PRODUCT)

    def _starts_factor(self) -> bool:
        text = self.here.text
        if text == "|":
            return any(piece.text == "|" for piece in self.pieces[self.position + 1 :])
        starts = (*_CLOSING, r"\sqrt", r"\euler", *_FRACTIONS, *_FUNCTIONS, *_BIG)
        return self.here.is_mark or text in starts

    def _factor(self) -> _Code:
        """Read a factor with its power."""
        base = self._base()
        if self.here.text != "^":
            return base
        self.position += 1
        exponent = self._grouped()
        return _Code(f"{base.at(_ATOM)}**{exponent.at(_ATOM)}", _POWER)

    def _base(self) -> _Code:
        head = self.here
        if not self._starts_factor():
            if head.text == "|":
                raise self.latex.refusal(head.column, "this | is not closed", "add |")
            if head.text in ("_", r"\dd"):
                self._refuse(f"{head.text} is not allowed here", "remove it")
            self._unread()
        if head.is_mark:
            self.position += 1
            self._demand_not_euler(head)
            return _Code(head.text[1:], _ATOM)
        if head.text in _FUNCTIONS:
            return self._application()
        return self._readers[head.text](self)

    def _demand_not_euler(self, head: _Piece) -> None:
        """Refuse e^{-x}, in which e may be a symbol or the base of natural logarithms."""
        if head.text != "=e" or self.here.text != "^" or self.position + 1 == len(self.pieces):
            return
        end = self.latex.group(self.pieces, self.position + 1)
        inner = [p for p in self.pieces[self.position + 1 : end] if p.text not in ("{", "}")]
        if len(inner) != 1 or not inner[0].is_number:
            why = "it is unclear whether e is a symbol here"
            remedy = "write \\exp(...) or \\mathrm{e}^{...}, or rename the symbol"
            raise self.latex.refusal(head.column, why, remedy)

    def _euler(self) -> _Code:
        self.position += 1
        if self.here.text != "^":
            return _Code("exp(1)", _ATOM)
        self.position += 1
        return _Code(f"exp({self._grouped().text})", _ATOM)

    def _parenthesised(self) -> _Code:
        return self._grouped()

    def _in_braces(self) -> _Code:
        """Read braces, which are not printed and may therefore hold only one factor."""
        column = self.here.column
        inner = self._group()
        side = _Side(self.latex, inner, self.pieces[self.position - 1].column, self.depth + 1)
        if self.depth > _DEEPEST:
            self._refuse("the groups are nested too deeply", "use fewer brackets")
        if [piece.text for piece in inner] == [","]:
            why = "it is unclear whether this comma separates thousands"
            raise self.latex.refusal(column, why, "write a decimal point, or no comma")
        starts = bool(inner) and (side._starts_factor() or inner[0].text == "|")
        made = side._factor() if starts else None
        if made is None or side.position != len(inner):
            why = "these braces group terms but are not printed"
            raise self.latex.refusal(column, why, "use parentheses")
        return made

    def _modulus(self) -> _Code:
        start, depth = self.position, 0
        for position in range(start + 1, len(self.pieces)):
            text = self.pieces[position].text
            depth += (text in _CLOSING) - (text in _CLOSING.values())
            if depth == 0 and text == "|":
                self.position = position + 1
                inner = self._inner(self.pieces[start + 1 : position], self.pieces[position].column)
                return _Code(f"abs({inner.text})", _ATOM)
        raise self.latex.refusal(self.pieces[start].column, "this | is not closed", "add |")

    def _fraction(self) -> _Code:
        self.position += 1
        over = self._grouped()
        under = self._grouped()
        return _Code(f"{over.at(_PRODUCT)}/{under.at(_POWER)}", _PRODUCT)

    def _root(self) -> _Code:
        self.position += 1
        degree = self._grouped() if self.here.text == "[" else None
        inner = self._grouped()
        if degree is None:
            return _Code(f"sqrt({inner.text})", _ATOM)
        return _Code(f"{inner.at(_ATOM)}**(1/{degree.at(_POWER)})", _POWER)

    def _application(self) -> _Code:
        """Read a function with its argument."""
        head = self.here
        power, name, base = "", _FUNCTIONS[head.text], ""
        if head.text in _INVERSES and self._is_inverse():
            name = _INVERSES[head.text]
            self.position += 6
        else:
            self.position += 1
            if head.text == r"\log" and self.here.text == "_":
                self.position += 1
                base = f"/log({self._grouped().text})"
            power = self._power_of_function()
        if self.position == len(self.pieces):
            raise self.latex.refusal(self.end, f"{head.text} has no argument", "add one")
        inner = self._argument(head)
        over, _, name = name.rpartition("/")
        call = f"{name}({inner}){power}"
        if base and power:
            raise self.latex.refusal(
                head.column, "the power of this logarithm is unclear", "use ()"
            )
        if over or base:
            return _Code(f"1/{call}" if over else call + base, _PRODUCT)
        return _Code(call, _POWER if power else _ATOM)

    def _is_inverse(self) -> bool:
        after = [piece.text for piece in self.pieces[self.position + 1 : self.position + 6]]
        return after == ["^", "{", "-", "=1", "}"]

    def _power_of_function(self) -> str:
        """Read the power between a function and its argument: an integer of at least 2."""
        if self.here.text != "^":
            return ""
        column = self.here.column
        self.position += 1
        inner = self._group()
        digits = inner[0].text[1:] if len(inner) == 1 else ""
        if not digits.isdigit() or int(digits) < 2:
            why = "this power of a function may mean its inverse function"
            raise self.latex.refusal(column, why, "write \\arcsin, or a fraction")
        return f"**{digits}"

    def _argument(self, head: _Piece) -> str:
        """Read the argument of a function; raise BadFormula if its end is unclear."""
        first, start = self.here, self.position
        if head.text in _CIRCULAR and (count := self._multiple()):
            self.position += count
            text = self._inner(self.pieces[start : start + count], first.column).text
        elif first.text in _FRACTIONS:
            text = self._fraction().text
        elif first.text == r"\sqrt":
            text = self._root().text
        elif first.text == "|":
            text = self._modulus().text
        elif first.text in ("(", "{", "[") or first.is_mark:
            inner = self._group()
            if first.text == "{" and any(piece.text in ("+", "-") for piece in inner):
                why = "braces are not printed, so the end of the argument is unclear"
                raise self.latex.refusal(first.column, why, "use parentheses")
            if not inner:
                raise self.latex.refusal(head.column, f"{head.text} has no argument", "add one")
            parts, _ = _divided(inner, {",": ","} if head.text in _OF_SEVERAL else {})
            end = self.pieces[self.position - 1].column
            text = ", ".join(self._inner(part, end).text for part in parts)
        else:
            why = "this cannot be the argument of a function"
            raise self.latex.refusal(first.column, why, "put the argument in parentheses")
        shown = self.pieces[start].text in ("(", "|", "[")
        allowed = _ENDS | _AFTER_BRACKETS if shown else _ENDS
        allowed = allowed | _NEXT if head.text in _CIRCULAR else allowed
        if self.here.text and self.here.text not in allowed:
            why = "the end of the function's argument is unclear"
            remedy = "put the function and its argument in parentheses, as in (\\sin(a)) b"
            self._refuse(why, remedy)
        return text

    def _multiple(self) -> int:
        r"""Return the length of a multiple such as 2 \varphi or 2 \pi x; 0 if it is none."""
        after = self.pieces[self.position : self.position + 3]
        for pattern in (after, after[:2]):
            if pattern and pattern[-1].is_mark and not pattern[-1].is_number:
                first, *between = pattern[:-1] or [_NOTHING]
                numbers = first.is_number or first.text == "=pi"
                if numbers and all(piece.text == "=pi" for piece in between):
                    return len(pattern)
        return 0

    def _limits(self) -> dict[str, list[_Piece]]:
        """Read the lower and upper limits of an integral, a sum or a limit."""
        limits = dict[str, list[_Piece]]()
        while self.here.text in ("_", "^") and self.here.text not in limits:
            sign = self.here.text
            self.position += 1
            limits[sign] = self._group()
        return limits

    def _integral(self) -> _Code:
        r"""Read an integral up to its differential, which is written \dd s."""
        head = self.here
        self.position += 1
        limits = self._limits()
        if len(limits) != 2 or not all(limits.values()):
            why = "this integral lacks a limit"
            raise self.latex.refusal(head.column, why, "write both limits, as in \\int_{a}^{b}")
        low, high = (self._inner(limits[sign], head.column).text for sign in "_^")
        start, depth, inner = self.position, 0, 1
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
                self.position = end + 2
                name = _INTEGRALS[head.text]
                return _Code(f"{name}({inside}, {along.text[1:]}, {low}, {high})", _ATOM)
        why = "the end of this integral is unclear"
        raise self.latex.refusal(head.column, why, "end it with a differential, as \\mathrm{d}s")

    def _all_sum(self) -> _Code:
        r"""Read \sum_{k=1}^{n} with the product that follows."""
        head = self.here
        self.position += 1
        limits = self._limits()
        below = limits.get("_", [])
        if len(limits) != 2 or len(below) < 3 or not below[0].is_mark or below[1].text != "=":
            why = "this sum lacks a limit"
            raise self.latex.refusal(head.column, why, "write both limits, as in \\sum_{k=1}^{n}")
        low = self._inner(below[2:], head.column).text
        high = self._inner(limits["^"], head.column).text
        along, inside = below[0].text, self._product().text
        if self.here.text in ("+", "-") and any(
            p.text == along for p in self.pieces[self.position :]
        ):
            self._refuse("it is unclear whether this belongs to the sum", "use parentheses")
        return _Code(f"sum({inside}, {along[1:]}, {low}, {high})", _ATOM)

    def _limit(self) -> _Code:
        r"""Read \lim_{x \to a} with the product that follows."""
        head = self.here
        self.position += 1
        below = self._limits().get("_", [])
        if len(below) < 3 or not below[0].is_mark or below[1].text not in (r"\to", r"\rightarrow"):
            why = "this limit is incomplete"
            raise self.latex.refusal(head.column, why, "write it as \\lim_{x \\to a}")
        end = self._inner(below[2:], head.column).text
        inside = self._product().text
        if self.here.text in ("+", "-"):
            self._refuse("it is unclear whether this belongs to the limit", "use parentheses")
        return _Code(f"limit({inside}, {below[0].text[1:]}, {end})", _ATOM)

    def _cases(self) -> _Code:
        r"""Read \begin{cases}, which has a value and a condition in each row."""
        column = self.here.column
        rows, _ = _divided(self._group(), (r"\caserow",))
        pairs = [self._row(row, column) for row in rows if row]
        if not pairs:
            raise self.latex.refusal(column, "there are no cases here", "add at least one")
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
        if [piece.text for piece in rest] == [r"\elseword"]:
            return f"({value}, True)"
        if not rest:
            why = "this row has no condition"
            raise self.latex.refusal(column, why, "write \\text{otherwise}, or a condition")
        return f"({value}, {self.conditions(rest, column)})"

    def conditions(self, pieces: list[_Piece], column: int) -> str:
        """Return several conditions as text."""
        either = [
            _divided(part, (",", r"\andword"))[0] for part in _divided(pieces, (r"\orword",))[0]
        ]
        if len(either) > 1 and any(len(parts) > 1 for parts in either):
            why = "some of these conditions are joined by `or`, and others by `and` or a comma"
            raise self.latex.refusal(column, why, "write the condition as text")
        return " or ".join(
            " and ".join(self._condition(part, column) for part in parts if part)
            for parts in either
        )

    def _condition(self, pieces: list[_Piece], column: int) -> str:
        sides, between = _divided(pieces, (*_RELATIONS, *_UNEQUAL))
        unequal = [sign for sign in between if sign.text in _UNEQUAL]
        if not between or len(unequal) not in (0, len(between)) or len(unequal) > 1:
            why = "this is not a condition"
            at = pieces[0].column if pieces else column
            raise self.latex.refusal(at, why, "write a relation, such as x < a")
        texts = [self._inner(side, column).text for side in sides]
        if unequal:
            return f"({texts[0]} < {texts[1]} or {texts[0]} > {texts[1]})"
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
        r"\euler": _euler,
        r"\sum": _all_sum,
        r"\lim": _limit,
        _CASES: _cases,
        **dict.fromkeys(_FRACTIONS, _fraction),
        **dict.fromkeys(_INTEGRALS, _integral),
    }


_NOTHING = _Piece("", 0)


def _bound(pieces: list[_Piece]) -> frozenset[str]:
    """Return the letters along which an integral, a sum or a limit is taken."""
    texts = [piece.text for piece in pieces]
    found = set[str]()
    for n, text in enumerate(texts):
        if text == r"\dd" and any(each in _INTEGRALS for each in texts):
            found.update(texts[n + 1 : n + 2])
        if text in (r"\sum", r"\lim") and texts[n + 1 : n + 3] == ["_", "{"]:
            found.update(texts[n + 3 : n + 4])
    return frozenset(t for t in found if (len(t) == 1 and t.isalpha()) or t in GREEK)


def _divided(pieces: list[_Piece], at: object) -> tuple[list[list[_Piece]], list[_Piece]]:
    """Split the pieces at separators outside all groups; return the parts and the separators."""
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
    """Whether the pieces start with a fraction of two numbers, with all braces in place."""
    if not pieces or pieces[0].text not in _FRACTIONS or len(pieces) < 7:
        return False
    return all(
        pieces[n].text == "{" and pieces[n + 1].is_number and pieces[n + 2].text == "}"
        for n in (1, 4)
    )


def _is_one(piece: _Piece) -> bool:
    """Whether TeX takes the piece as a whole if there are no braces."""
    return piece.is_mark and piece.size == 1
