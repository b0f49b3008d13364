r"""The displays of a LaTeX file, in their order, numbered as LaTeX numbers them."""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from derive.errors import BadClaimsFile
from derive.files import Unreadable, bytes_of

_LARGEST = 5_000_000
"""Bytes of a LaTeX file."""
_MOST = 500
"""Displays of a file."""
_ONE = ("equation", "multline", "displaymath", "math")
_ROWS = ("align", "alignat", "flalign", "gather", "eqnarray")
_START = re.compile(
    rf"\\begin\s*\{{((?:{'|'.join((*_ONE, *_ROWS))})\*?|subequations)\}}"
    r"|\\end\s*\{(subequations)\}|(?<!\\)(\\\[)|(?<!\\)(\$\$)"
)
_LABEL = re.compile(r"\\label\s*\{([^{}]*)\}")
_TAG = re.compile(r"\\tag\*?\s*\{([^{}]*)\}")
_UNNUMBERED = re.compile(r"\\(?:nonumber|notag)(?![A-Za-z])")
_MACRO = re.compile(
    r"\\(?:(?:re|provide)?newcommand|DeclareMathOperator)\*?\s*\{?\s*(\\[A-Za-z]+)\s*\}?"
    r"\s*(?:\[([1-9])\])?\s*(?=\{)|\\def\s*(\\[A-Za-z]+)\s*(?=\{)"
)
_INLINE = re.compile(r"(?<![\\$])\$([^$]+)(?<!\\)\$|\\\((.+?)\\\)", re.DOTALL)
_RELATION = re.compile(
    r"[^\s{(]\s*(?:=|<|>|\\(?:sim|simeq|approx|leq?|geq?)(?![A-Za-z]))\s*[^\s})]"
)
_LONGEST_LINE = 300
"""Characters of a statement in the text."""
_EXPANDED = 20_000
"""Characters that a display may have once its macros are written out."""
_PASSES = 10
"""Macros inside each other that are written out."""


@dataclass(frozen=True)
class Display:
    """One display, or of several rows those that go together.

    number  as printed, without parentheses; "" where it has none
    labels  of \\label, in their order
    line    of the file, from 1
    latex   as it stands, comments left out and macros written out
    """

    number: str
    labels: tuple[str, ...]
    line: int
    latex: str


@dataclass(frozen=True)
class Source:
    """A LaTeX file as it is read.

    found         displays, and statements of the text where they are asked for
    environments  how many displays there are
    text          without comments
    """

    found: list[Display]
    environments: int
    text: str


def displays(path: Path, inline: bool = False) -> Source:
    """The displays of a file, and relations in its lines if asked; raises BadClaimsFile."""
    text = _without_comments(_text(path))
    start = max(text.find(r"\begin{document}"), 0)
    macros = _macros(text[:start])
    found, environments, between, done = list[Display](), 0, list[tuple[int, int]](), start
    for body, kind, at, numbers, outer in _bodies(str(path), text, start):
        environments += 1
        if environments > _MOST:
            raise BadClaimsFile(str(path), f"has more than {_MOST} displays", "split it")
        between.append((done, outer[0]))
        done = outer[1]
        for offset, latex, number in _groups(body, kind, numbers):
            labels = tuple(each[1] for each in _LABEL.finditer(latex))
            line = text.count("\n", 0, at + offset) + 1
            found.append(Display(number, labels, line, _expanded(latex, macros).strip()))
    if inline:
        for one, other in [*between, (done, len(text))]:
            for each in _INLINE.finditer(text, one, other):
                latex = each[1] or each[2]
                if _RELATION.search(latex) and len(latex) < _LONGEST_LINE:
                    line = text.count("\n", 0, each.start()) + 1
                    found.append(Display("", (), line, _expanded(latex, macros).strip()))
        found = sorted(found, key=lambda each: each.line)[:_MOST]
    return Source(found, environments, text)


def _text(path: Path) -> str:
    try:
        return bytes_of(path, _LARGEST).decode("utf-8-sig").replace("\r\n", "\n")
    except UnicodeDecodeError as error:
        raise BadClaimsFile(str(path), "is no text in UTF-8", "convert it") from error
    except Unreadable as error:
        raise BadClaimsFile(str(path), str(error), "give a LaTeX file") from error


def _without_comments(text: str) -> str:
    """The text with comments left out, each line where it was."""
    return re.sub(r"(?<!\\)((?:\\\\)*)%[^\n]*", r"\1", text)


def _macros(text: str) -> dict[str, tuple[int, str]]:
    """Macros with how many arguments they take, and what they are written out as."""
    found = {}
    for each in _MACRO.finditer(text):
        end = _closed(text, each.end())
        body = text[each.end() + 1 : end - 1]
        if "DeclareMathOperator" in each[0]:
            body = rf"\operatorname{{{body}}}"
        found[each[1] or each[3]] = (int(each[2] or 0), body)
    return found


