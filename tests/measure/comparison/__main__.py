"""`make comparison`: compute all cycles, on all cores, and write notebooks/comparison.md."""

from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

from tests.measure import page
from tests.measure.comparison import around, table
from tests.measure.comparison.cases import EVERY

TABLE = Path(__file__).parents[3] / "notebooks" / "comparison.md"

if __name__ == "__main__":
    with ProcessPoolExecutor() as pool:
        every = [line for row in pool.map(table.row, EVERY) for line in table.shown(row)]
        near = map(around.shown, pool.map(around.row, around.CYCLES))
        page.write(
            TABLE,
            *(table.TEXT, page.table(table.HEAD, every, words=2)),
            *(around.TEXT, page.table(around.HEAD, near, words=0)),
        )
