r"""Find the displays of a LaTeX file, in order, and number them as LaTeX does."""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from derive.command.errors import BadClaimsFile
from derive.command.files import Unreadable, bytes_of

_LARGEST = 5_000_000
"""The largest size of a LaTeX file, in bytes."""
_MOST = 500
"""The largest number of displays in a file."""
_ONE = ("equation", "multline", "displaymath", "math")
_ROWS = ("align", "alignat", "flalign", "gather", "eqnarray")
_START = re.compile(
    rf"\\begin\s*\{{((?:{'|'.join((*_ONE, *_ROWS))})\*?|subequations)\}}"
    r"|\\end\s*\{(subequations)\}|(?<!\\)(\\\[)|(?<!\\)(\$\$)"
)
LABEL = re.compile(r"\\label\s*\{([^{}]*)\}")
"""The label of an equation."""
_TAG = re.compile(r"\\tag\*?\s*\{([^{}]*)\}|\\l?eqno(?![A-Za-z])\s*\(?([^(){}$]*)")
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
"""A formula in the text must have fewer characters than this."""
_EXPANDED = 20_000
"""The largest number of characters in a display after its macros are expanded."""
_LONGEST_COMMAND = 80
"""The largest number of characters in a command."""
_PASSES = 10
"""The largest nesting depth of macros that are expanded."""


@dataclass(frozen=True)
class Display:
    """One display, or those rows of a display that belong together.

    number  the printed number without parentheses; empty if there is none
    labels  the arguments of \\label, in order
    line    the line of the file, counted from 1
    latex   the source, without comments and with macros expanded
    """

    number: str
    labels: tuple[str, ...]
    line: int
    latex: str


@dataclass(frozen=True)
class Source:
    """The content of a LaTeX file.

    found         the displays, and the relations in the text if they were requested
    environments  the number of displays
    text          the source without comments
    """

    found: list[Display]
    environments: int
    text: str


def displays(path: Path, inline: bool = False) -> Source:
    """Return the displays of a file and, if `inline` is true, the relations in its text.

    Raises BadClaimsFile.
    """
    text = _without_comments(_text(path))
    start = max(text.find(r"\begin{document}"), 0)
    macros = _macros(text[:start])
    collected, environments, gaps, text_start = list[Display](), 0, list[tuple[int, int]](), start
    for body, kind, offset_of_body, numbers, span in _bodies(str(path), text, start):
        environments += 1
        if environments > _MOST:
            why = f"the file has more than {_MOST} displays"
            raise BadClaimsFile(str(path), why, "split it into smaller files")
        gaps.append((text_start, span[0]))
        text_start = span[1]
        for offset, latex, number in _groups(body, kind, numbers):
            labels = tuple(each[1] for each in LABEL.finditer(latex))
            line = text.count("\n", 0, offset_of_body + offset) + 1
            collected.append(Display(number, labels, line, _expanded(latex, macros).strip()))
    if inline:
        for start_of_text, end_of_text in [*gaps, (text_start, len(text))]:
            for each in _INLINE.finditer(text, start_of_text, end_of_text):
                latex = each[1] or each[2]
                if _RELATION.search(latex) and len(latex) < _LONGEST_LINE:
                    line = text.count("\n", 0, each.start()) + 1
                    collected.append(Display("", (), line, _expanded(latex, macros).strip()))
        collected = sorted(collected, key=lambda each: each.line)[:_MOST]
    return Source(collected, environments, text)


def _text(path: Path) -> str:
    try:
        return bytes_of(path, _LARGEST).decode("utf-8-sig").replace("\r\n", "\n")
    except UnicodeDecodeError as error:
        why = "the file is not UTF-8 text"
        raise BadClaimsFile(str(path), why, "convert it to UTF-8") from error
    except Unreadable as error:
        raise BadClaimsFile(str(path), str(error), "give a LaTeX file") from error


def _without_comments(text: str) -> str:
    """Remove comments and keep every line break."""
    return re.sub(r"(?<!\\)((?:\\\\)*)%[^\n]*", r"\1", text)


def _macros(text: str) -> dict[str, tuple[int, str]]:
    """Return the number of arguments and the replacement text of every macro."""
    macros = {}
    for each in _MACRO.finditer(text):
        end = _closed(text, each.end())
        body = text[each.end() + 1 : end - 1]
        if "DeclareMathOperator" in each[0]:
            body = rf"\operatorname{{{body}}}"
        macros[each[1] or each[3]] = (int(each[2] or 0), body)
    return macros


def _closed(text: str, at: int) -> int:
    """Return the end of the braced group or the single token that starts at `at`."""
    if text[at : at + 1] != "{":
        match = re.match(r"\\[A-Za-z]+|.", text[at:], re.DOTALL)
        return at + (match.end() if match else 0)
    depth = 0
    for match in re.finditer(r"(?<!\\)[{}]", text[at:]):
        depth += 1 if match[0] == "{" else -1
        if depth == 0:
            return at + match.end()
    return len(text)


