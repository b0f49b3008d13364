"""Write notebooks/comparison.md.

python -m tests.comparison
"""

from pathlib import Path

from rich.progress import Progress

from tests.comparison.cases import EVERY
from tests.comparison.table import table

TABLE = Path(__file__).parents[2] / "notebooks" / "comparison.md"


def main() -> None:
    """All cycles, one after the other."""
    with Progress() as progress:
        task = progress.add_task("cycles", total=len(EVERY))
        text = table(EVERY, lambda name: progress.advance(task))
    TABLE.write_text(text, encoding="utf-8")
    print(text)


if __name__ == "__main__":
    main()
