r"""Reads an equation given as LaTeX, if it can be read in one way only.

LaTeX is no formula: `f(x)` may be a call or a product, and a parser that must not fail guesses.
So the text is first cut into symbols that the claims file declares, numbers, and a few commands;
everything else is refused where it stands.  Each symbol and number becomes a plain x_{aa}, which
SymPy's parser (by lark) reads; a reading in which a declared quantity is called as a function is
no reading.  A product without a sign gets one, except where it may stand below a slash; braces that
do not print hold one factor at most.  Where the argument of a function or a power ends must be
plain from the print: a function with its argument is read first, and is one symbol to the parser.
If exactly one reading is left it is printed as text, and read once more by derive.paper.formula:
what goes on is that text, which the claims file must accept.
"""

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from importlib.util import find_spec

from sympy import Expr, Symbol, sstr
from sympy.core.function import AppliedUndef

from derive.errors import BadClaimsFile, BadFormula
from derive.paper.claim import Relation

_LONGEST = 2000
"""Characters that an equation may have: an ambiguous grammar is slow on long ones."""

_TOKEN = re.compile(
    r"\\[A-Za-z]+|\\.|[0-9]+(?:\.[0-9]+)?|[A-Za-z]|[-+*/=<>()\[\]{}^_|']|\s+|.", re.DOTALL
)
_SPACES = frozenset((r"\,", r"\;", r"\:", r"\!", r"\ ", r"\quad", r"\qquad", r"\left", r"\right"))
_FUNCTIONS = {
    rf"\{name}": name for name in ("sin", "cos", "tan", "sinh", "cosh", "tanh", "exp", "log")
} | {r"\arcsin": "asin", r"\arccos": "acos", r"\arctan": "atan", r"\ln": "log", r"\sgn": "sign"}
_FRACTIONS = (r"\frac", r"\dfrac", r"\tfrac", r"\nicefrac")
_COMMANDS = frozenset(
    (*_FUNCTIONS, *_FRACTIONS, r"\sqrt", r"\cdot", r"\times", r"\int", r"\dd", "_")
)
_CLOSING = {"(": ")", "{": "}", "[": "]"}
_ENDS = frozenset(("+", "-", ")", "}", "]", "|"))
"""What may follow the argument of a function."""
_OPERATORS = frozenset(("*", "/", r"\cdot", r"\times"))
_AFTER_BRACKETS = _OPERATORS | {*_FUNCTIONS, *_FRACTIONS, r"\sqrt"}
"""What may, too, where parentheses show the end of the argument."""
_TOLD = 3
"""Readings that a message shows."""
_PLAIN = frozenset("-+*/(){}^|[]")
_RELATIONS = {
    "=": "=",
    "<": "<",
    ">": ">",
    r"\le": "<=",
    r"\leq": "<=",
    r"\ge": ">=",
    r"\geq": ">=",
    **dict.fromkeys((r"\sim", r"\simeq", r"\approx", r"\cong"), "~"),
}


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
        _demand_parser(self.where)
        if len(self.text) > _LONGEST:
            raise self._refusal(_LONGEST, "the equation is too long", f"stay below {_LONGEST}")
        sides, relation = self._halves(self._braced(self._marked()))
        for side in sides:
            self._demand_plain(side)
        left, right = (self._side(side) for side in sides)
        return f"{left} {relation} {right}"

    def _marked(self) -> list[_Piece]:
        """The tokens, every declared symbol and number as one."""
        pieces = [
            _Piece(found.group(), found.start())
            for found in _TOKEN.finditer(self.text)
            if not found.group().isspace() and found.group() not in _SPACES
        ]
        marked, place = [], 0
        integrates = any(piece.text == r"\int" for piece in pieces)
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
        text = piece.text
        if text[0].isdigit():
            return _Piece(f"={text}", piece.column, len(text))
        if text == r"\pi":
            return _Piece("=pi", piece.column)
        if text in _COMMANDS or text in _PLAIN or text in _RELATIONS:
            return piece
        why = f"{text} is no declared symbol and no command that is known here"
        remedy = "declare it under [latex], or write the claim as text"
        raise self._refusal(piece.column, why, remedy)

    def _halves(self, pieces: list[_Piece]) -> tuple[tuple[list[_Piece], list[_Piece]], Relation]:
        places = [i for i, piece in enumerate(pieces) if piece.text in _RELATIONS]
        if len(places) != 1:
            column = pieces[places[1]].column if places else len(self.text)
            why = "there are two relations here" if places else "there is no relation here"
            raise self._refusal(column, why, "give one equation, with one relation")
        (at,) = places
        relation = Relation(_RELATIONS[pieces[at].text])
        return (pieces[:at], pieces[at + 1 :]), relation

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
                end = self._group(pieces, place)
                made += [piece, *self._braced(pieces[place + 1 : end - 1]), pieces[end - 1]]
                place, wanted = end, wanted - 1
                continue
            digits = piece.text[1:]
            if not _is_one(piece) and not (piece.is_number and wanted == len(digits) == 2):
                why = "what this fraction is of is unclear"
                raise self._refusal(piece.column, why, "put both of its parts into braces")
            for part in digits if piece.is_number else [digits]:
                made += _in_braces(_Piece(f"={part}", piece.column))
                wanted -= 1
            place += 1
        return place

    def _with_signs(self, pieces: list[_Piece]) -> list[_Piece]:
        """The pieces with a sign in every product that has none; raises BadFormula."""
        made, place, before, below = list[_Piece](), 0, False, False
        bars = [n for n, piece in enumerate(pieces) if piece.text == "|"]
        while place < len(pieces):
            piece = pieces[place]
            if not _starts_factor(piece) or (piece.text == "|" and len(bars) != 2):
                before, below = False, piece.text == "/" or (below and piece.text in _OPERATORS)
                made.append(piece)
                place += 1
                continue
            end = self._factor(pieces, place)
            if before and below:
                why = "whether this stands below the slash is unclear"
                raise self._refusal(piece.column, why, "write \\frac, or parentheses")
            if before:
                made.append(_Piece(r"\cdot", piece.column))
            made += self._inside(pieces[place:end])
            before, place = True, end
        return made

    def _factor(self, pieces: list[_Piece], place: int) -> int:
        """Where the factor that starts here ends, its powers included."""
        piece, end = pieces[place], place + 1
        if piece.text in _CLOSING:
            end = self._group(pieces, place)
        elif piece.text == "|":
            end = self._closing_bar(pieces, place) + 1
        elif piece.text == r"\sqrt" or piece.text in _FRACTIONS:
            while end < len(pieces) and pieces[end].text in ("{", "["):
                last = piece.text in _FRACTIONS and end != place + 1
                end, root = self._group(pieces, end), pieces[end].text == "{"
                if last or (root and piece.text not in _FRACTIONS):
                    break
        while end + 1 < len(pieces) and pieces[end].text == "^":
            end = self._group(pieces, end + 1)
        return end

    def _closing_bar(self, pieces: list[_Piece], start: int) -> int:
        for place in range(start + 1, len(pieces)):
            if pieces[place].text == "|":
                return place
        raise self._refusal(pieces[start].column, "this is not closed", "add |")

    def _inside(self, factor: list[_Piece]) -> list[_Piece]:
        """A factor with signs in the products of all that stands in brackets in it."""
        made, place = list[_Piece](), 0
        while place < len(factor):
            piece = factor[place]
            if piece.text in _CLOSING:
                end = self._group(factor, place)
                inner = factor[place + 1 : end - 1]
                if piece.text == "{" and place == 0 and self._end_of_one(inner) != len(inner):
                    why = "braces do not print, and here they would matter"
                    raise self._refusal(piece.column, why, "use parentheses")
                ends = piece, factor[end - 1]
                if piece.text == "[" and place == 0:
                    ends = _Piece("(", ends[0].column), _Piece(")", ends[1].column)
                made += [ends[0], *self._with_signs(inner), ends[1]]
                place = end
            elif piece.text == "|" and place == 0:
                place = self._closing_bar(factor, 0) + 1
                made += [piece, *self._with_signs(factor[1 : place - 1]), factor[place - 1]]
            else:
                made.append(piece)
                place += 1
        return made

    def _end_of_one(self, pieces: list[_Piece]) -> int:
        return self._factor(pieces, 0) if pieces and _starts_factor(pieces[0]) else 0

    def _demand_plain(self, pieces: list[_Piece]) -> None:
        """No power, root or product that looks unlike what it says."""
        ends = _Piece("", len(self.text))
        for place, piece in enumerate(pieces):
            after = pieces[place + 1] if place + 1 < len(pieces) else ends
            if piece.text == "^":
                self._demand_exponent(pieces, place + 1, after)
            if piece.text == r"\sqrt" and after.text not in ("{", "[") and not _is_one(after):
                raise self._refusal(after.column, "where this root ends is unclear", "use braces")
            if piece.is_number and after.is_number:
                why = "two numbers stand side by side"
                raise self._refusal(after.column, why, "put \\cdot between them")
            if piece.is_number and _is_number_over_number(pieces[place + 1 :]):
                why = "a number before a fraction of numbers may be a sum, as in 3 1/2"
                raise self._refusal(after.column, why, "put \\cdot or + between them")

    def _demand_exponent(self, pieces: list[_Piece], place: int, after: _Piece) -> None:
        if after.text != "{" and not _is_one(after):
            why = "TeX takes one character as the exponent where there are no braces"
            raise self._refusal(after.column, why, "put the exponent into braces")
        end = self._group(pieces, place)
        if end < len(pieces) and pieces[end].text == "^":
            why = "a power of a power without braces"
            raise self._refusal(pieces[end].column, why, "put one of them into braces")

    def _group(self, pieces: list[_Piece], start: int) -> int:
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
        raise self._refusal(pieces[start].column, "this is not closed", f"add {_CLOSING[opened]}")

    def _applied(self, pieces: list[_Piece]) -> list[_Piece]:
        """The pieces with every function and its argument as one symbol."""
        made, place = [], 0
        while place < len(pieces):
            piece, end = pieces[place], place + 1
            if piece.text in _FUNCTIONS:
                piece, end = self._application(pieces, place)
            elif piece.text == r"\int":
                piece, end = self._integral(pieces, place)
            elif piece.text in ("_", r"\dd"):
                raise self._refusal(piece.column, f"{piece.text} cannot stand here", "leave it out")
            made.append(piece)
            place = end
        return made

    def _integral(self, pieces: list[_Piece], place: int) -> tuple[_Piece, int]:
        r"""An integral, up to its differential, which is written \dd s, and where it ends."""
        head, limits, at = pieces[place], dict[str, str](), place + 1
        while at + 1 < len(pieces) and pieces[at].text in ("_", "^") and len(limits) < 2:
            end = self._group(pieces, at + 1)
            inner = pieces[at + 1 : end]
            inner = inner[1:-1] if inner[0].text == "{" else inner
            if pieces[at].text in limits or not inner:
                break
            limits[pieces[at].text] = self._side(inner)
            at = end
        if len(limits) != 2:
            raise self._refusal(head.column, "this integral has not both limits", "write them")
        depth = 0
        for end in range(at, len(pieces)):
            text = pieces[end].text
            depth += (text in _CLOSING) - (text in _CLOSING.values())
            if depth < 0 or text == r"\int":
                break
            if depth == 0 and text == r"\dd":
                along = pieces[end + 1] if end + 1 < len(pieces) else _NOTHING
                if not along.is_mark or along.is_number:
                    break
                inside = "1" if end == at else self._side(pieces[at:end])
                low, high = limits["_"], limits["^"]
                name = f"=integral({inside}, {along.text[1:]}, {low}, {high})"
                return _Piece(name, head.column), end + 2
        why = "where this integral ends is unclear"
        raise self._refusal(head.column, why, "end it by its differential, as \\mathrm{d}s")

    def _application(self, pieces: list[_Piece], place: int) -> tuple[_Piece, int]:
        """A function with its argument, and where it ends."""
        head = pieces[place]
        if name := _inverse(pieces[place : place + 6]):
            power, start = "", place + 6
        else:
            name = _FUNCTIONS[head.text]
            power, start = self._power(pieces, place + 1)
        if start == len(pieces):
            raise self._refusal(len(self.text), f"{head.text} has no argument", "write it")
        end = self._argument(pieces, start)
        inner = pieces[start:end]
        if inner[0].text in ("(", "{"):
            inner = inner[1:-1]
        if not inner:
            raise self._refusal(head.column, f"{head.text} has no argument", "write it")
        return _Piece(f"={name}({self._side(inner)}){power}", head.column), end

    def _power(self, pieces: list[_Piece], place: int) -> tuple[str, int]:
        """The power of a function that stands before its argument: a whole number from 2 on."""
        if place == len(pieces) or pieces[place].text != "^":
            return "", place
        end = self._group(pieces, place + 1)
        inner = [piece for piece in pieces[place + 1 : end] if piece.text not in ("{", "}")]
        if len(inner) != 1 or not inner[0].text[1:].isdigit() or int(inner[0].text[1:]) < 2:
            why = "this power of a function may mean its inverse"
            raise self._refusal(pieces[place].column, why, "write \\arcsin, or a fraction")
        return f"**{inner[0].text[1:]}", end

    def _argument(self, pieces: list[_Piece], start: int) -> int:
        """Where the argument of a function ends; raises BadFormula where that is unclear."""
        first = pieces[start]
        if first.text in _FRACTIONS and start + 1 < len(pieces):
            end = self._group(pieces, start + 1)
            end = self._group(pieces, end) if end < len(pieces) else end
        elif first.text in ("(", "{") or first.is_mark:
            end = self._group(pieces, start)
            if first.text == "{" and any(p.text in "+-" for p in pieces[start:end]):
                why = "braces do not print, so that this sum is not seen to be the argument"
                raise self._refusal(first.column, why, "use parentheses")
        elif first.text == "|":
            end = self._closing_bar(pieces, start) + 1
        else:
            raise self._refusal(first.column, "this is no argument of a function", "add ( and )")
        allowed = _ENDS | _AFTER_BRACKETS if first.text in ("(", "|") else _ENDS
        if end < len(pieces) and pieces[end].text not in allowed:
            why = "where the argument of the function ends is unclear"
            remedy = "put the function and its argument into parentheses, as in (\\sin(a)) b"
            raise self._refusal(pieces[end].column, why, remedy)
        return end

    def _side(self, pieces: list[_Piece]) -> str:
        """One side as text."""
        marks: dict[str, str] = {}
        columns: list[tuple[int, int]] = []
        text = ""
        for piece in self._with_signs(self._applied(pieces)):
            columns.append((len(text), piece.column))
            if piece.is_mark:
                mark = f"x_{{{_letters(len(marks))}}}"
                marks[mark] = piece.text[1:]
                text += f"{mark} "
            else:
                text += f"{piece.text} "
        names = {Symbol(mark): Symbol(_grouped(name)) for mark, name in marks.items()}
        return str(sstr(self._reading(text, columns, names)))

    def _reading(
        self, text: str, columns: list[tuple[int, int]], names: Mapping[Symbol, Symbol]
    ) -> Expr:
        """The only reading; raises BadFormula if there is none, or another."""
        from lark.exceptions import LarkError, UnexpectedInput
        from sympy.parsing.latex import parse_latex

        try:
            found = parse_latex(text, backend="lark")
        except UnexpectedInput as error:
            column = self._column(max(0, int(error.column) - 1), columns)
            raise self._unread(column) from error
        except (LarkError, TypeError, ValueError, AttributeError) as error:
            raise self._unread(columns[0][1] if columns else 0) from error
        readings = {r for r in _alternatives(found) if isinstance(r, Expr)}
        readings = {r.xreplace(names) for r in readings if not r.atoms(AppliedUndef)}
        if len(readings) != 1:
            start = columns[0][1] if columns else 0
            told = " or ".join(sorted(map(str, readings))[:_TOLD]) or "only as calls of quantities"
            raise self._refusal(start, f"this can be read {told}", "write \\cdot for a product")
        return readings.pop()

    def _column(self, at: int, columns: list[tuple[int, int]]) -> int:
        """Where in the source a place of the marked text is."""
        return max((c for start, c in columns if start <= at), default=0)

    def _unread(self, column: int) -> BadFormula:
        why = "the LaTeX cannot be read from here on"
        return self._refusal(column, why, "put \\cdot between factors, or write the claim as text")

    def _refusal(self, column: int, why: str, remedy: str) -> BadFormula:
        return BadFormula(self.where, self.text, column, why, remedy)


