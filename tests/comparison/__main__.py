"""Write notebooks/comparison.md.

python -m tests.comparison
"""

from pathlib import Path

from tests.comparison import around, table
from tests.comparison.cases import EVERY
from tests.reference.parallel import at_once

TABLE = Path(__file__).parents[2] / "notebooks" / "comparison.md"


def main() -> None:
    """Compute all cycles, on all cores, and write the tables."""
    with at_once(len(EVERY) + len(around.CYCLES)) as work:
        parts = [
            table.markdown(work(table.row, EVERY)),
            around.markdown(work(around.row, around.CYCLES)),
        ]
    TABLE.write_text("\n".join(parts), encoding="utf-8")


if __name__ == "__main__":
    main()
