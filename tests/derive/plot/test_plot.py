"""Pictures hold what the functions give, say what stands on their axes, and change nothing else."""

import subprocess
import sys
from collections.abc import Callable
from typing import Any

import matplotlib
import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.collections import PolyCollection
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from numpy.testing import assert_allclose, assert_array_equal

from derive import plot
from derive.command.errors import MissingLibrary
from derive.plot import live as live_module
from derive.plot.style import FORWARD, REVERSE
from generated import circular_arc, hertz, wedge
from generated.runtime.types import Contact, March, Regime

STEEL = {"E_star": 115e9, "R": 0.05}
FRICTION = {"f": 0.6, **STEEL}
P, M, DQ = 1e6, 60.0, 1.5e5
STATE = hertz.contact(P, M, **STEEL)
MODERATE_PULL, LARGE_PULL = 100e6, 500e6
WINDOW = 262e6
"""A tension at which slip reverses: 8 dQ/(pi h) = 256.7 MPa, and the zone closes at 274 MPa."""


def line(axes: Any, label: str) -> Any:
    (found,) = (of for of in axes.get_lines() if of.get_label() == label)
    return found


def words(of: Any) -> list[str]:
    """Of axes, or of their legend."""
    return [text.get_text() for text in getattr(of, "get_texts", lambda: of.texts)()]


def areas(axes: Any) -> dict[str, list[PolyCollection]]:
    """Filled areas of a map by their colour."""
    found: dict[str, list[PolyCollection]] = {}
    for collection in axes.collections:
        found.setdefault(to_hex(collection.get_facecolor()[0]), []).append(collection)
    return found


def span(of: PolyCollection) -> tuple[float, float, float, float]:
    """Its widest part: an instant by itself, such as the end of the cycle before, has no width."""
    box = max((path.get_extents() for path in of.get_paths()), key=lambda box: box.width)
    return box.x0, box.x1, box.y0, box.y1


# ------------------------------------------------------------------ measures and style


def test_a_unit_suits_the_values_and_leaves_out_what_is_infinite() -> None:
    assert [plot.unit(v, "m").name for v in ([7e-4, -1e-5], 0.5)] == ["mm", "m"]
    assert plot.unit([np.inf, 9e8, np.nan], "Pa").name == "MPa"
    assert_array_equal(plot.unit(0.002, "m")([0.001, np.inf, np.nan]), [1.0, np.nan, np.nan])


def test_the_style_lasts_no_longer_than_its_context() -> None:
    before = dict(matplotlib.rcParams)
    plot.pressures(hertz, [STATE], **STEEL)
    with plot.style():
        assert dict(matplotlib.rcParams) != before
    assert dict(matplotlib.rcParams) == before


# ------------------------------------------------------------------ pressure and tractions


def test_pressures_are_those_of_the_module() -> None:
    states = [STATE, hertz.contact(P, 0.0, **STEEL)]
    axes = plot.pressures(hertz, states, ["leaning", "upright"], **STEEL)
    for state, label in zip(states, ("leaning", "upright"), strict=True):
        x, p = line(axes, label).get_data()
        expected = hertz.pressure(1e-3 * x, state.a, state.c, **STEEL)
        assert_allclose(1e6 * p, expected, rtol=1e-9, atol=1e-3 * expected.max())
        assert_allclose((x[0], x[-1]), (-1e3 * state.a, 1e3 * state.c))
    assert axes.get_xlabel() == "$x$  [mm]"
    assert axes.get_ylabel() == "$p$  [MPa]"
    assert words(axes.get_legend()) == ["leaning", "upright"]


def test_the_apex_of_a_wedge_is_cut_off() -> None:
    law = {"E_star": 60e9, "phi": 0.05}
    state = wedge.contact(2e6, 0.0, **law)
    axes = plot.pressures(wedge, [state], **law)
    assert np.isfinite(axes.get_ylim()[1])
    beside = 1e-6 * wedge.pressure(0.05 * state.a, state.a, state.c, **law)
    assert beside < axes.get_ylim()[1]


@pytest.mark.parametrize("mixed", [False, True])
def test_a_mixed_cycle_shows_its_zone_where_it_is_asked_for(mixed: bool) -> None:
    """The right edge slips, too, and its slip has no one sense; the shear is not known."""
    zone = hertz.stick_zone(STATE, STATE, DQ, WINDOW, mixed=mixed, **FRICTION)
    assert zone.regime == Regime.MIXED
    _, below = plot.tractions(hertz, STATE, STATE, DQ, WINDOW, mixed=mixed, **FRICTION)
    above, _ = plot.slip(hertz, STATE, STATE, DQ, WINDOW, mixed=mixed, **FRICTION)
    assert words(below) == ["shear not known: mixed"]
    assert words(above) == ["slip not known: mixed"]
    assert len(above.patches) == len(below.patches) == 2 * mixed
    assert np.all(np.isfinite(below.get_ylim()))
    if mixed:
        left, right = below.patches
        assert to_hex(left.get_facecolor()) == FORWARD
        assert right.get_hatch() == "..."
        assert left.get_x() + left.get_width() == pytest.approx(-1e3 * zone.m)
        assert right.get_x() == pytest.approx(1e3 * zone.n)
        assert right.get_width() == pytest.approx(1e3 * (STATE.c - zone.n)) and zone.n < STATE.c
        assert "slip reverses" in words(below.get_legend())


