r"""Reads an equation given as LaTeX, if it can be read in one way only.

LaTeX is no formula: `f(x)` may be a call or a product, and a parser that must not fail guesses.
So the text is first cut into symbols that the claims file declares, numbers, and a few commands;
everything else is refused where it stands.  Each symbol and number becomes a plain x_{aa}, which
SymPy's parser (by lark) reads; a reading in which a declared quantity is called as a function is
no reading.  If exactly one is left it is printed as text, and read once more by derive.paper.
formula: what goes on is that text, which the claims file must accept.
"""

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from importlib.util import find_spec

from sympy import Expr, Symbol, sstr
from sympy.core.function import AppliedUndef

from derive.errors import BadClaimsFile, BadFormula
from derive.paper.claim import Relation

_LONGEST = 400
"""Characters that an equation may have: an ambiguous grammar is slow on long ones."""

_TOKEN = re.compile(
    r"\\[A-Za-z]+|\\.|[0-9]+(?:\.[0-9]+)?|[A-Za-z]|[-+*/=<>()\[\]{}^_|']|\s+|.", re.DOTALL
)
_SPACES = frozenset((r"\,", r"\;", r"\:", r"\!", r"\ ", r"\quad", r"\qquad", r"\left", r"\right"))
_CIRCULAR = (r"\sin", r"\cos", r"\tan", r"\arcsin", r"\arccos", r"\arctan")
_OTHER = (r"\sinh", r"\cosh", r"\tanh", r"\exp", r"\log", r"\ln", r"\sqrt", r"\cdot", r"\times")
_FRACTIONS = (r"\frac", r"\dfrac", r"\tfrac", r"\nicefrac")
_COMMANDS = frozenset((*_CIRCULAR, *_OTHER, *_FRACTIONS))
_PLAIN = frozenset("-+*/(){}^|[]")
_RELATIONS = {
    "=": "=",
    "<": "<",
    ">": ">",
    r"\le": "<=",
    r"\leq": "<=",
    r"\ge": ">=",
    r"\geq": ">=",
}


@dataclass(frozen=True)
class _Piece:
    """A token of LaTeX with its column."""

    text: str
    column: int


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
        sides, relation = self._halves(self._marked())
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
        while place < len(pieces):
            length, name = self._longest(pieces, place)
            if length:
                marked.append(_Piece(f"={name}", pieces[place].column))
                place += length
                continue
            marked.append(self._known(pieces[place]))
            place += 1
        return marked

    def _longest(self, pieces: list[_Piece], place: int) -> tuple[int, str]:
        """The longest declared symbol that starts here."""
        best = (0, "")
        for spelling, name in self._tokens_of_spellings():
            length = len(spelling)
            if length > best[0] and [p.text for p in pieces[place : place + length]] == spelling:
                best = (length, name)
        return best

    def _tokens_of_spellings(self) -> Iterator[tuple[list[str], str]]:
        for spelling, name in self.spellings.items():
            found = [t for t in _TOKEN.findall(spelling) if not t.isspace() and t not in _SPACES]
            yield found, name

    def _known(self, piece: _Piece) -> _Piece:
        text = piece.text
        if text[0].isdigit():
            return _Piece(f"={text}", piece.column)
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

    def _side(self, pieces: list[_Piece]) -> str:
        """One side as text."""
        marks: dict[str, str] = {}
        columns: list[tuple[int, int]] = []
        text = ""
        for piece in pieces:
            columns.append((len(text), piece.column))
            if piece.text.startswith("="):
                mark = f"x_{{{_letters(len(marks))}}}"
                marks[mark] = piece.text[1:]
                text += f"{mark} "
            else:
                text += f"{piece.text} "
        reading = self._reading(text, columns)
        names = {Symbol(mark): Symbol(_grouped(name)) for mark, name in marks.items()}
        return str(sstr(reading.xreplace(names)))

    def _reading(self, text: str, columns: list[tuple[int, int]]) -> Expr:
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
        readings = {r for r in readings if not r.atoms(AppliedUndef)}
        if len(readings) != 1:
            start = columns[0][1] if columns else 0
            told = " or ".join(sorted(map(str, readings))) or "only as calls of quantities"
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


def _letters(number: int) -> str:
    """aa, ab, ...: the parser reads letters in a subscript, and one digit at most."""
    first, second = divmod(number, 26)
    return chr(ord("a") + first) + chr(ord("a") + second)


def _grouped(name: str) -> str:
    """A number in parentheses where it is no plain integer, so that no power mistakes it."""
    return name if re.fullmatch(r"[A-Za-z_]\w*|[0-9]+", name) else f"({name})"


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
