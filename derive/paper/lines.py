"""Where the claims of a TOML file stand, and the same file with lines of a claim changed.

Only heads and keys that stand at the start of a line are seen; what TOML itself reads of the result
decides whether a change was made as it was meant.
"""

import re
from collections.abc import Mapping

_HEAD = re.compile(r"\s*\[\[\s*claims\s*\]\]")
_TABLE = re.compile(r"\s*\[")


def heads(text: str, count: int) -> list[int] | None:
    """The lines of all [[claims]], counted from 1; None where they cannot be told."""
    found = [n for n, line in enumerate(text.splitlines(), 1) if _HEAD.match(line)]
    return found if len(found) == count else None


def line_of(text: str, table: str, name: str) -> int | None:
    """The line of a name in a table of the file, such as [symbols]."""
    inside = False
    for n, line in enumerate(text.splitlines(), 1):
        if _TABLE.match(line):
            inside = line.partition("#")[0].strip().strip("[] ") == table
        elif inside and re.match(rf"\s*[\"']?{re.escape(name)}[\"']?\s*=", line):
            return n
    return None


def with_lines(text: str, count: int, wanted: Mapping[int, str]) -> str | None:
    """The text with `understood` of claims, by their number from 1; None if it cannot be done.

    A line `understood = ...` is replaced; where there is none, one is written before the blank
    lines and comments at the claim's end.
    """
    at = heads(text, count)
    if at is None:
        return None
    lines = text.splitlines(keepends=True)
    if lines and not lines[-1].endswith("\n"):
        lines[-1] += "\n"
    for number in sorted(wanted, reverse=True):
        start = at[number - 1]
        end = next((n for n in range(start, len(lines)) if _TABLE.match(lines[n])), len(lines))
        _put(lines, start, end, f"understood = {quoted(wanted[number])}\n")
    return "".join(lines)


def _put(lines: list[str], start: int, end: int, line: str) -> None:
    for n in range(start, end):
        if re.match(r"\s*accepted\s*=\s*false", lines[n]):
            lines[n] = lines[n].replace("false", "true", 1)
    for n in range(start, end):
        if re.match(r"\s*understood\s*=", lines[n]):
            lines[n] = line
            return
    while end > start and (not lines[end - 1].strip() or lines[end - 1].lstrip().startswith("#")):
        end -= 1
    lines.insert(end, line)


def quoted(text: str) -> str:
    """A text as TOML's basic string."""
    escaped = text.replace("\\", "\\\\").replace('"', '\\"')
    return '"' + escaped.replace("\n", "\\n").replace("\t", "\\t") + '"'