@pytest.mark.parametrize(
    ("dsigma", "colours"), [(MODERATE_PULL, (FORWARD, FORWARD)), (LARGE_PULL, (FORWARD, REVERSE))]
)
def test_tractions_are_those_of_the_module(dsigma: float, colours: tuple[str, str]) -> None:
    above, below = plot.tractions(hertz, STATE, STATE, DQ, dsigma, **FRICTION)
    x, dq = line(below, r"$\Delta q$").get_data()
    inside = slice(1, -1)
    expected = hertz.shear_change(1e-3 * x, STATE, STATE, DQ, dsigma, **FRICTION)
    assert_allclose(1e6 * dq[inside], expected[inside], rtol=1e-9)
    limit = line(below, r"$\pm f\,(p_1 + p_2)$").get_ydata()
    p = line(above, "$p$").get_ydata()
    assert_allclose(limit, 2 * FRICTION["f"] * p)
    assert np.all(np.abs(dq) <= limit * (1 + 1e-9) + 1e-9)  # nowhere beyond friction
    zone = hertz.stick_zone(STATE, STATE, DQ, dsigma, **FRICTION)
    left, right = below.patches
    assert left.get_x() + left.get_width() == pytest.approx(-1e3 * zone.m)
    assert right.get_x() == pytest.approx(1e3 * zone.n)
    assert tuple(to_hex(patch.get_facecolor()) for patch in below.patches) == colours


def test_the_shear_of_a_cycle_is_that_of_the_module_and_keeps_within_its_band() -> None:
    Q, pull = 0.7 * DQ, 0.7 * MODERATE_PULL
    axes = plot.shear(hertz, STATE, Q, pull, DQ, MODERATE_PULL, between=2, **FRICTION)
    upper, lower = (line(axes, f"{end} end") for end in ("upper", "lower"))
    x, band = upper.get_xdata(), line(axes, r"$\pm f\,p$").get_ydata()
    for end, fallen in ((upper, 0.0), (lower, 1.0)):
        down = {"dQ": fallen * DQ, "dsigma": fallen * MODERATE_PULL}
        expected = hertz.shear(1e-3 * x, STATE, Q, pull, **FRICTION, **down)
        assert_allclose(end.get_ydata(), 1e-6 * expected, rtol=1e-9, atol=1e-9)
        assert np.all(np.abs(end.get_ydata()) <= band * (1 + 1e-9))
    assert len(axes.get_lines()) == 2 + 2 + 2
    low, high = axes.get_ylim()
    assert low < np.min(lower.get_ydata()) and high > np.max(upper.get_ydata())


def test_slip_and_the_work_of_friction() -> None:
    above, below = plot.slip(hertz, STATE, STATE, DQ, LARGE_PULL, **FRICTION)
    x, s = above.get_lines()[0].get_data()
    slipped = hertz.slip_range(1e-3 * x, STATE, STATE, DQ, LARGE_PULL, **FRICTION)
    inside = slice(1, -1)  # at the edges rounding of x decides
    assert_allclose(1e-6 * s[inside], slipped[inside], rtol=1e-6, atol=1e-12)
    p = hertz.pressure(1e-3 * x, STATE.a, STATE.c, **STEEL)
    work = below.get_lines()[0].get_ydata()
    assert_allclose(work[inside], (FRICTION["f"] * p * slipped)[inside], rtol=1e-6, atol=1e-6)
    assert above.get_ylabel() == "$s$  [µm]"
    assert below.get_ylabel() == "$f\\,p\\,s$  [J/m²]"


# ------------------------------------------------------------------ maps


def cycle(dsigma: float, count: int = 41) -> tuple[np.ndarray, March]:
    t = np.linspace(0, 1, count)
    swing = -np.cos(2 * np.pi * t) / 2
    return t, hertz.march(P, M, DQ * swing, dsigma * swing, **FRICTION)