def _closed(text: str, at: int) -> int:
    """Where the group in braces, or the one token, that starts at a place ends."""
    if text[at : at + 1] != "{":
        found = re.match(r"\\[A-Za-z]+|.", text[at:], re.DOTALL)
        return at + (found.end() if found else 0)
    depth = 0
    for found in re.finditer(r"(?<!\\)[{}]", text[at:]):
        depth += 1 if found[0] == "{" else -1
        if depth == 0:
            return at + found.end()
    return len(text)


def _expanded(latex: str, macros: dict[str, tuple[int, str]]) -> str:
    """Macros written out, as far as the display does not become too long."""
    for _ in range(_PASSES):
        made, place = list[str](), 0
        for found in re.finditer(r"\\[A-Za-z]+", latex):
            if found.start() < place or found[0] not in macros:
                continue
            count, body = macros[found[0]]
            end = found.end()
            for n in range(1, count + 1):
                start = end + len(latex[end:]) - len(latex[end:].lstrip())
                end = _closed(latex, start)
                given = latex[start:end]
                inner = given[1:-1] if given[:1] == "{" else given
                body = body.replace(f"#{n}", inner)
            after = " " if not count and latex[end : end + 1].isalpha() else ""
            made += [latex[place : found.start()], body, after]
            place = end
        if not made:
            break
        made.append(latex[place:])
        if sum(map(len, made)) > _EXPANDED:
            break
        latex = "".join(made)
    return latex


class _Numbers:
    """The counter of equations."""

    def __init__(self) -> None:
        self.count, self.letter, self.inside = 0, 0, False

    def next(self) -> str:
        """The next number, 3 or, in subequations, 3a."""
        if self.inside:
            self.letter += 1
            return f"{self.count}{chr(ord('a') + (self.letter - 1) % 26)}"
        self.count += 1
        return str(self.count)


def _bodies(
    name: str, text: str, start: int
) -> Iterator[tuple[str, str, int, _Numbers, tuple[int, int]]]:
    """What stands in each display, its kind, where, the counter, and where all of it stands."""
    numbers, place = _Numbers(), start
    while found := _START.search(text, place):
        place = found.end()
        if found[1] == "subequations":
            numbers.count, numbers.letter, numbers.inside = numbers.count + 1, 0, True
            continue
        if found[2]:
            numbers.inside = False
            continue
        kind = found[1] or "*"
        close = rf"\end{{{kind}}}" if found[1] else (r"\]" if found[3] else "$$")
        end = text.find(close, place)
        if end < 0:
            line = text.count("\n", 0, found.start()) + 1
            raise BadClaimsFile(f"{name}:{line}", f"{found[0]} is not closed", f"add {close}")
        if kind.startswith("alignat") and (columns := re.match(r"\s*\{\d+\}", text[place:end])):
            place += columns.end()
        yield text[place:end], kind, place, numbers, (found.start(), end + len(close))
        place = end + len(close)


def _groups(body: str, kind: str, numbers: _Numbers) -> Iterator[tuple[int, str, str]]:
    """Rows that go together, each with where it begins and its number, 18 or 18, 19."""
    starred = kind.endswith("*")
    if kind.rstrip("*") not in _ROWS:
        yield 0, body, _number(body, starred, numbers)
        return
    begin, told = 0, list[str]()
    rows = list(_rows(body))
    for n, (start, end) in enumerate(rows):
        if n and _begins(body[start:end]):
            yield begin, body[begin:start].removesuffix(r"\\"), ", ".join(filter(None, told))
            begin, told = start, []
        if body[start:end].strip():
            told.append(_number(body[start:end], starred, numbers))
    if body[begin:].strip():
        yield begin, body[begin:], ", ".join(filter(None, told))


def _begins(row: str) -> bool:
    """Whether a row has a left side of its own and does not go on with the row before."""
    plain = re.sub(r"&|\\[,;:! ]|\s", " ", row).strip()
    if re.match(r"=|<|>|\+|-|\\(?:sim|simeq|approx|leq?|geq?)(?![A-Za-z])", plain):
        return False
    return bool(re.search(r"=|<|>|\\(?:sim|simeq|approx|leq?|geq?)(?![A-Za-z])", plain))


def _rows(body: str) -> Iterator[tuple[int, int]]:
    """Where the rows are, those of inner environments left whole."""
    start, depth = 0, 0
    for found in re.finditer(r"\\begin(?![A-Za-z])|\\end(?![A-Za-z])|\\\\", body):
        if found[0] == r"\\":
            if depth == 0:
                yield start, found.end()
                start = found.end()
        else:
            depth += 1 if found[0] == r"\begin" else -1
    if body[start:].strip():
        yield start, len(body)


def _number(row: str, starred: bool, numbers: _Numbers) -> str:
    if tag := _TAG.search(row):
        return tag[1]
    return "" if starred or _UNNUMBERED.search(row) else numbers.next()
