r"""Find the displays of a LaTeX file, in order, and number them as LaTeX does."""

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from derive.command.errors import BadClaimsFile
from derive.command.files import Unreadable, bytes_of
from derive.reading.statements import begins

_LARGEST = 5_000_000
"""The largest size of a LaTeX file, in bytes."""
_MOST = 500
"""The largest number of displays in a file."""
_LONGEST_LINE = 300
"""A formula in the text must have fewer characters than this."""
_NEAR = 80
"""The number of characters before a display in which the word "where" stands."""
_EXPANDED = 20_000
"""The largest number of characters in a display after its macros are expanded."""
_EXPANSIONS = 1000
"""The largest number of macros that are expanded in a display."""

_ROWS = ("align", "alignat", "flalign", "gather", "eqnarray")
_KINDS = "|".join(("equation", "multline", "displaymath", "math", *_ROWS))
_TABLES = ("tabular", "tabularx", "longtable")
_START = re.compile(
    rf"\\begin\s*\{{((?:{_KINDS}|{'|'.join(_TABLES)})\*?)\}}|(?<!\\)(\\\[)|(?<!\\)(\$\$)"
    r"|\\(begin|end)\s*\{subequations\}"
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
_WHERE = re.compile(r"\bwhere\W(?:[^.$\\]|\\[ ,])*$", re.IGNORECASE)
"""What stands before a display that is a definition."""
_MATRIX = re.compile(r"\\begin\s*\{\w*(?:matrix|array)\}")
_TITLE = re.compile(r"\\title\s*(?:\[[^]]*\])?\s*(?=\{)")
_RELATION = r"(?:=|<|>|\\(?:sim|simeq|approx|leq?|geq?)(?![A-Za-z]))"


@dataclass(frozen=True)
class Display:
    """One display, or those rows of a display that belong together.

    number      the printed number without parentheses; empty if there is none
    labels      the arguments of \\label, in order
    line        the line of the file, counted from 1
    latex       the source, without comments and with macros expanded
    is_defined  whether the word "where" stands before it
    """

    number: str
    labels: tuple[str, ...]
    line: int
    latex: str
    is_defined: bool = False


@dataclass(frozen=True)
class Source:
    """The content of a LaTeX file.

    found         the displays, tables and matrices, and the relations in the text if requested
    environments  the number of displays
    title         the title as plain text; empty if there is none
    """

    found: list[Display]
    environments: int
    title: str


@dataclass
class _Numbers:
    """The equation counter; inside subequations it also counts letters."""

    count: int = 0
    letters: Iterator[str] | None = field(default=None)

    def of(self, row: str, starred: bool) -> str:
        """Return the number of an equation, such as 3 or 3a; empty if it has none."""
        if tag := _TAG.search(row):
            return (tag[1] or tag[2] or "").strip()
        if starred or _UNNUMBERED.search(row):
            return ""
        self.count += self.letters is None
        return f"{self.count}{next(self.letters, '') if self.letters else ''}"


def displays(path: Path, inline: bool = False) -> Source:
    """Return the displays of a file and, if `inline` is true, the relations in its text.

    Raises BadClaimsFile.
    """
    text = re.sub(r"(?<!\\)((?:\\\\)*)%[^\n]*", r"\1", _text(path))
    start = max(text.find(r"\begin{document}"), 0)
    macros, found, between, count = _macros(text[:start]), list[Display](), text, 0

    def made(latex: str, at: int, number: str = "", is_defined: bool = False) -> Display:
        line, labels = text.count("\n", 0, at) + 1, tuple(LABEL.findall(latex))
        return Display(number, labels, line, _expanded(latex, macros).strip(), is_defined)

    for (before, at, end, after), kind, numbers in _bodies(str(path), text, start):
        if kind.rstrip("*") in _TABLES:
            if re.search(r"\d", text[at:end]):
                found.append(made(text[before:after], before))
            continue
        words, count = between[max(before - _NEAR, start) : before], count + 1
        between = between[:before] + " " * (after - before) + between[after:]
        if count > _MOST:
            why = f"the file has more than {_MOST} displays"
            raise BadClaimsFile(str(path), why, "split it into smaller files")
        for rows in _groups(text[at:end], kind):
            printed = (numbers.of(row, kind.endswith("*")) for row in rows)
            latex = "".join(rows).removesuffix(r"\\")
            number = ", ".join(filter(None, printed))
            found.append(made(latex, at, number, bool(_WHERE.search(words))))
            at += len("".join(rows))
    relations = list[Display]()
    for each in _INLINE.finditer(between, start):
        latex = each[1] or each[2]
        is_relation = re.search(rf"[^\s{{(]\s*{_RELATION}\s*[^\s}})]", latex)
        is_short = len(latex) < _LONGEST_LINE
        if _MATRIX.search(latex) or (inline and is_relation and is_short):
            relations.append(made(latex, each.start()))
    found += relations[: max(_MOST - len(found), 0)]
    found.sort(key=lambda each: each.line)
    return Source(found, count, _title(text, macros))


def _title(text: str, macros: Mapping[str, tuple[int, str]]) -> str:
    """Return the title of a paper without its commands, or an empty text."""
    if not (found := _TITLE.search(text)):
        return ""
    latex = _expanded(text[found.end() + 1 : _closed(text, found.end()) - 1], macros)
    latex = re.sub(r"\\(?:thanks|footnote)\s*\{[^{}]*\}", "", latex)
    latex = re.sub(r"\\([&%#_$])|\\\\|~", lambda each: each[1] or " ", latex)
    return " ".join(re.sub(r"\\[A-Za-z]+\*?|\\.|[{}$]", "", latex).split())


def _text(path: Path) -> str:
    try:
        return bytes_of(path, _LARGEST).decode("utf-8-sig").replace("\r\n", "\n")
    except UnicodeDecodeError as error:
        why = "the file is not UTF-8 text"
        raise BadClaimsFile(str(path), why, "convert it to UTF-8") from error
    except Unreadable as error:
        raise BadClaimsFile(str(path), str(error), "give a LaTeX file") from error


# ------------------------------------------------------------------ macros


def _macros(text: str) -> dict[str, tuple[int, str]]:
    """Return the number of arguments and the replacement text of every macro."""
    macros = {}
    for each in _MACRO.finditer(text):
        body = text[each.end() + 1 : _closed(text, each.end()) - 1]
        is_operator = "DeclareMathOperator" in each[0]
        body = rf"\operatorname{{{body}}}" if is_operator else body
        macros[each[1] or each[3]] = (int(each[2] or 0), body)
    return macros


def _closed(text: str, at: int) -> int:
    """Return the end of the braced group or the single token that starts at `at`."""
    if text[at : at + 1] != "{":
        match = re.compile(r"\\[A-Za-z]+|.|", re.DOTALL).match(text, at)
        return match.end() if match else at
    depth = 0
    for brace in re.compile(r"(?<!\\)[{}]").finditer(text, at):
        depth += 1 if brace[0] == "{" else -1
        if depth == 0:
            return brace.end()
    return len(text)


def _expanded(latex: str, macros: Mapping[str, tuple[int, str]]) -> str:
    """Expand macros, as long as the display does not become too long."""
    for _ in range(_EXPANSIONS):
        used = (each for each in re.finditer(r"\\[A-Za-z]+", latex) if each[0] in macros)
        if (found := next(used, None)) is None:
            break
        (count, body), end, given = macros[found[0]], found.end(), list[str]()
        for _argument in range(count):
            start = len(latex) - len(latex[end:].lstrip())
            end = _closed(latex, start)
            given.append(re.sub(r"^\{(.*)\}$", r"\1", latex[start:end], flags=re.DOTALL))
        made = latex[: found.start()]
        for n, piece in enumerate(re.split(r"#([1-9])", body)):
            made = _joined(made, "".join(given[int(piece) - 1 :][:1]) if n % 2 else piece)
        made = _joined(made, latex[end:])
        if len(made) > _EXPANDED:
            break
        latex = made
    return latex


def _joined(before: str, after: str) -> str:
    """Join texts, with a space where a letter would lengthen the command before it."""
    is_glued = after[:1].isalpha() and re.search(r"\\[A-Za-z]+$", before[-80:])
    return f"{before} {after}" if is_glued else before + after


# ------------------------------------------------------------------ displays and rows


def _bodies(
    name: str, text: str, start: int
) -> Iterator[tuple[tuple[int, int, int, int], str, _Numbers]]:
    """Yield where each display and its body begin and end, its kind, and the counter."""
    numbers, position = _Numbers(), start
    while opening := _START.search(text, position):
        position = opening.end()
        if opening[4]:
            numbers.count += opening[4] == "begin"
            numbers.letters = iter("abcdefghijklmnopqrstuvwxyz") if opening[4] == "begin" else None
            continue
        kind = opening[1] or "*"
        close = rf"\end{{{kind}}}" if opening[1] else (r"\]" if opening[2] else "$$")
        end = text.find(close, position)
        if end < 0:
            line = text.count("\n", 0, opening.start()) + 1
            raise BadClaimsFile(f"{name}:{line}", f"{opening[0]} is not closed", f"add {close}")
        if kind.startswith("alignat") and (columns := re.match(r"\s*\{\d+\}", text[position:end])):
            position += columns.end()
        yield (opening.start(), position, end, end + len(close)), kind, numbers
        position = end + len(close) if kind.rstrip("*") not in _TABLES else position


def _groups(body: str, kind: str) -> list[list[str]]:
    """Return the rows of a display, grouped by those that belong together."""
    if kind.rstrip("*") not in _ROWS:
        return [[body]]
    groups, start, depth = list[list[str]](), 0, 0
    for match in re.finditer(r"\\begin(?![A-Za-z])|\\end(?![A-Za-z])|\\\\|\Z", body):
        depth += (match[0] == r"\begin") - (match[0] == r"\end")
        row = body[start : match.end()]
        if (match[0] == r"\\" and depth == 0) or (not match[0] and row.strip()):
            if not groups or begins(row):
                groups.append([])
            groups[-1].append(row)
            start = match.end()
    return groups
