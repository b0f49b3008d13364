"""Find the lines of the claims in a TOML file, and change single lines of a claim.

Only table headers and keys at the start of a line are recognised.  The caller parses the new text
as TOML to check that the change is the intended one.
"""

import re
from collections.abc import Mapping

_HEAD = re.compile(r"\s*\[\[\s*claims\s*\]\]")
_TABLE = re.compile(r"\s*\[")


def _outside(lines: list[str]) -> list[str]:
    """Return the lines, without those that continue a text over several lines."""
    made, inside = list[str](), ""
    for line in lines:
        made.append("" if inside else line)
        if inside:
            inside = "" if inside in line else inside
        elif opened := re.match(r"[^#]*?('''|\"\"\")", line):
            inside = "" if opened[1] in line[opened.end() :] else opened[1]
    return made


def heads(text: str, count: int) -> list[int] | None:
    """Return the lines of all [[claims]] headers, counted from 1.

    The result is None if their number is not `count`.
    """
    lines = _outside(text.splitlines())
    numbers = [n for n, line in enumerate(lines, 1) if _HEAD.match(line)]
    return numbers if len(numbers) == count else None


def line_of(text: str, table: str, name: str) -> int | None:
    """Return the line of a name in a table of the file, such as [symbols]."""
    inside = False
    for n, line in enumerate(_outside(text.splitlines()), 1):
        if _TABLE.match(line):
            inside = line.partition("#")[0].strip().strip("[] ") == table
        elif inside and re.match(rf"\s*[\"']?{re.escape(name)}[\"']?\s*=", line):
            return n
    return None


def with_lines(text: str, count: int, wanted: Mapping[int, str]) -> str | None:
    """Set the entry `understood` of claims, which are identified by their numbers, counted from 1.

    An existing line `understood = ...` is replaced.  Otherwise a new line is inserted before the
    blank lines and comments at the end of the claim.  The result is None if the claims cannot be
    located.
    """
    starts = heads(text, count)
    if starts is None:
        return None
    lines = text.splitlines(keepends=True)
    if lines and not lines[-1].endswith("\n"):
        lines[-1] += "\n"
    keys = _outside(lines)
    for number in sorted(wanted, reverse=True):
        start = starts[number - 1]
        end = next((n for n in range(start, len(lines)) if _TABLE.match(keys[n])), len(lines))
        _put(lines, start, end, f"understood = {quoted(wanted[number])}\n")
    return "".join(lines)


def _put(lines: list[str], start: int, end: int, line: str) -> None:
    keys = _outside(lines[start:end])
    for n, key in enumerate(keys, start):
        if re.match(r"\s*accepted\s*=\s*false", key):
            lines[n] = lines[n].replace("false", "true", 1)
    for n, key in enumerate(keys, start):
        if re.match(r"\s*understood\s*=", key):
            lines[n] = line
            return
    while end > start and (not lines[end - 1].strip() or lines[end - 1].lstrip().startswith("#")):
        end -= 1
    lines.insert(end, line)


def quoted(text: str) -> str:
    """Write a text as a basic string of TOML."""
    escaped = text.replace("\\", "\\\\").replace('"', '\\"')
    return '"' + escaped.replace("\n", "\\n").replace("\t", "\\t") + '"'