def test_a_map_colours_each_edge_by_its_sense() -> None:
    t, marched = cycle(LARGE_PULL)
    axes = plot.stick_slip(marched, t)
    found = areas(axes)
    middle = 1e3 * (STATE.c - STATE.a) / 2
    for colour, left_when, right_when in (
        (FORWARD, (0, 0.5), (0.5, 1)),
        (REVERSE, (0.5, 1), (0, 0.5)),
    ):
        for area in found[colour]:
            x0, x1, y0, y1 = span(area)
            start, end = left_when if y1 < middle else right_when
            assert start <= x0 < x1 <= end
            edge, inner = (y0, y1) if y1 < middle else (y1, y0)
            assert edge == pytest.approx(-1e3 * STATE.a if y1 < middle else 1e3 * STATE.c)
            last = marched.m if y1 < middle else marched.n
            assert abs(inner) == pytest.approx(1e3 * last.min())
    assert len(found[FORWARD]) == len(found[REVERSE]) == 2
    assert axes.get_ylabel() == "$x$  [mm]"


def test_the_lines_of_a_map_are_the_ends_of_the_stick_zone_with_a_gap_at_each_turn() -> None:
    t, marched = cycle(MODERATE_PULL)
    axes = plot.stick_slip(marched, t)
    plot.boundaries(axes, t, marched, "order 1", length=plot.unit(STATE.a, "m"))
    for label in ("exact", "order 1"):
        at, end = line(axes, label).get_data()
        drawn = np.isfinite(at)
        assert_allclose(at[drawn], t)
        assert_allclose(end[drawn], -1e3 * marched.m)
        assert np.count_nonzero(~drawn) == 2  # after the first instant, and at the middle
        assert label in words(axes.get_legend())


def test_a_sweep_leaves_open_what_is_not_known() -> None:
    dsigma = np.linspace(0, 600e6, 601)
    zone = hertz.stick_zone(STATE, STATE, DQ, dsigma, **FRICTION)
    axes = plot.sweep(1e-6 * dsigma, STATE, zone, dsigma, label="tension")
    hatched = [area for area in axes.collections if area.get_hatch() == "////"]
    (unknown,) = hatched
    x0, x1, y0, y1 = span(unknown)
    gap = 1e-6 * dsigma[np.isnan(zone.m)]
    assert_allclose((x0, x1), (gap.min() - 1, gap.max() + 1))
    assert_allclose((y0, y1), (-1e3 * STATE.a, 1e3 * STATE.c))
    _, end = line(axes, "exact").get_data()
    assert_allclose(end[np.isfinite(end)], -1e3 * zone.m[np.isfinite(zone.m)])
    assert axes.get_xlabel() == "tension"
    assert "not known" in words(axes.get_legend())


# ------------------------------------------------------------------ errors of the series


def test_errors_are_those_of_the_module() -> None:
    part = np.geomspace(0.01, 0.3, 5)
    found = plot.relative_errors(hertz, STATE, DQ * part, LARGE_PULL * part, **FRICTION)
    zone = hertz.stick_zone(STATE, STATE, DQ * part, LARGE_PULL * part, **FRICTION)
    d = STATE.a - zone.m
    assert_allclose(found.size[0], d / (STATE.a + STATE.c))
    first = hertz.slip_zones(*STATE[:2], DQ * part, LARGE_PULL * part, **FRICTION)
    assert_allclose(found.relative[1][0], np.abs(first.left / d - 1))
    axes = plot.errors(hertz, STATE, DQ * part, LARGE_PULL * part, orders=(1, 2), **FRICTION)
    assert_allclose(line(axes, "order 2, right").get_data(), (found.size[1], found.relative[2][1]))


# ------------------------------------------------------------------ sliders

LARGEST = plot.Loads(2e6, 300.0, 8e5, 800e6, 1.0)
START = plot.Loads(P, M, DQ, LARGE_PULL, 0.6)


@pytest.mark.filterwarnings("ignore::DeprecationWarning:ipywidgets")
def test_sliders_move_the_picture_and_the_line_below_it() -> None:
    """Also where nothing is known, and back."""
    zone = hertz.stick_zone(STATE, STATE, DQ, LARGE_PULL, **FRICTION)
    row, picture, told = plot.sliders(hertz, LARGEST, START, **STEEL).children
    before = told.value, picture.value
    assert told.value.startswith("large: contact [-0.8040, 0.6840] mm")
    assert f"stick [{-1e3 * zone.m:.4f}, {1e3 * zone.n:.4f}] mm" in told.value
    slider = dict(zip(plot.Loads._fields, row.children, strict=True))["dsigma"]
    value = slider.value
    slider.value = WINDOW * slider.max / LARGEST.dsigma
    assert told.value.startswith("mixed") and "nan" not in told.value
    assert picture.value != before[1]
    slider.value = value
    assert (told.value, picture.value) == before
    lost = plot.sliders(circular_arc, LARGEST, START._replace(P=1e4), E_star=115e9, R=1e-3)
    assert lost.children[2].value.startswith("no contact")


# ------------------------------------------------------------------ what cannot be drawn

