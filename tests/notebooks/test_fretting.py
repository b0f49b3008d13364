"""The fretting study under other tables and constants than its own: "replace them by your own"."""

import sys
from collections.abc import Iterator
from typing import Any

import matplotlib
import numpy as np
import pytest
from matplotlib import pyplot

from notebooks import common, running

HEAD = "name,cycles,P_1,P_2,M_1,M_2,Q_1,Q_2,sigma_1,sigma_2"
OWN = (
    "start-stop,8000,0.90,1.20,-60,90,0.05,0.30,0,80",
    "manoeuvre,40000,1.10,1.20,60,90,0.20,0.30,60,95",
    "taxi,15000,1.10,1.20,60,90,0.20,0.30,60,112",
    "flutter,20000000,1.20,1.20,90,90,0.28,0.30,80,110",
)
STUCK, STILL = "still,10,1.0,1.0,0,0,0,0,0,0", "stuck,10,0.9,1.2,60,90,0.1,0.11,0,0"
LIGHT = "light,10,0.02,0.02,0,0,0,0.001,0,0"


@pytest.fixture
def study(monkeypatch: pytest.MonkeyPatch) -> Iterator[Any]:
    """Runs its code with other rows and another friction: its names, what it says, its figures."""
    matplotlib.use("Agg")
    pyplot.close("all")  # what another test left open is none of its figures
    monkeypatch.setitem(sys.modules, "common", common)
    (path,) = (path for path in running.notebooks() if path.name.startswith("09"))
    code = [cell.source for cell in running.read(path).cells if cell.cell_type == "code"]

    def run(rows: tuple[str, ...], f: float) -> tuple[dict[str, Any], str]:
        said: list[str] = []
        monkeypatch.setattr(common, "say", said.append)
        names: dict[str, Any] = {}
        for cell in code:
            before, quotes, rest = cell.partition('CSV = """')
            if quotes:
                _, _, after = rest.partition('"""')
                cell = f'{before}CSV = """\n' + "\n".join((HEAD, *rows)) + f'\n"""{after}'
                assert "\nf = 0.45\n" in cell
                cell = cell.replace("\nf = 0.45\n", f"\nf = {f}\n")
            exec(cell, names)  # noqa: S102  (our own text)
        for figure in map(pyplot.figure, pyplot.get_fignums()):
            figure.canvas.draw()
        return names, "\n".join(said)

    yield run
    pyplot.close("all")


@pytest.mark.slow
@pytest.mark.enough("light")
@pytest.mark.parametrize(
    ("rows", "f"),
    [(OWN, 0.1), ((STUCK, STILL), 0.6), ((LIGHT, OWN[0]), 0.3)],
    ids=["little friction", "stuck", "light"],
)
def test_the_study_takes_other_loads(study: Any, rows: tuple[str, ...], f: float) -> None:
    names, said = study(rows, f)
    assert "nan" not in said
    assert "in  " not in said
    regime, zone, Regime = names["zone"].regime, names["zone"], names["Regime"]
    for i, row in enumerate(rows):
        name = row.split(",")[0]
        kind = Regime(regime[i]).name.lower().replace("_", " ")
        assert f"| {name} | {kind} |" in said
        if not np.isfinite(zone.m[i]):
            why = "slip reverses" if regime[i] == Regime.MIXED else "nothing sticks"
            assert any(name in part and why in part for part in said.split("*"))
    assert ("All of these stick zones are known." in said) == bool(np.all(np.isfinite(zone.m)))
