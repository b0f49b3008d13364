"""Docstrings as reStructuredText: numpydoc sections, formulas, Python's notation.

The docstrings are written to be read in a terminal.  Before napoleon reads them, formulas in prose
are typeset, an indented block of Python's notation becomes a literal block, any other indented
block keeps its lines, and the characters that reStructuredText would interpret are escaped.
"""

import ast
import re
from collections.abc import Iterator
from html import unescape
from itertools import groupby
from textwrap import dedent

from derive.sheet.prose import prose

_CODE = re.compile(r"``(.+?)``|`([^`]+)`")
_SPECIAL = re.compile(r"<(su[bp])>(.*?)</su[bp]>|([\\*|`]|(?<=\w)_(?!\w))")


def inline(text: str) -> str:
    r"""A line of prose, with its formulas typeset and special characters escaped.

    >>> print(inline("|K_T| s**(3/2) of `slip_zone`, E*"))
    \|K\ :sub:`T`\ \| s\ :sup:`3/2`\  of ``slip_zone``, E\*
    """
    pieces, end = [], 0
    for code in _CODE.finditer(text):
        pieces += [_typeset(text[end : code.start()]), f"``{code[1] or code[2]}``"]
        end = code.end()
    return "".join([*pieces, _typeset(text[end:])])


def _typeset(text: str) -> str:
    def shown(match: re.Match[str]) -> str:
        role, words, character = match.groups()
        return rf"\ :{role}:`{words}`\ " if role else rf"\{character}"

    return _SPECIAL.sub(shown, unescape(prose(text)))


def restructured(lines: list[str]) -> list[str]:
    """The lines of a docstring as numpydoc sections in reStructuredText."""
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
        elif paragraph[0].startswith(" "):
            text += _block(dedent("\n".join(paragraph)).splitlines())
        else:
            text += [inline(line) for line in paragraph]
        text.append("")
    return text


def _block(lines: list[str]) -> list[str]:
    """An indented block: code if it is Python's notation, otherwise lines of prose.

    A line that is indented further continues the one before it.
    """
    if _is_python("\n".join(lines)):
        return [".. code-block:: text", "", *(f"   {line}" for line in lines)]
    return [f"{'  ' if line[:1] == ' ' else '| '}{inline(line.strip())}" for line in lines]


def _is_python(text: str) -> bool:
    try:
        ast.parse(re.sub(r"\n +", " ", text))
    except SyntaxError:
        return False
    return True


def _paragraphs(lines: list[str]) -> Iterator[list[str]]:
    """Groups of lines between blank lines."""
    for filled, group in groupby(lines, key=lambda line: bool(line.strip())):
        if filled:
            yield list(group)
