"""What `derive check` does before it judges claims: drafts, readings, and the choice of claims."""

import re
import sys
from collections.abc import Mapping
from dataclasses import replace
from difflib import get_close_matches
from pathlib import Path
from typing import Any

import click

from derive.body.library import library, load_geometry
from derive.check.accept import accept, demand_writable
from derive.check.claim import Paper
from derive.check.draft import draft_claims
from derive.check.meanings import NONE, Standard, standard
from derive.check.schema import MODULI, Answers, Place, decoded
from derive.check.userfile import built_in, read_claims, read_file
from derive.command.errors import UserError
from derive.command.files import demand_page, put_page
from derive.command.options import parse_name_values
from derive.command.terminal import command, folded, path_of, status, typed

_ALIKE = 8
"""Number of names that a message about an unknown claim shows."""


def write_draft(file: Path | None, new: Path, inline: bool) -> None:
    """Read the displayed equations of a paper and write them as claims."""
    if file is None:
        raise click.UsageError("--draft reads a paper: give FILE, in LaTeX")
    demand_page(new, "--draft", mark=None)
    meanings = _answers()
    with status("reading the displayed equations"):
        made = draft_claims(file, inline, meanings)
    put_page(made.text, new, "--draft", mark=None)
    click.echo(f"{made.environments} displayed equations with {len(made.claims)} statements")
    click.echo(f"Wrote {path_of(new.absolute())}: {made.understood} statements read")
    meant, left = made.meant, made.open
    for name, formula in meant.items():
        click.echo(f"meaning: {name} = {formula}")
    proposed = sum(map(bool, left.values()))
    click.echo(f"{len(meant)} symbols with a standard meaning, {len(left)} without")
    if proposed:
        click.echo(f"{proposed} of them with a definition in the paper, to be accepted by you")
    if not meanings.answers:
        click.echo(f"Next, answer the four questions at the top of {path_of(new.absolute())}")
    elif left:
        why = meanings.reasons(left)
        click.echo(f"Next, give meanings in [symbols] or [variables] to {', '.join(left)}{why}")
    for line in made.unread:
        click.echo(f"not read: {line}")


def _answers() -> Standard:
    """Ask what the paper's letters mean; no answers if the user does not say."""

    def meanings(letters: str) -> Standard:
        try:
            given = re.split(r",(?=\s*\w+\s*=)", letters) if letters.strip() else []
            paper["letters"] = parse_name_values("letters", given)
            here = Place("[paper]")
            return standard(decoded(Answers, paper, here), load_geometry(body), here)
        except UserError as error:
            raise click.BadParameter(str(error)) from error

    try:
        click.echo("Four answers fill in the standard meanings of the paper's letters.")
        bodies = ["none", *library()]
        asked = f"1. Body, or none to fill in the file by hand ({', '.join(bodies)})"
        body = _answer(asked, click.Choice(bodies), "none")
        if body == "none":
            return NONE
        paper: dict[str, Any] = {"symmetric": _answer("2. Symmetric contact? (y, n)", click.BOOL)}
        asked = f"3. Elastic constants ({'; '.join(MODULI)})"
        paper["modulus"] = _answer(asked, click.Choice(MODULI), "E_star")
        ours, others = (_told(meanings(letters)) for letters in ("", "n = n"))
        click.echo(folded(f"Our letters: {'; '.join(ours)}"))
        if off := [each for each in others if each not in ours]:
            where = "If the stick zone is off the middle, by its ends or by d and e"
            click.echo(folded(f"{where}: {'; '.join(off)}"))
        asked = r"4. Letters of the paper that differ, such as m = b, f = \mu"
        chosen = _answer(asked, meanings, "")
    except click.Abort:
        return NONE
    return chosen


def _told(ours: Standard) -> list[str]:
    """Our letters with their meanings."""
    entries = (*ours.variables.items(), *ours.symbols.items())
    return [f"{letter}, {entry.meaning}" for letter, entry in entries]


