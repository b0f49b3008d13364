"""Draw pressure.svg, the picture in the README: `make picture`."""

from pathlib import Path

from derive import plot
from generated import hertz, wedge

E_STAR, FRICTION = 60e9, 0.5  # Pa
P, M, SHEAR, TENSION = 2e6, 100.0, 4e5, 4e8  # N/m, N, N/m, Pa
BODIES = (
    ("wedge, $g(x) = \\varphi\\,|x|$", wedge, {"phi": 0.05}),
    ("cylinder, $g(x) = x^2/2R$", hertz, {"R": 0.02}),
)
PICTURE = Path(__file__).with_name("pressure.svg")


def main(path: Path = PICTURE) -> None:
    """Write the picture, with the same bytes on each run."""
    titles = [title for title, *_ in BODIES]
    figure, axes = plot.subplots(2, 2, size=(9, 5.6), sharex="col", titles=[*titles, "", ""])
    for column, (_, body, shape) in enumerate(BODIES):
        law = {"E_star": E_STAR, **shape}
        state = body.contact(P, M, **law)
        pair = axes[0][column], axes[1][column]
        plot.tractions(body, state, state, SHEAR, TENSION, f=FRICTION, axes=pair, **law)
        pair[0].get_legend().remove()
        if column:
            for one in pair:
                one.set(ylabel="")
    plot.save(figure, path)


if __name__ == "__main__":
    main()
