"""Pages of figures in Markdown."""

from collections.abc import Iterable, Sequence
from pathlib import Path


def table(head: Sequence[str], rows: Iterable[Sequence[str]], words: int = 1) -> str:
    """A table whose first columns are words; numbers are aligned right.

    ValueError if a row has a wrong number of cells.

    >>> print(table(["case", "n"], [["a", "1"]]))
    | case | n |
    | --- | ---: |
    | a | 1 |
    """
    rule = ["---"] * words + ["---:"] * (len(head) - words)
    lines = [head, rule, *rows]
    if {len(line) for line in lines} != {len(head)}:
        raise ValueError(f"every row must have {len(head)} cells: {', '.join(head)}")
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def write(path: Path, *parts: str) -> None:
    """Print the parts of a page, an empty line between them, and write them to the file."""
    text = "\n\n".join(part.strip() for part in parts) + "\n"
    path.write_text(text, encoding="utf-8")
    print(text)