def _answer(question: str, kind: Any, default: str | None = None) -> Any:
    """Ask until the answer is of its kind; what does not come from a terminal is shown."""

    def converted(text: str) -> Any:
        if not sys.stdin.isatty():
            click.echo(text)
        return click.types.convert_type(kind)(text)

    shown = bool(default)
    return click.prompt(question, default, value_proc=converted, show_default=shown)


def accept_readings(file: Path | None, label: str | None) -> None:
    """Show what is not yet accepted, then write what the user accepts.

    The end of the input is the end of the questions; what was accepted before is written.
    """
    if file is None or label is not None:
        raise click.UsageError("--accept needs a claims file, without --explain: give FILE alone")
    demand_writable(file)
    paper, declared = read_file(file)
    for name, variable in declared.variables.items():
        click.echo(f"variable: {name}, {variable.meaning}")
    for name, symbol in declared.standard.items():
        click.echo(f"standard meaning: {name} = {symbol.text}, {symbol.meaning}")
    readings = {claim.entry.label: claim for claim in paper.claims if claim.to_accept}
    proposals = {
        name: {"defined at": symbol.meaning, "means": symbol.proposal}
        for name, symbol in declared.proposals.items()
    }
    meanings, printed, left = list[str](), list[str](), len(readings) + len(proposals)
    try:
        _ask("Is this its meaning?", proposals, meanings)
        _ask("Is this what is printed?", {n: c.shown for n, c in readings.items()}, printed)
    except click.Abort:  # the end of the input
        click.echo()
    finally:
        if meanings or printed:
            accept(file, {label: readings[label].text for label in printed}, meanings)
    accepted = len(meanings) + len(printed)
    click.echo(f"{accepted} accepted, {left - accepted} left")
    for claim in paper.claims:
        if claim.is_unread:
            click.echo(f"unchecked: {claim.entry.label}: {claim.unchecked}")


def _ask(question: str, shown: Mapping[str, Mapping[str, str]], accepted: list[str]) -> None:
    """Show each entry and add the name of those that the user accepts; raises Abort at the end."""
    answer = ""
    for number, (name, texts) in enumerate(shown.items(), 1):
        click.echo(f"\n{number} of {len(shown)}: {name}")
        for key, text in texts.items():
            click.echo(f"  {key:<11} {text}")
        if answer != "all":
            answer = _answer(f"{question} (y, n, all, q)", str, "n").strip().lower()
        if answer == "q":
            raise click.Abort
        if answer in ("y", "all"):
            accepted.append(name)
        elif answer != "n":
            click.echo(f"  not accepted, because {answer!r} is not y")


def next_steps(file: Path, paper: Paper) -> list[str]:
    """What to do with a draft of which nothing has been accepted yet; empty for any other file."""
    waiting = sum(bool(claim.to_accept) for claim in paper.claims)
    if not waiting or not all(claim.unchecked for claim in paper.claims):
        return []
    declared = read_file(file)[1]
    told = [f"No claim of {file} can be judged yet: {waiting} readings wait for you."]
    if declared.paper is NONE:
        told.append("Answer the four questions at the top of the file: body and the table [paper].")
    if left := [name for name, formula in declared.symbols.items() if not formula]:
        why = declared.paper.reasons(left)
        told.append(f"Give meanings in [symbols] or [variables] to {', '.join(left)}{why}.")
    return [*told, f"Then accept the readings: {command()} check {typed(file)} --accept"]


def paper_of(file: Path | None, name: str | None) -> Paper:
    """All claims of a paper, or only those with a given label, name or equation number."""
    with status("deriving the formulas for comparison with the paper"):
        source = built_in() if file is None else read_claims(file)
    if name is None:
        return source
    if not (chosen := source.called(name)):
        known = [claim.name for claim in source.claims]
        alike = get_close_matches(name, known, n=_ALIKE, cutoff=0.3) or known[:_ALIKE]
        raise click.BadParameter(
            f"none of the {len(known)} claims is named {name!r}; the most similar names are "
            f"{'; '.join(map(repr, alike))}: give one of them, or list all with `derive check`",
            param_hint="--explain",
        )
    return replace(source, claims=chosen)
