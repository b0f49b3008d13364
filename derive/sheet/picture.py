"""Small pictures of curves as SVG, drawn in the colours of the page."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from html import escape
from itertools import pairwise
from math import floor, log10

import numpy as np

WIDTH, HEIGHT = 560, 250
LEFT, RIGHT, TOP, BOTTOM = 62, 14, 14, 40
TICKS = 5
"""Approximate number of ticks along an axis."""


@dataclass(frozen=True)
class Line:
    """One curve: its label in the legend, and its points, joined or drawn as dots."""

    label: str
    x: Sequence[float] | np.ndarray
    y: Sequence[float] | np.ndarray
    has_dots: bool = False


def svg(
    title: str,
    along: str,
    upward: str,
    lines: Sequence[Line],
    top: float = 0.0,
    is_log: bool = False,
) -> str:
    """Curves in one pair of axes; a curve is cut off where it rises above `top`, if given.

    is_log: whether both axes are logarithmic; all numbers are then positive
    """
    if is_log:
        lines = [replace(line, x=np.log10(line.x), y=np.log10(line.y)) for line in lines]
    xs = [x for line in lines for x in line.x]
    ys = [min(y, top) if top else y for line in lines for y in line.y]
    low_x, high_x = min(xs), max(xs)
    low, high = min(ys) if is_log else min(0.0, *ys), max(ys)
    across, up = (WIDTH - LEFT - RIGHT) / (high_x - low_x), (HEIGHT - TOP - BOTTOM) / (high - low)

    def pixel(x: float, y: float) -> tuple[float, float]:
        return LEFT + (x - low_x) * across, HEIGHT - BOTTOM - (y - low) * up

    places, base = (decades if is_log else ticks), HEIGHT - BOTTOM
    parts = [
        f'<svg class="curves" viewBox="0 0 {WIDTH} {HEIGHT}" role="img" '
        f'aria-label="{escape(title)}">',
        f"<title>{escape(title)}</title>",
    ]
    for x, name in places(low_x, high_x):
        at, _ = pixel(x, low)
        parts.append(f'<line class="grid" x1="{at:.1f}" x2="{at:.1f}" y1="{TOP}" y2="{base}"/>')
        parts.append(f'<text x="{at:.1f}" y="{base + 16}" text-anchor="middle">{name}</text>')
    for y, name in places(low, high):
        _, at = pixel(low_x, y)
        parts.append(
            f'<line class="grid" y1="{at:.1f}" y2="{at:.1f}" x1="{LEFT}" x2="{WIDTH - RIGHT}"/>'
        )
        parts.append(f'<text x="{LEFT - 6}" y="{at + 4:.1f}" text-anchor="end">{name}</text>')
    for number, line in enumerate(lines):
        look = f'class="curve curve-{number}"'
        for run in _below(high, line):
            points = [pixel(x, y) for x, y in run]
            if line.has_dots:
                parts += [f'<circle {look} cx="{x:.1f}" cy="{y:.1f}" r="3"/>' for x, y in points]
            else:
                drawn = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
                parts.append(f'<polyline {look} points="{drawn}"/>')
    middle = (LEFT + WIDTH - RIGHT) / 2
    parts.append(f'<text x="{middle}" y="{HEIGHT - 6}" text-anchor="middle">{escape(along)}</text>')
    parts.append(
        f'<text transform="translate(14 {(TOP + base) / 2}) rotate(-90)" '
        f'text-anchor="middle">{escape(upward)}</text></svg>'
    )
    return "".join(parts)


def sketch(title: str, line: Line) -> str:
    """One curve without axes, in a small box."""
    low, high = min(line.y), max(line.y)
    across, up = 160 / (line.x[-1] - line.x[0]), 56 / (high - low)
    points = " ".join(
        f"{4 + (x - line.x[0]) * across:.1f},{60 - (y - low) * up:.1f}"
        for x, y in zip(line.x, line.y, strict=True)
    )
    return (
        f'<svg class="sketch" viewBox="0 0 168 64" role="img" aria-label="{escape(title)}">'
        f'<title>{escape(title)}</title><polyline class="curve curve-0" points="{points}"/></svg>'
    )


def _below(high: float, line: Line) -> Iterator[list[tuple[float, float]]]:
    """The parts of a curve that lie below a height, including the points where they cross it.

    >>> list(_below(1.0, Line("", [0.0, 2.0, 4.0], [0.0, 2.0, 0.0])))
    [[(0.0, 0.0), (1.0, 1.0)], [(3.0, 1.0), (4.0, 0.0)]]
    """
    run: list[tuple[float, float]] = []
    points = list(zip(line.x, line.y, strict=True))
    for (x, y), (x_next, y_next) in pairwise([points[0], *points]):
        if (y > high) != (y_next > high):
            run.append((x + (x_next - x) * (high - y) / (y_next - y), high))
        if y_next <= high:
            run.append((x_next, y_next))
        elif run:
            yield run
            run = []
    if run:
        yield run


def ticks(low: float, high: float) -> list[tuple[float, str]]:
    """About TICKS round numbers between two bounds, each with its label.

    >>> ticks(-1.2, 3.1)
    [(-1.0, '-1'), (0.0, '0'), (1.0, '1'), (2.0, '2'), (3.0, '3')]
    """
    rough = (high - low) / TICKS
    power = 10.0 ** floor(log10(rough))
    step = power * next(n for n in (1, 2, 5, 10) if n * power >= rough * (1 - 1e-9))
    first, last = round(low / step + 0.499999), round(high / step - 0.499999)
    return [(round(n * step, 12), f"{n * step:.4g}") for n in range(first, last + 1)]


def decades(low: float, high: float) -> list[tuple[float, str]]:
    """The logarithms of 1, 2 and 5 times each power of ten between two logarithms, with labels.

    >>> decades(-0.5, 0.8)
    [(-0.3010299956639812, '0.5'), (0.0, '1'), (0.3010299956639812, '2'), (0.6989700043360189, '5')]
    """
    powers = range(floor(low), floor(high) + 1)
    numbers = [step * 10.0**power for power in powers for step in (1, 2, 5)]
    return [(log10(n), f"{n:g}") for n in numbers if low <= log10(n) <= high]
