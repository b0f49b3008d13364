"""Docstrings as reStructuredText: numpydoc sections, formulas in Python's notation, lists of names.

The docstrings are written to be read in a terminal.  Before napoleon reads them, an indented block
becomes a literal block, a list of names with their meanings becomes a list of fields, and the
characters that reStructuredText would interpret are escaped.
"""

import inspect
import re
from collections.abc import Collection, Iterator
from enum import EnumType
from itertools import groupby

_SPECIAL = re.compile(
    r"``(?P<shown>.+?)``|`(?P<code>[^`]+)`"
    r"|(?<=[\w)\]])(?:\*\*\((?P<power>[^()]+)\)|(?:\*\*|\^)(?P<exponent>\w+))"
    r"|(?P<escaped>[\\*|`]|(?<=\w)_(?!\w))"
)
_NAMES = re.compile(r"(?P<names>\w+(?:, \w+)*)(?:: | +)(?P<meaning>\S.*)")


def inline(text: str) -> str:
    r"""A line of prose, with powers raised and special characters escaped.

    >>> print(inline("|K_T| s**(3/2) of `slip_zone`, E*"))
    \|K_T\| s\ :sup:`3/2`\  of ``slip_zone``, E\*
    """

    def shown(match: re.Match[str]) -> str:
        if code := match["shown"] or match["code"]:
            return f"``{code}``"
        if power := match["power"] or match["exponent"]:
            return rf"\ :sup:`{power}`\ "
        return rf"\{match['escaped']}"

    return _SPECIAL.sub(shown, text)


def names_of(obj: object) -> Collection[str]:
    """The parameters, fields or members that a docstring may list."""
    if isinstance(obj, EnumType):
        return obj.__members__
    try:
        return inspect.signature(obj).parameters  # type: ignore[arg-type]
    except (TypeError, ValueError):
        return ()


def restructured(lines: list[str], names: Collection[str], label: str) -> list[str]:
    """The lines of a docstring as numpydoc sections in reStructuredText.

    names: parameters, fields or members of the object
    label: what they are called
    """
    text: list[str] = []
    section = ""
    for paragraph in _paragraphs(lines):
        if len(paragraph) > 1 and re.fullmatch("-{3,}", paragraph[1]):
            section = paragraph[0]
            text += paragraph[:2]
            paragraph = paragraph[2:]
        if section == "Examples" or paragraph[0].startswith(">>>"):
            text += paragraph
        elif section not in ("", "Notes"):  # names and types are read by napoleon
            text += [line if line[:1] != " " else inline(line) for line in paragraph]
        elif fields := _fields(paragraph, names):
            text += [f":{label}:", *(f"   {line}" for line in fields)]
        elif paragraph[0].startswith(" "):
            text += [".. code-block:: text", "", *(f"   {line}" for line in paragraph)]
        else:
            text += [inline(line) for line in paragraph]
        text.append("")
    return text


def _paragraphs(lines: list[str]) -> Iterator[list[str]]:
    """Groups of lines between blank lines."""
    for filled, group in groupby(lines, key=lambda line: bool(line.strip())):
        if filled:
            yield list(group)


def _fields(paragraph: list[str], names: Collection[str]) -> list[str]:
    """The paragraph as a list of names and meanings, or nothing if it is anything else."""
    indent = len(paragraph[0]) - len(paragraph[0].lstrip())
    fields: list[str] = []
    for line in paragraph:
        if line[indent : indent + 1] == " ":
            fields.append(f"  {inline(line.strip())}")
            continue
        found = _NAMES.fullmatch(line[indent:])
        if found is None or not set(found["names"].split(", ")) <= {*names}:
            return []
        fields.append(f"* **{found['names']}** -- {inline(found['meaning'].strip())}")
    return fields


def label_of(obj: object) -> str:
    """What the names in a docstring are called."""
    if isinstance(obj, EnumType):
        return "Members"
    return "Fields" if inspect.isclass(obj) and issubclass(obj, tuple) else "Parameters"
