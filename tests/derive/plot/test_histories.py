"""Pictures of histories hold what `history` gives, and refuse what they cannot draw."""

from collections.abc import Callable
from functools import partial
from typing import Any

import matplotlib
import numpy as np
import pytest
from matplotlib.colors import to_hex
from numpy.testing import assert_allclose

from derive import plot
from derive.plot.style import FORWARD, REVERSE, STICK
from generated import flat_rounded, hertz, wedge
from generated.runtime.types import History

STEEL = {"E_star": 115e9, "R": 0.05}
FRICTION = {"f": 0.5, **STEEL}
P, F = 1e6, 0.5
EDGE = float(hertz.contact(P, 0.0, **STEEL).a)
X = np.linspace(-1.2, 1.2, 201) * EDGE  # 100 is the middle
WAY = np.array([0.0, 0.3, 0.6, 0.3, 0.0, -0.3]) * F * P
WHOLE = hertz.history(P, 0.0, WAY, 0.0, x=X, **FRICTION)
"""Exact: rises to 0.6 f P, then falls; n = a sqrt(1 - Q/(f P)), then a sqrt(1 - dQ/(2 f P))."""

ENDS = np.sqrt([0.7, 0.4, 0.85, 0.7, 0.55])
"""Of the stick zone at each instant but the first, over the half-width."""


def colours(axes: Any) -> np.ndarray:
    """Those of the cells of a map: a row a place, a column an interval."""
    (cells,) = (of for of in axes.collections if hasattr(of, "get_coordinates"))
    rgba = cells.cmap(cells.norm(cells.get_array()))
    return np.apply_along_axis(lambda c: to_hex(c, keep_alpha=True), -1, rgba)


def test_a_map_shows_what_slips_on_the_way_to_each_instant() -> None:
    axes = plot.slip_map(WHOLE, X, np.linspace(0, 1, 6), length=plot.Measure(EDGE, "a", ratio=True))
    cells, away = colours(axes), np.abs(X) / EDGE
    for k, end in enumerate(ENDS):
        sense = FORWARD if k < 2 else REVERSE
        slips = (away > end + 0.015) & (away < 0.99)
        assert set(cells[slips, k]) == {sense + "ff"}
        assert set(cells[away < end - 0.015, k]) == {STICK + "ff"}
    assert set(cells[away > 1.02].ravel()) == {"#00000000"}
    legend = [text.get_text() for text in axes.get_legend().get_texts()]
    assert legend == ["stick", "forward slip", "reverse slip"]
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("$t$", "$x/a$")


def test_what_is_not_known_is_told() -> None:
    """From sliding on slip is not known."""
    history = hertz.history(P, 0.0, [0.0, 0.2 * P, 0.6 * P, 0.2 * P], 0.0, x=X, **FRICTION)
    axes = plot.slip_map(history, X)
    assert axes.get_xlabel() == "instant"
    texts = [text.get_text() for text in axes.get_legend().get_texts()]
    assert texts == ["stick", "forward slip", "not known"]
    assert set(colours(axes)[:, 1:].ravel()) == {"#00000000"}


def test_shear_and_slip_at_instants_are_those_of_the_history() -> None:
    above, below = plot.instants(hertz, WHOLE, X, [2, -1], ["top", "end"], **FRICTION)
    shown = {of.get_label(): of.get_ydata() for of in above.get_lines()}
    assert_allclose(shown["top"], WHOLE.q[2] / 1e6)
    assert_allclose(shown["end"], WHOLE.q[5] / 1e6)
    p = hertz.pressure(X, EDGE, EDGE, **STEEL)
    assert_allclose(shown[r"$\pm f\,p$"], F * p / 1e6)
    inside = np.abs(X) <= EDGE
    for of, at in zip(below.get_lines(), (2, 5), strict=True):
        assert_allclose(of.get_ydata()[inside], WHOLE.slip[at][inside] * 1e6)
        assert np.all(np.isnan(of.get_ydata()[~inside]))


def test_friction_s_work_along_x_adds_up_to_that_of_the_history() -> None:
    along = plot.friction_work(hertz, WHOLE, X, **FRICTION)
    assert np.trapezoid(np.nan_to_num(along), X) == pytest.approx(WHOLE.work[-1], rel=0.01)
    axes = plot.work(hertz, WHOLE, X, label="all", **FRICTION)
    (drawn,) = axes.get_lines()
    assert_allclose(drawn.get_ydata() * plot.unit(along, "J/m²").size, along)


