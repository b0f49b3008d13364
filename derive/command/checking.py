"""What `derive check` does before it judges claims: drafts, readings, and the choice of claims."""

from dataclasses import replace
from difflib import get_close_matches
from pathlib import Path

import click

from derive.check.accept import accept, demand_writable
from derive.check.claim import Paper
from derive.check.draft import demand_new, draft_claims, write
from derive.check.userfile import built_in, open_readings, read_claims
from derive.command.terminal import path_of, status

_ALIKE = 8
"""Number of names that a message about an unknown claim shows."""


def write_draft(file: Path | None, new: Path, inline: bool) -> None:
    """Read the displayed equations of a paper and write them as claims."""
    if file is None:
        raise click.UsageError("--draft reads a paper: give FILE, in LaTeX")
    demand_new(new)
    with status("reading the displayed equations"):
        made = draft_claims(file, inline)
    write(made, new)
    symbols = made.names().values()
    named = sum(map(bool, symbols))
    click.echo(f"{made.environments} displayed equations with {len(made.claims)} statements")
    click.echo(f"Wrote {path_of(new.absolute())}: {made.understood} statements read")
    click.echo(f"{len(symbols)} symbols, {named} with a proposed meaning")
    for line in made.told("unchecked"):
        click.echo(f"not read: {line}")
    for line in made.told("note"):
        click.echo(f"note: {line}")


def accept_readings(file: Path | None, label: str | None) -> None:
    """Show each reading that is not yet accepted, then write those that the user accepts."""
    if file is None or label is not None:
        raise click.UsageError("--accept needs a claims file, without --explain: give FILE alone")
    demand_writable(file)
    found = open_readings(file)
    readings = [reading for reading in found if reading.understood]
    accepted = []
    for number, reading in enumerate(readings, 1):
        click.echo(f"\n{number} of {len(readings)}: {reading.entry.label}")
        click.echo(f"  LaTeX       {reading.entry.latex.strip()}")
        click.echo(f"  understood  {reading.understood}")
        if reading.accepted:
            click.echo(f"  in the file {reading.accepted}")
        for key, entry in reading.entry.beside.items():
            click.echo(f"  {key:<11} {entry}")
        if reading.why:
            click.echo(f"  unchecked   {reading.why}")
        answer = click.prompt("Is this what is printed? (y, n, q)", default="n").strip().lower()
        if answer == "q":
            break
        if answer == "y":
            accepted.append(reading)
        elif answer != "n":
            click.echo(f"  not accepted, because {answer!r} is not y")
    if accepted:
        accept(file, accepted)
    left = len(readings) - len(accepted)
    click.echo(f"{len(accepted)} accepted, {left} left")
    for reading in found:
        if not reading.understood:
            click.echo(f"unchecked: {reading.entry.label}: {reading.why}")


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
