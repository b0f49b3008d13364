"""Draft a claims file from the displays of a paper.

No claim in the draft is judged before a user has accepted its reading and defined its symbols.
"""

import os
import re
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any

import tomlkit
from sympy import Expr, Integral, Mul, Symbol, degree, denom, solve, together

from derive.check.meanings import NONE, Standard
from derive.command.errors import BadClaimsFile, BadFormula
from derive.command.files import demand_writable, refused_as, write_new
from derive.command.limit import LimitReached, within
from derive.reading.displays import LABEL, Display, displays
from derive.reading.formula import (
    Names,
    UnknownName,
    approach,
    condition,
    equation,
    may_be_rounded,
    unknown,
    usable,
)
from derive.reading.latex import Latex
from derive.reading.lexer import Token, plain
from derive.reading.spellings import functions_in, spellings, unclear_call
from derive.reading.statements import Statement, remarks, statements
from derive.reading.substitution import substitution

_SECONDS = 10.0
"""The time limit for reading one equation, in seconds."""
_SHOWN = 4
_LONGEST = 80
"""The largest number of words and characters of LaTeX that show where an error occurred."""
_unwritable = partial(BadClaimsFile, remedy="give the name of a new file with --draft")

_HEAD = """title = ""

# Four answers give the paper's letters their standard meanings: the body (`derive list`), whether
# the contact is symmetric, the elastic constants, and the letters that differ from ours.  A line
# of yours in [symbols] or [variables] beats a standard meaning.  Write a formula for each "" in
# [symbols], such as h = '(a + c)/2', or move the symbol to [variables].
{answers}

[variables]                # positive, unless they have a range, such as t = {{ low = 0, high = 1 }}

[symbols]

[latex]
"""
_EXAMPLE: dict[str, Any] = {
    "symmetric": True,
    "modulus": "E_star",
    "letters": {"m": "b", "f": r"\mu"},
}
"""The table [paper] that stands in the draft as a comment until the user answers."""
_FUNCTION = re.compile(r"(a?)(sin|cos|tan|sinh|cosh|tanh)\((\w+)\)")
_DEFINES = (":=", r"\equiv", r"\coloneqq", r"\triangleq")