_NOTHING = _Piece("", 0)


def _inverse(pieces: list[_Piece]) -> str:
    r"""The function that \sin^{-1} and its like are by custom; empty if these are none."""
    texts = [piece.text for piece in pieces]
    if texts[1:] not in (["^", "{", "-", "=1", "}"],):
        return ""
    return {r"\sin": "asin", r"\cos": "acos", r"\tan": "atan"}.get(texts[0], "")


def _letters(number: int) -> str:
    """aa, ab, ...: the parser reads letters in a subscript, and one digit at most."""
    first, second = divmod(number, 26)
    return chr(ord("a") + first) + chr(ord("a") + second)


def _grouped(name: str) -> str:
    """A number in parentheses where it is no plain integer, so that no power mistakes it."""
    return name if re.fullmatch(r"[A-Za-z_]\w*|[0-9]+|[a-z]+\(.*\)", name) else f"({name})"


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


def _starts_factor(piece: _Piece) -> bool:
    return piece.is_mark or piece.text in (*_CLOSING, "|", r"\sqrt", *_FRACTIONS)


def _is_one(piece: _Piece) -> bool:
    """Whether TeX takes it as a whole where there are no braces."""
    return piece.is_mark and piece.size == 1


def _alternatives(found: object) -> Iterator[object]:
    """Every reading of an ambiguous text."""
    if type(found).__name__ != "Tree":
        yield found
        return
    for child in found.children:  # type: ignore[attr-defined]
        yield from _alternatives(child)


def _demand_parser(where: str) -> None:
    if find_spec("lark") is None:
        raise BadClaimsFile(
            where,
            "LaTeX is read by way of lark, which is not installed",
            "install contact-derive[latex], or write the claim as text",
        )