def _expanded(latex: str, macros: dict[str, tuple[int, str]]) -> str:
    """Expand macros, as long as the display does not become too long."""
    for _ in range(_PASSES):
        parts, position = list[str](), 0
        for match in re.finditer(r"\\[A-Za-z]+", latex):
            if match.start() < position or match[0] not in macros:
                continue
            count, body = macros[match[0]]
            end, given = match.end(), list[str]()
            for _argument in range(count):
                start = end + len(latex[end:]) - len(latex[end:].lstrip())
                end = _closed(latex, start)
                one = latex[start:end]
                given.append(one[1:-1] if one[:1] == "{" else one)
            parts += [latex[position : match.start()], *_filled(body, given)]
            position = end
        if not parts:
            break
        parts.append(latex[position:])
        if sum(map(len, parts)) > _EXPANDED:
            break
        latex = _together(parts)
    return latex


def _filled(body: str, given: list[str]) -> list[str]:
    """Return the replacement text of a macro, in pieces, with its arguments."""
    pieces = re.split(r"#([1-9])", body)
    return [
        piece if n % 2 == 0 else (given[int(piece) - 1] if int(piece) <= len(given) else "")
        for n, piece in enumerate(pieces)
    ]


def _together(parts: list[str]) -> str:
    """Join texts, with a space where a letter would lengthen the command before it."""
    joined = ""
    for part in parts:
        is_glued = part[:1].isalpha() and re.search(r"\\[A-Za-z]+$", joined[-_LONGEST_COMMAND:])
        joined += f" {part}" if is_glued else part
    return joined


class _Numbers:
    """The equation counter."""

    def __init__(self) -> None:
        self.count, self.letter, self.inside = 0, 0, False

    def next(self) -> str:
        """Return the next number, such as 3 or, inside subequations, 3a."""
        if self.inside:
            self.letter += 1
            return f"{self.count}{chr(ord('a') + (self.letter - 1) % 26)}"
        self.count += 1
        return str(self.count)


def _bodies(
    name: str, text: str, start: int
) -> Iterator[tuple[str, str, int, _Numbers, tuple[int, int]]]:
    """Yield the body, kind and start of each display, the counter, and the whole span."""
    numbers, position = _Numbers(), start
    while opening := _START.search(text, position):
        position = opening.end()
        if opening[1] == "subequations":
            numbers.count, numbers.letter, numbers.inside = numbers.count + 1, 0, True
            continue
        if opening[2]:
            numbers.inside = False
            continue
        kind = opening[1] or "*"
        close = rf"\end{{{kind}}}" if opening[1] else (r"\]" if opening[3] else "$$")
        end = text.find(close, position)
        if end < 0:
            line = text.count("\n", 0, opening.start()) + 1
            why = f"{opening[0]} is not closed"
            raise BadClaimsFile(f"{name}:{line}", why, f"add {close}")
        if kind.startswith("alignat") and (columns := re.match(r"\s*\{\d+\}", text[position:end])):
            position += columns.end()
        yield text[position:end], kind, position, numbers, (opening.start(), end + len(close))
        position = end + len(close)


def _groups(body: str, kind: str, numbers: _Numbers) -> Iterator[tuple[int, str, str]]:
    """Yield the rows that belong together, as start, body and numbers, such as "18, 19"."""
    starred = kind.endswith("*")
    if kind.rstrip("*") not in _ROWS:
        yield 0, body, _number(body, starred, numbers)
        return
    begin, row_numbers = 0, list[str]()
    rows = list(rows_of(body))
    for n, (start, end) in enumerate(rows):
        if n and _begins(body[start:end]):
            yield begin, body[begin:start].removesuffix(r"\\"), ", ".join(filter(None, row_numbers))
            begin, row_numbers = start, []
        if body[start:end].strip():
            row_numbers.append(_number(body[start:end], starred, numbers))
    if body[begin:].strip():
        yield begin, body[begin:], ", ".join(filter(None, row_numbers))


def _begins(row: str) -> bool:
    """Whether a row has its own left side and does not continue the row before it."""
    plain = re.sub(r"&|\\[,;:! ]|\s", " ", row).strip()
    if re.match(r"=|<|>|\+|-|\\(?:sim|simeq|approx|leq?|geq?)(?![A-Za-z])", plain):
        return False
    return bool(re.search(r"=|<|>|\\(?:sim|simeq|approx|leq?|geq?)(?![A-Za-z])", plain))


def rows_of(body: str) -> Iterator[tuple[int, int]]:
    """Yield the spans of the rows of a display; inner environments are not split."""
    start, depth = 0, 0
    for match in re.finditer(r"\\begin(?![A-Za-z])|\\end(?![A-Za-z])|\\\\", body):
        if match[0] == r"\\":
            if depth == 0:
                yield start, match.end()
                start = match.end()
        else:
            depth += 1 if match[0] == r"\begin" else -1
    if body[start:].strip():
        yield start, len(body)


def _number(row: str, starred: bool, numbers: _Numbers) -> str:
    if tag := _TAG.search(row):
        return (tag[1] or tag[2] or "").strip()
    return "" if starred or _UNNUMBERED.search(row) else numbers.next()