@dataclass
class Draft:
    """The content of a paper that was read.

    environments  the number of displays in the file
    answers       the body and the table [paper]; empty if the user has not answered
    standard      the standard meanings that follow from the answers
    spelled       the LaTeX of each symbol -> its name
    defined       the definitions in the paper that may be meanings, each with its place
    claims        the entries of each claim in the file; a `note` becomes a comment
    seen          the names that have occurred so far
    """

    name: str
    environments: int
    answers: tuple[str, dict[str, Any]] | tuple[()] = ()
    standard: Standard = NONE
    spelled: dict[str, str] = field(default_factory=dict)
    defined: dict[str, dict[str, str]] = field(default_factory=dict)
    claims: list[dict[str, Any]] = field(default_factory=list)
    seen: set[str] = field(default_factory=set)

    def told(self, key: str) -> list[str]:
        """All entries `unchecked` or `note` of claims, each with its place in the paper."""
        return [f"{each['place']}: {each[key]}" for each in self.claims if key in each]

    @property
    def understood(self) -> int:
        """The number of statements that were read."""
        return sum("understood" in each for each in self.claims)

    @property
    def known(self) -> frozenset[str]:
        """The names that every claims file with these answers knows."""
        return frozenset({"x", "s", "xi", *self.standard.letters.values()})

    def meant(self) -> dict[str, str]:
        """The standard formulas of the paper's symbols."""
        return {n: entry["is"] for n, entry in self.standard.of({*self.spelled.values()}).items()}

    def open(self) -> dict[str, dict[str, str]]:
        """The symbols without a meaning, with what the paper says of each."""
        known = self.known | self.meant().keys()
        return {n: self.defined.get(n, {}) for n in self.spelled.values() if n not in known}

    def note_definition(self, entries: dict[str, Any], is_stated: bool) -> None:
        """Propose an equation as a meaning if it defines a letter that stands alone on the left.

        It does so if the letter has not occurred before, or if the paper states it.
        """
        left, _, right = entries.get("understood", "").partition(" = ")
        names = set(re.findall(r"[A-Za-z]\w*", f"{left} {right}"))
        if found := _FUNCTION.fullmatch(left):
            left, right = found[3], f"{'' if found[1] else 'a'}{found[2]}({right})"
        is_whole = right and not entries.keys() & {"require", "as", "unchecked"}
        is_new = usable(left) and left not in {*re.findall(r"\w+", right), *self.defined}
        if is_whole and is_new and (is_stated or left not in self.seen):
            self.defined[left] = {"proposal": right, "meaning": entries["place"]}
        self.seen |= names

    def drop_bound(self) -> None:
        """Drop the symbols that are bound by an integral, sum or limit."""
        entries = [each.get(key, "") for each in self.claims for key in ("understood", "require")]
        entries += [side for each in self.claims for side in each.get("as", "").split("->")]
        held = {name for text in entries for name in re.findall(r"\w+", text)}
        free = {name for text in entries for name in unknown(text, Names("", {}, {}))}
        free |= {a for name in self.spelled.values() for a in name.partition("_at_")[2].split("_")}
        kept = free | self.known | (set(self.spelled.values()) - held)
        self.spelled = {spelled: n for spelled, n in self.spelled.items() if n in kept}

    def add_defined(self, spelled: Mapping[str, str]) -> None:
        """Add the symbols of the text that the definitions of other symbols need."""
        names = [*self.spelled.values()]
        for name in names:
            used = re.findall(r"\w+", self.defined.get(name, {}).get("proposal", ""))
            names += [each for each in used if each in spelled.values() and each not in names]
        self.spelled = {latex: n for latex, n in spelled.items() if n in names} | self.spelled

    def _answered(self) -> str:
        """The answers of the user as lines of the file, or an example as a comment."""
        body, paper = self.answers or ("hertz", _EXAMPLE)
        letters = (f"{n} = {_toml(each).as_string()}" for n, each in paper["letters"].items())
        lines = [
            f"body = '{body}'",
            "[paper]",
            f"symmetric = {str(paper['symmetric']).lower()}",
            f"modulus = '{paper['modulus']}'",
            f"letters = {{ {', '.join(letters)} }}",
        ]
        return "\n".join(lines if self.answers else (f"# {line}" for line in lines))

    def text(self) -> str:
        """The text of the claims file."""
        made = tomlkit.parse(_HEAD.format(answers=self._answered()))
        made["title"], symbols, latex = _toml(self.name), made["symbols"], made["latex"]
        for name, given in self.open().items():
            symbols[name] = tomlkit.inline_table() if given else ""
            for key, entry in given.items():
                symbols[name][key] = entry
        for spelled, name in self.spelled.items():
            latex[spelled] = name
        if unread := self.told("unchecked"):
            for line in ("These statements were not read, or not completely:", *unread):
                latex.add(tomlkit.comment(line))
        claims = tomlkit.aot()
        for each in self.claims:
            claims.append(table := tomlkit.table())
            for key, entry in each.items():
                if key == "note":
                    table.add(tomlkit.comment(entry))
                else:
                    table.add(key, _toml(entry))
        made["claims"] = claims
        return tomlkit.dumps(made)


