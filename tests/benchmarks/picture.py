"""Draws the picture of docs/performance.md: ns an element over the number of elements."""

from collections.abc import Mapping
from pathlib import Path

COLOURS = {
    "generated": "#d55e00",
    "generated, order 3": "#e69f00",
    "lambdify": "#0072b2",
    "lambdify, cse": "#56b4e9",
    "numexpr": "#009e73",
    "numba": "#cc79a7",
    "numba, our form": "#f0e442",
    "fsolve loop": "#666666",
    "one np.log": "#bbbbbb",
}
"""Told apart by colour-blind readers."""

Curves = Mapping[str, Mapping[int, float]]
"""Seconds a call, by contender and size."""


def draw(cases: Mapping[str, Curves], file: Path) -> None:
    """One panel a case, the same layout on every run."""
    import matplotlib as mpl
    import matplotlib.pyplot as plt

    mpl.use("svg")
    mpl.rcParams["svg.hashsalt"] = "contact-derive"
    figure, axes = plt.subplots(2, 3, figsize=(11, 6.4), layout="constrained")
    *panels, corner = axes.flat
    for place, (title, curves) in zip(panels, cases.items(), strict=True):
        for name, times in curves.items():
            sizes = [*times]
            each = [1e9 * seconds / size for size, seconds in times.items()]
            place.loglog(sizes, each, color=COLOURS[name], marker=".", label=name)
        place.set(title=title, xlabel="elements", ylabel="ns an element", xlim=(0.7, 1.5e7))
        place.grid(alpha=0.3)
    corner.axis("off")
    for name, colour in COLOURS.items():
        corner.plot([], [], color=colour, marker=".", label=name)
    corner.legend(frameon=False, loc="center")
    figure.savefig(file, metadata={"Date": None})
    plt.close(figure)