def test_a_film_has_a_frame_an_instant(tmp_path: Any) -> None:
    film = plot.film(hertz, WHOLE, X, **FRICTION)
    film.save(tmp_path / "film.gif", writer="pillow", dpi=30)
    axes = matplotlib.pyplot.gcf().axes[0]
    (shear,) = (of for of in axes.get_lines() if of.get_label() == "$q$")
    assert_allclose(shear.get_ydata(), WHOLE.q[5] / 1e6)
    forward, reverse = axes.collections
    assert not forward.get_paths() or forward.get_paths()[0].vertices.size == 0
    reach = np.concatenate([path.vertices[:, 0] for path in reverse.get_paths()])
    assert np.min(np.abs(reach)) * 1e-3 == pytest.approx(ENDS[-1] * EDGE, abs=0.02 * EDGE)
    from PIL import Image

    with Image.open(tmp_path / "film.gif") as frames:
        assert frames.n_frames == 6


NO_PLACES = hertz.history(P, 0.0, WAY, 0.0, **FRICTION)
TWO = History(*(np.stack([v, v]) for v in WHOLE))


def drawn(draw: Any = plot.slip_map, law: dict[str, Any] | None = None, **changed: Any) -> Any:
    """A picture of the history, of another one, or for other constants; None is left out."""
    given = {"history": WHOLE, "x": X, **changed}
    if draw is not plot.slip_map:
        constants = {**FRICTION, **(law or {})}
        known = {key: value for key, value in constants.items() if value is not None}
        given = {"body": hertz, **known, **given}
    return draw(**given)


AT = r"`at` is .*from -6 to 5, because history has 6 instants"
FIT = "does not fit this body"
film, work, at = (partial(drawn, draw) for draw in (plot.film, plot.friction_work, plot.instants))
REFUSED = [
    ("for the same x", partial(drawn, x=X[:9])),
    ("with slip at the 201 positions of x", partial(drawn, history=NO_PLACES)),
    ("not a single History", partial(drawn, history=TWO)),
    ("History", partial(drawn, history=hertz.contact(P, 0.0, **STEEL))),
    ("give one row of at least two", partial(drawn, x=X[:, None])),
    ("give one row of at least two", partial(drawn, history=History(*(v[:1] for v in WHOLE)))),
    ("x must increase, but .* at index 1", partial(drawn, x=X[::-1])),
    ("x is 'x'", partial(drawn, x="x")),
    ("finite numbers", partial(drawn, x=[X, X[:9]])),
    ("x is not the x of", partial(drawn, x=X + 0.3 * EDGE)),
    ("x is not the x of", partial(drawn, x=1.3 * X)),
    ("lacks slip inside it", partial(drawn, x=0.7 * X)),
    *(
        (words, partial(draw, time=times))
        for draw in (drawn, film)
        for words, times in (
            ("one row of 6 finite", [0.0, 1.0]),
            ("time must increase, but 0 follows 0 at index 1", [0, 0, 1, 2, 3, 4]),
        )
    ),
    *((AT, partial(at, at=given)) for given in ([6], [-7], [], 3, [3.5], "1", [[1], [2]])),
    ("does not fit", partial(work, law={"f": 0})),
    (r"E_star is .*; give one finite number", partial(work, law={"E_star": [1e9, 2e9]})),
    (r"f is .*; give one finite number", partial(work, law={"f": [0.5, 0.6]})),
    (rf"{FIT}, f and constants: \|q\| must .*; give the body", partial(work, law={"f": 0.1})),
    (FIT, partial(work, law={"f": 0.51})),
    (FIT, partial(work, law={"R": 0.049})),
    (FIT, partial(work, body=wedge, law={"R": None, "phi": 0.01})),
    (FIT, partial(work, body=flat_rounded, law={"b": 2 * EDGE})),
]
"""What is told, and what cannot be drawn."""


@pytest.mark.parametrize(("words", "draw"), REFUSED)
def test_what_cannot_be_drawn_is_refused(words: str, draw: Callable[[], Any]) -> None:
    with pytest.raises(ValueError, match=words):
        draw()


def notes(of: Any) -> list[list[str]]:
    return [[text.get_text() for text in axes.texts] for axes in of]


def test_an_empty_panel_says_why() -> None:
    """The contact is lost at the third instant, and slides at the third instant of the second."""
    lost = hertz.history([P, P, -P], 0.0, [0, F * P / 2, 0], 0.0, x=X, **FRICTION)
    assert notes(plot.instants(hertz, lost, X, [1, -1], ["on", "off"], **FRICTION)) == [
        ["shear not known: off"],
        ["slip not known: on, off"],
    ]
    slides = hertz.history(P, 0.0, [0, F * P / 2, F * P], 0.0, x=X, **FRICTION)
    assert notes(plot.instants(hertz, slides, X, [1, 2], **FRICTION)) == [
        [],
        ["slip not known: instant 2"],
    ]
    assert notes(plot.instants(hertz, WHOLE, X, [1, 2], **FRICTION)) == [[], []]
