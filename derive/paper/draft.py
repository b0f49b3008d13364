"""A claims file drafted from the displays of a paper: nothing in it is judged before a person has
accepted what was understood and said what the symbols are.
"""

import os
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

from sympy import Symbol

from derive.errors import BadClaimsFile, BadFormula
from derive.limit import LimitReached, within
from derive.paper.displays import Display, displays
from derive.paper.formula import Names, equation
from derive.paper.latex import Latex
from derive.paper.lines import quoted
from derive.paper.spellings import proposal, spellings
from derive.paper.statements import Statement, statements

_SECONDS = 10.0
"""Seconds that the reading of one equation may take."""
_KNOWN = frozenset({"E_star", "f", "x", "s", "xi"})
"""Names that a claims file has from the start."""


@dataclass(frozen=True)
class _Part:
    """One statement of a display, as it is written down."""

    display: Display
    number: int
    count: int
    understood: str
    why: str


@dataclass
class Draft:
    """What was read of a paper.

    environments  displays of the file
    read          those of which at least one statement was read
    """

    name: str
    environments: int
    spelled: dict[str, str] = field(default_factory=dict)
    parts: list[_Part] = field(default_factory=list)

    @property
    def unread(self) -> list[str]:
        """Place and reason of every statement that could not be read."""
        return [f"{self._place(p)}: {p.why}" for p in self.parts if not p.understood]

    @property
    def understood(self) -> int:
        """Statements that were read."""
        return sum(bool(part.understood) for part in self.parts)

    def _place(self, part: _Part) -> str:
        number = f"eq. ({part.display.number}), " if part.display.number else ""
        return f"{number}{self.name}:{part.display.line}"

    def text(self) -> str:
        """The claims file."""
        lines = [
            f"title = {_text(self.name)}",
            "# body = ...               # whose formulas the symbols may be, such as hertz",
            "",
            "[variables]                # drawn at random, as R = 'radius'",
            "",
            "[symbols]                  # write a formula, or move it to [variables]",
        ]
        lines += [f"{name} = {_proposed(name)}" for name in self._names()]
        lines += ["", "[latex]"]
        lines += [f"{quoted(spelled)} = {quoted(name)}" for spelled, name in self.spelled.items()]
        if self.unread:
            lines += ["", "# Not read:", *(f"#   {_line(each)}" for each in self.unread)]
        labels = Counter[str]()
        for part in self.parts:
            lines += ["", *self._claim(part, labels)]
        return "\n".join([*lines, ""])

    def _names(self) -> list[str]:
        return [n for n in dict.fromkeys(self.spelled.values()) if n not in _KNOWN]

    def _claim(self, part: _Part, labels: Counter[str]) -> list[str]:
        display = part.display
        label = display.label or (f"({display.number})" if display.number else "")
        label = _line(label or f"line {display.line}")
        label += f"/{part.number}" if part.count > 1 else ""
        labels[label] += 1
        label += f" [{labels[label]}]" if labels[label] > 1 else ""
        lines = [
            "[[claims]]",
            f"label = {_text(label)}",
            f"place = {_text(self._place(part))}",
            f"latex = {_text(display.latex)}",
        ]
        if part.number:
            lines.append(f"part = {part.number}")
        if part.understood:
            lines += [f"understood = {_text(part.understood)}", "accepted = false"]
        if part.why:
            lines.append(f"unchecked = {_text(_line(part.why))}")
        return lines


def draft(path: Path) -> Draft:
    """What can be read of a LaTeX file; raises BadClaimsFile if its displays cannot be told."""
    found, environments = displays(path)
    if not found:
        raise BadClaimsFile(str(path), "has no displayed equation", "give a paper in LaTeX")
    made = Draft(path.name, environments)
    known = list[tuple[Display, list[Statement], str]]()
    for display in found:
        try:
            known.append((display, statements(path.name, display.latex), ""))
        except (BadFormula, RecursionError) as error:
            known.append((display, [], getattr(error, "why", "nested too deep")))
    for _, each, _ in known:
        for statement in each:
            if r"\begin" not in statement.latex:
                made.spelled.update(spellings(statement.latex))
    for display, each, why in known:
        if not each:
            made.parts.append(_Part(display, 0, 1, "", why or "no relation stands in it"))
        for number, statement in enumerate(each, 1):
            understood, reason = _read(statement, made.spelled)
            made.parts.append(_Part(display, number, len(each), understood, reason))
    return made


def _read(statement: Statement, spelled: dict[str, str]) -> tuple[str, str]:
    """The statement as text, and why it is not judged, if it is not."""
    if statement.why and not statement.is_rough:
        return "", statement.why
    try:
        with within(_SECONDS):
            understood = Latex("the draft", statement.latex, spelled).understood()
            if not statement.is_rough:
                equation(understood, Names("", {n: Symbol(n) for n in spelled.values()}, {}))
    except BadFormula as error:
        return "", f"{error.why}: {error.remedy}"
    except LimitReached:
        return "", f"not read within {_SECONDS:g} s"
    except RecursionError:
        return "", "nested too deep"
    return understood, statement.why


def write(made: Draft, path: Path) -> None:
    """Write a draft where no file is; raises BadClaimsFile."""
    try:
        handle = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666)
    except OSError as error:
        why = f"cannot be written ({error.strerror})"
        raise BadClaimsFile(str(path), why, "name a new file by --draft") from error
    with os.fdopen(handle, "w", encoding="utf-8") as file:
        file.write(made.text())


def _proposed(name: str) -> str:
    formula, meaning = proposal(name)
    given = {"proposal": formula, "meaning": meaning}
    inside = ", ".join(f"{key} = {_text(text)}" for key, text in given.items() if text)
    return f"{{ {inside} }}" if inside else '""'


def _line(text: str) -> str:
    return " ".join("".join(c if c.isprintable() else " " for c in text).split())


def _text(text: str) -> str:
    """A text in TOML, verbatim where that can be."""
    text = "".join(c if c.isprintable() or c in "\n\t" else " " for c in text)
    if "'" not in text and "\n" not in text:
        return f"'{text}'"
    if "'''" not in text and "\n" in text and not text.endswith("'"):
        return f"'''\n{text}'''"
    return quoted(text)
