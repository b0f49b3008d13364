"""Write notebooks/comparison.md.

python -m tests.measure.comparison
"""

from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

from tests.measure.comparison import around, table
from tests.measure.comparison.cases import EVERY

TABLE = Path(__file__).parents[3] / "notebooks" / "comparison.md"


def main() -> None:
    """Compute all cycles, on all cores, and write the tables."""
    with ProcessPoolExecutor() as pool:
        parts = [
            table.markdown(pool.map(table.row, EVERY)),
            around.markdown(pool.map(around.row, around.CYCLES)),
        ]
    TABLE.write_text("\n".join(parts), encoding="utf-8")


if __name__ == "__main__":
    main()