NO_CONTACT = hertz.contact(-1.0, 0.0, **STEEL)
SEVERAL = hertz.contact(np.array([P, 2 * P]), M, **STEEL)
OTHER = hertz.contact(P, M, E_star=115e9, R=0.06)
_, ONE = cycle(0.0)
TWO = March(*(np.stack([of, of]) for of in ONE))


def half_cycle(**changed: Any) -> Any:
    given = {"first": STATE, "second": STATE, "dQ": DQ, "dsigma": 0.0, **FRICTION} | changed
    return plot.tractions(hertz, **given)


def sweep(**changed: Any) -> Any:
    zone = hertz.stick_zone(STATE, STATE, DQ, 0.0, **FRICTION)
    given = {"parameter": [0.0, 1.0], "contact": STATE, "zone": zone, "dsigma": 0.0} | changed
    return plot.sweep(**given)


def pressures(*states: Any, labels: tuple[str, ...] = ()) -> Any:
    return plot.pressures(hertz, [*states], labels, **STEEL)


def sliders(**changed: float) -> Any:
    return plot.sliders(hertz, LARGEST._replace(**changed), START, **STEEL)


REFUSED: dict[str, Callable[[], Any]] = {
    "finite positive number": lambda: plot.Measure(0.0, "a"),
    "the unit 'ft' is not known; give one of m, Pa": lambda: plot.unit(1.0, "ft"),
    r"states\[0\] is .*, not a single Contact": lambda: pressures(SEVERAL),
    r"states\[0\] is 3.0, not a single .* give one result of `contact`": lambda: pressures(3.0),
    "its edges require .* for the same constants": lambda: pressures(OTHER),
    "second is .* its edges require .* for the same constants": lambda: half_cycle(second=OTHER),
    "`states` is empty; give at least one": pressures,
    "1 labels are given for 2": lambda: pressures(STATE, STATE, labels=("one",)),
    "first is NaN: there is no contact under its loads": lambda: half_cycle(first=NO_CONTACT),
    r"dQ is array\(.*; give one finite number": lambda: half_cycle(dQ=np.ones(3)),
    r"first is .*, not a single Contact": lambda: half_cycle(first=SEVERAL),
    "Q is nan; give one finite number": lambda: plot.shear(
        hertz, STATE, np.nan, 0.0, DQ, 0.0, **FRICTION
    ),
    "dQ = -150000 is negative: pass the half-cycle": lambda: half_cycle(dQ=-DQ),
    "f = 0 is not positive and finite": lambda: half_cycle(f=0),
    "dsigma is nan; give one finite number": lambda: half_cycle(dsigma=np.nan),
    "give one cycle": lambda: plot.stick_slip(TWO),
    "time is .*; give one row of 41 finite numbers": lambda: plot.stick_slip(ONE, [0.0, 1.0]),
    "parameter is 1.0; give one row of at least two": lambda: sweep(parameter=1.0),
    "shape": lambda: sweep(contact=Contact(*np.ones((3, 3)))),
    "dsigma is 0 or NaN .*give": lambda: plot.sweep(
        [0.0, 1.0], STATE, hertz.stick_zone(STATE, STATE, DQ, [LARGE_PULL] * 2, **FRICTION), 0.0
    ),
    "the kind of line 'third' is not known": lambda: plot.boundaries(
        Figure().gca(), [0.0], ONE, "third", length=plot.unit(STATE.a, "m")
    ),
    r"Loads\(P=.*is beyond the ends of the sliders": lambda: sliders(M=1.0),
    r"f=nan\); give others": lambda: sliders(f=np.nan),
}


@pytest.mark.filterwarnings("ignore::DeprecationWarning:ipywidgets")
@pytest.mark.parametrize("told", REFUSED)
def test_what_cannot_be_drawn_is_refused(told: str) -> None:
    with pytest.raises(ValueError, match=told):
        REFUSED[told]()
    assert not plt.get_fignums()


# ------------------------------------------------------------------ what is missing


def test_without_matplotlib_one_clear_error() -> None:
    code = (
        "import sys; sys.modules['matplotlib'] = None\n"
        "import importlib.util as u; found = u.find_spec\n"
        "u.find_spec = lambda name, *a: None if name == 'matplotlib' else found(name, *a)\n"
        "from derive.command.errors import MissingLibrary\n"
        "try:\n    import derive.plot\n"
        "except MissingLibrary as error:\n    print(error)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    said, remedy = "matplotlib is not installed, and drawing needs it", "contact-derive[plot]"
    assert done.stdout == f"{said}: run pip install '{remedy}'\n", done.stderr


def test_without_ipywidgets_one_clear_error(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(live_module, "find_spec", lambda name: None)
    with pytest.raises(MissingLibrary, match=r"ipywidgets is not installed.*\[notebooks\]"):
        plot.sliders(hertz, LARGEST, START, **STEEL)