def draft_claims(
    path: Path,
    inline: bool = False,
    answers: tuple[str, dict[str, Any]] | tuple[()] = (),
    standard: Standard = NONE,
) -> Draft:
    """Read a LaTeX file; raise BadClaimsFile if its displays cannot be found.

    inline: whether the relations in the text are read as well
    answers, standard: the user's answers, and the meanings that follow from them
    """
    source = displays(path, inline)
    if not source.found:
        why = "the file has no displayed equations"
        raise BadClaimsFile(str(path), why, "give a paper in LaTeX")
    made = Draft(path.name, source.environments, answers, standard)
    ordered = sorted([*source.found, *source.definitions], key=lambda each: each.line)
    known = [(each, _statements(path.name, each)) for each in ordered]
    printed, asides = list[list[Token]](), list[list[Token]]()
    for display, statement in ((d, each) for d, found in known for each in found if not each.why):
        formulas = asides if display in source.definitions else printed
        formulas += [statement.tokens, *statement.conditions]
    functions, in_text = functions_in(printed), dict[str, str]()
    for formulas, spelled in ((printed, made.spelled), (asides, in_text)):
        for tokens in formulas:
            spelled.update(spellings(tokens, functions))
    used = Counter[str]()
    for display, found in known:
        is_aside = display in source.definitions
        spelled = {**in_text, **made.spelled} if is_aside else made.spelled
        reader = Latex("the draft", display.latex, spelled)
        labels = [_label(display, each) for each in found]
        for part, (label, statement) in enumerate(zip(labels, found, strict=True), 1):
            label += f"/{labels[:part].count(label)}" if labels.count(label) > 1 else ""
            used[label] += 1
            label += f" [{used[label]}]" if used[label] > 1 else ""
            place = f"statement {part}, {path.name}" if len(found) > 1 else path.name
            entries = _printed(display, label, place, part if statement.tokens else 0)
            entries |= _entries(reader, statement, functions)
            made.note_definition(entries, is_aside or _is_stated(display.latex, statement))
            if not is_aside:
                made.claims.append(entries)
    made.drop_bound()
    made.add_defined(in_text)
    return made


def _statements(name: str, display: Display) -> list[Statement]:
    """Return the statements of a display, or one that says why there are none."""
    try:
        return statements(name, display.latex) or [Statement([], why="it has no relation")]
    except BadFormula as error:
        return [Statement([], why=_told(error))]


def _is_stated(latex: str, statement: Statement) -> bool:
    r"""Whether a statement is printed with := or \equiv, or after the word where."""
    start = statement.tokens[0].at if statement.tokens else 0
    is_sign = any(latex.startswith(_DEFINES, t.at) for t in statement.tokens if not t.depth)
    return is_sign or re.search(r"\bwhere\b[^=]*$", latex[:start]) is not None


def _label(display: Display, statement: Statement) -> str:
    """Return the label of a statement's row, or of its display."""
    end, number = statement.tokens[-1].at if statement.tokens else 0, display.number
    row = display.latex[:end].rpartition(r"\\")[2] + display.latex[end:].partition(r"\\")[0]
    own = f"({number})" if number else f"line {display.line}"
    return _line(", ".join(LABEL.findall(row) or display.labels) or own)


def _printed(display: Display, label: str, place: str, part: int) -> dict[str, Any]:
    """Return what is printed, and where."""
    found = {
        "label": label,
        "place": f"eq. ({display.number}), " * bool(display.number) + f"{place}:{display.line}",
        "says": _line(", ".join(remarks(display.latex))),
        "latex": display.latex,
        "part": part,
    }
    return {key: entry for key, entry in found.items() if entry}


def _entries(reader: Latex, statement: Statement, functions: set[str]) -> dict[str, Any]:
    """Read a statement and its conditions; give the reason if it cannot be judged."""
    names, why = Names("", {n: Symbol(n) for n in reader.spellings.values()}, {}), statement.why
    found = dict[str, Any]()
    if not why and (called := unclear_call(statement.tokens, functions)):
        why = f"{called} is a function elsewhere, so it is unclear whether it is a factor here"
        why += ": write the claim as text"
    try:
        with within(_SECONDS):
            if not why:
                understood = reader.read("equation", statement.tokens)
                left, _, right = equation(understood, names, rough=statement.is_rough)
                found |= {"understood": understood, "accepted": False}
                found |= _pole(left, right) or _substitution(left, right)
    except BadFormula as error:
        why = _told(error)
    except LimitReached:
        why = "" if found else f"it could not be read within {_SECONDS:g} s"
    conditions, unclear = _conditions(statement, reader, names)
    found |= conditions
    is_exact = not statement.is_rough or may_be_rounded(found.get("understood", ""))
    if not (unclear or is_exact or "as" in conditions):
        unclear = "it is an approximation: add its limit, such as as = 'x -> 0', or write it with ="
    return found | ({"unchecked": _line(why or unclear)} if why or unclear else {})


