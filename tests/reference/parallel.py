"""Many cycles at once, with a progress bar."""

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from contextlib import contextmanager
from typing import Any

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

Work = Callable[[Callable[[Any], Any], Sequence[Any]], list[Any]]
"""A function that works like `map`; results are in the order of the items."""


@contextmanager
def at_once(total: int, jobs: int | None = None) -> Iterator[Work]:
    """Distribute work over `jobs` processes, by default one per core; the bar ends at `total`."""
    columns = TextColumn("cycles"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn()
    with (
        Progress(*columns, console=Console(stderr=True)) as progress,
        ProcessPoolExecutor(jobs) as processes,
    ):
        task = progress.add_task("", total=total)

        def work(function: Callable[[Any], Any], items: Sequence[Any]) -> list[Any]:
            begun = [processes.submit(function, item) for item in items]
            for _ in as_completed(begun):
                progress.advance(task)
            return [each.result() for each in begun]

        yield work
