"""Terminal output: text and tables, errors, and a spinner or progress bar for long tasks.

In:  texts and renderable objects of the library rich.
Out: lines on standard output; errors, spinners and progress bars on standard error.
"""

import os
import shlex
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager, suppress
from pathlib import Path
from shutil import get_terminal_size, which
from textwrap import fill
from threading import Timer

import click
from rich.console import Console, RenderableType
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    ProgressColumn,
    SpinnerColumn,
    TextColumn,
    TimeElapsedColumn,
)

_WIDE = 10_000
"""Width, in columns, of output that does not go to a terminal, if COLUMNS is not set: large enough
that no line is broken before another program reads it."""

PATIENCE = 10.0
"""Seconds after which a line says what is taking so long, if standard error is not a terminal."""


def status(words: str) -> AbstractContextManager[object]:
    """A spinner with a caption."""
    return _moving((SpinnerColumn(), _CAPTION), words, None)


@contextmanager
def progress(bodies: int, stages: Sequence[str]) -> Iterator[Callable[[str, str], None]]:
    """A progress bar; the yielded function tells it which stage a body enters.

    An empty stage says that the body is finished; any other word only changes the caption.
    """
    columns = (_CAPTION, BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    with _moving(columns, "starting", bodies * len(stages)) as update:
        passed: dict[str, int] = {}
        at_work: dict[str, str] = {}

        def step(body: str, stage: str) -> None:
            at_work.pop(body, None)
            if stage:
                at_work[body] = stage
            if stage in stages or not stage:
                passed[body] = stages.index(stage) if stage else len(stages)
            *others, last = at_work.items() or [(body, "finishing")]
            more = f", {len(others)} more in progress" if others else ""
            update(": ".join(last) + more, sum(passed.values()))

        yield step


_CAPTION = TextColumn("{task.description}")


@contextmanager
def _moving(
    columns: Sequence[ProgressColumn], words: str, total: int | None
) -> Iterator[Callable[[str, int], None]]:
    """A moving line on a terminal; elsewhere, one line says after a while what takes so long."""
    console = _console(stderr=True)
    now = [words]
    timer = Timer(PATIENCE, lambda: remark(f"Still working after {PATIENCE:g} s: {now[0]}"))
    timer.daemon = True
    if not console.is_terminal:
        timer.start()
    bar = Progress(*columns, console=console, transient=True, disable=not console.is_terminal)
    try:
        with bar:
            task = bar.add_task(words, total=total)

            def update(words: str, completed: int) -> None:
                now[0] = words
                bar.update(task, description=words, completed=completed)

            yield update
    finally:
        timer.cancel()


def _console(stderr: bool = False) -> Console:
    """A console: FORCE_COLOR also colours piped output, but progress is shown on terminals only."""
    stream = sys.stderr if stderr else sys.stdout
    is_terminal = stream is not None and stream.isatty()
    return Console(
        stderr=stderr,
        force_terminal=False if stderr and not is_terminal else None,
        width=None if is_terminal or os.environ.get("COLUMNS") else _WIDE,
        highlight=False,
        markup=False,
        emoji=False,
    )


def output(what: RenderableType) -> None:
    """Print a table or a sheet, without trailing blanks; COLUMNS also applies to pipes."""
    console = _console()
    with console.capture() as printed:
        console.print(what)
    text = "\n".join(line.rstrip() for line in printed.get().split("\n"))
    click.echo(text, nl=False, color=console.color_system is not None)


_WIDEST, _NARROWEST = 96, 20
"""Limits of the width of a line of text, in columns."""


def folded(line: str) -> str:
    """A line of text, which continues with an indent where it is too long; obeys COLUMNS."""
    columns = get_terminal_size((_WIDEST, 0)).columns
    return fill(
        line,
        max(min(columns, _WIDEST), _NARROWEST),
        subsequent_indent="    ",
        break_long_words=False,
        break_on_hyphens=False,
    )


def complain(what: str, message: str) -> None:
    """Print on standard error what went wrong."""
    remark(f"{click.style(f'{what}:', fg='red', bold=True)} {message}")


def remark(words: str) -> None:
    """Print on standard error, unless that is closed or full."""
    with suppress(OSError, ValueError):
        click.echo(words, err=True)


def command() -> str:
    """This command as the user can type it: derive, .venv/bin/derive, or python -m derive."""
    called = Path(sys.argv[0])
    if called.parent == Path(__file__).parents[1]:  # python -m derive
        return f"{typed(Path(sys.orig_argv[0]))} -m derive"
    if called.stem != "derive":  # called by another program
        return "derive"
    return typed(called)


def typed(program: Path) -> str:
    """The name of a program if the shell finds it by that name, otherwise its shortest path."""
    found = which(program.name)
    if found and Path(found).absolute() == program.absolute():
        return shlex.quote(program.name)
    if program.parent == Path():
        return shlex.quote(str(program))
    return shlex.quote(path_of(program.absolute()))


def path_of(path: Path) -> str:
    """A path as the user would type it."""
    here = Path.cwd()
    return str(path.relative_to(here) if path.is_relative_to(here) else path)
