"""Draws pressure.svg, the picture of the README: `make picture`."""

from pathlib import Path
from typing import Any

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np

from generated import hertz, wedge

E_STAR = 60e9  # Pa
P = 2e6  # N/m
BODIES = (
    ("wedge, $g(x) = \\varphi\\,|x|$", wedge, {"phi": 0.05}),
    ("cylinder, $g(x) = x^2/2R$", hertz, {"R": 0.02}),
)
MOMENTS = (0.0, 100.0, 250.0)  # N
COLOURS = ("#0072b2", "#e69f00", "#cc79a7")  # told apart by colour-blind readers


def draw(axes: Any, title: str, body: Any, shape: dict[str, float]) -> None:
    """Pressure of one body under the same load and growing moments."""
    for moment, colour in zip(MOMENTS, COLOURS, strict=True):
        state = body.contact(P, moment, E_star=E_STAR, **shape)
        x = np.linspace(-state.a, state.c, 1001)
        p = body.pressure(x, state.a, state.c, E_star=E_STAR, **shape)
        label = f"M = {moment:.0f} N, tilt {1e3 * state.alpha:.2f} mrad"
        axes.plot(1e3 * x, 1e-6 * p, color=colour, label=label)
    axes.set(title=title, xlabel="x [mm]", ylabel="pressure p [MPa]", ylim=(0, 3500))
    axes.legend(frameon=False, fontsize="small")


def main() -> None:
    """Write the picture beside this file, the same bytes on every run."""
    mpl.rcParams["svg.hashsalt"] = "contact-derive"
    figure, axes = plt.subplots(1, 2, figsize=(9, 3.4), layout="constrained")
    for place, (title, body, shape) in zip(axes, BODIES, strict=True):
        draw(place, title, body, shape)
    figure.savefig(Path(__file__).with_name("pressure.svg"), metadata={"Date": None})


if __name__ == "__main__":
    main()
