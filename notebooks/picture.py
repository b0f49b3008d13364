"""Draws pressure.svg, the picture of the README: `make picture`."""

from pathlib import Path

from derive import plot
from generated import hertz, wedge

E_STAR = 60e9  # Pa
P = 2e6  # N/m
BODIES = (
    ("wedge, $g(x) = \\varphi\\,|x|$", wedge, {"phi": 0.05}),
    ("cylinder, $g(x) = x^2/2R$", hertz, {"R": 0.02}),
)
MOMENTS = (0.0, 100.0, 250.0)  # N
PICTURE = Path(__file__).with_name("pressure.svg")


def main(path: Path = PICTURE) -> None:
    """Write the picture, the same bytes on every run."""
    titles = [title for title, *_ in BODIES]
    figure, axes = plot.subplots(1, 2, size=(9, 3.4), sharey=True, titles=titles)
    for place, (_, body, shape) in zip(axes, BODIES, strict=True):
        states = [body.contact(P, moment, E_star=E_STAR, **shape) for moment in MOMENTS]
        labels = [
            f"M = {moment:.0f} N, tilt {1e3 * state.alpha:.2f} mrad"
            for moment, state in zip(MOMENTS, states, strict=True)
        ]
        plot.pressures(body, states, labels, axes=place, E_star=E_STAR, **shape)
        place.set(ylim=(0, 3500))
    axes[1].set(ylabel="")
    plot.save(figure, path)


if __name__ == "__main__":
    main()
