r"""The displays of a LaTeX file, in their order, numbered as LaTeX numbers them."""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from derive.errors import BadClaimsFile

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
_MACRO = re.compile(r"\\(?:re)?newcommand\*?\s*\{?(\\[A-Za-z]+)\}?\s*\{((?:[^{}]|\{[^{}]*\})*)\}")


@dataclass(frozen=True)
class Display:
    """One display, or of several rows those that go together.

    number  as printed, without parentheses; "" where it has none
    label   of \\label; "" where it has none
    line    of the file, from 1
    latex   as it stands, comments left out and macros without arguments written out
    """

    number: str
    label: str
    line: int
    latex: str


def displays(path: Path) -> tuple[list[Display], int]:
    """The displays of a file and how many environments they are; raises BadClaimsFile."""
    text = _without_comments(_text(path))
    start = text.find(r"\begin{document}")
    macros = dict(_MACRO.findall(text[: max(start, 0)]))
    found, environments = list[Display](), 0
    for body, kind, at, numbers in _bodies(str(path), text, max(start, 0)):
        environments += 1
        if environments > _MOST:
            raise BadClaimsFile(str(path), f"has more than {_MOST} displays", "split it")
        for offset, latex, number in _groups(body, kind, numbers):
            label = _LABEL.search(latex)
            shown = _expanded(latex, macros).strip()
            line = text.count("\n", 0, at + offset) + 1
            found.append(Display(number, label[1] if label else "", line, shown))
    return found, environments


def _text(path: Path) -> str:
    try:
        if path.stat().st_size > _LARGEST:
            raise BadClaimsFile(str(path), f"is larger than {_LARGEST} bytes", "split it")
        return path.read_bytes().decode("utf-8-sig").replace("\r\n", "\n")
    except UnicodeDecodeError as error:
        raise BadClaimsFile(str(path), "is no text in UTF-8", "convert it") from error
    except (OSError, ValueError) as error:
        why = getattr(error, "strerror", None) or str(error)
        raise BadClaimsFile(str(path), f"cannot be read ({why})", "give a LaTeX file") from error


def _without_comments(text: str) -> str:
    """The text with comments left out, each line where it was."""
    return re.sub(r"(?<!\\)((?:\\\\)*)%[^\n]*", r"\1", text)


def _expanded(latex: str, macros: dict[str, str]) -> str:
    """Macros without arguments written out, once: one inside another stays as it is."""
    return re.sub(r"\\[A-Za-z]+", lambda found: macros.get(found[0], found[0]), latex)


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


def _bodies(name: str, text: str, start: int) -> Iterator[tuple[str, str, int, _Numbers]]:
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
        yield text[place:end], kind, place, numbers
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