def _told(error: BadFormula) -> str:
    """Return the reason for an error, with the LaTeX where it occurred."""
    if isinstance(error, UnknownName):
        return error.why
    shown = " ".join(error.given[error.column :].split()[:_SHOWN])[:_LONGEST]
    return f"{error.why}{f', at `{shown}`' if shown else ''}: {error.remedy}"


def _pole(left: Expr, right: Expr) -> dict[str, str]:
    """Note an integral whose integrand may have a pole between its limits."""
    for over in sorted(left.atoms(Integral) | right.atoms(Integral), key=str):
        along, low, high = over.limits[0]
        for factor in Mul.make_args(denom(together(over.function))):
            if not (factor.is_polynomial(along) and degree(factor, along) == 1):
                continue
            pole = solve(factor, along)[0]
            inside = not pole.is_number or low.could_extract_minus_sign()
            if inside and pole not in (low, high):
                note = rf"\int may run over a pole at {along} = {pole}: if a principal value is "
                return {"note": note + r"meant, write \fint for \int in `latex`"}
    return {}


def _substitution(left: Expr, right: Expr) -> dict[str, str]:
    """Note an equation that introduces an angle, with the line that defines it."""
    if not (found := substitution(left, right)):
        return {}
    angle, value = found
    line = f"{angle} = {{ is = '{value}' }}"
    return {"note": f"if this substitution defines {angle}, write {line} under [symbols]"}


def _conditions(statement: Statement, reader: Latex, names: Names) -> tuple[dict[str, Any], str]:
    """Return the entries for the conditions and the limit, and the reason if this fails."""
    told, limits, small = list[str](), list[str](), statement.small
    for each in statement.conditions:
        try:
            if any(token.type == "TO" for token in each):
                limits.append(reader.read("approach", each))
                approach(limits[-1], names)
            else:
                told.append(reader.read("conditions", each))
                condition(told[-1], names)
        except BadFormula:
            why = f"its condition {plain(each)} could not be read: write it in `require` or in `as`"
            return {}, why
    found: dict[str, Any] = {"require": " and ".join(told)} if told else {}
    if statement.order:
        limits.append(f"{reader.spellings.get(small, small)} -> 0")
    if len(set(limits)) > 1:
        return found, f"it holds in several limits, {', '.join(limits)}: put one in `as`"
    order = int(statement.order) if statement.order.is_integer() else statement.order
    entries = {"as": "".join(limits[:1]), "order": order}
    return found | {key: entry for key, entry in entries.items() if entry}, ""


def demand_new(path: Path) -> None:
    """Raise BadClaimsFile if no new file can be written here; call this before a long task."""
    with refused_as(_unwritable, path):
        demand_writable(path)
    if os.path.lexists(path):
        raise _unwritable(str(path), "already exists")


def write(made: Draft, path: Path) -> None:
    """Write a draft to a new file; raises BadClaimsFile."""
    with refused_as(_unwritable, path):
        write_new(made.text().encode(), path)


def _line(text: str) -> str:
    return " ".join("".join(c if c.isprintable() else " " for c in text).split())


def _toml(entry: Any) -> Any:
    """Write a text as a literal string if possible, so that LaTeX stays legible."""
    if not isinstance(entry, str):
        return entry
    text = "".join(c if c.isprintable() or c in "\n\t" else " " for c in entry)
    if "'" not in text and "\n" not in text:
        return tomlkit.string(text, literal=True)
    if "'''" in text or text.endswith("'"):
        return tomlkit.string(text)
    return tomlkit.string(text, literal=True, multiline=True)
