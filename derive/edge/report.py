"""What was found in a table: as text, as CSV, as a page with the fit on log axes."""

import csv
import io
from collections.abc import Iterable, Iterator, Sequence
from html import escape
from math import floor, isfinite, log10

import numpy as np

from derive.edge.find import SIDES, Findings, Found
from derive.edge.table import Step

HEAD = ("load step", "edge", "at [mm]", "K_N [MPa/sqrt(mm)]", "L_N [MPa/mm^1.5]", "nodes")
ZONES = (
    "edge",
    "K_T [MPa sqrt(mm)]",
    "moves [um]",
    "slip zone [um]",
    "series [um]",
    "order",
    "d/reach",
)

SERIES = "series is what one more term would change"
REACH = "d/reach is the slip zone over the distance at which the next term matters as much"

PAGE = """<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="generator" content="derive edge --html">
<title>{title}</title>
<style>
body {{ font: 16px/1.5 sans-serif; max-width: 60rem; margin: 2rem auto; padding: 0 1rem; }}
.wide {{ overflow-x: auto; }}
table {{ border-collapse: collapse; white-space: nowrap; }}
th, td {{ text-align: right; padding: 0.2rem 0.6rem; border-bottom: 1px solid #ccc; }}
h1 {{ overflow-wrap: anywhere; }}
svg {{ width: 100%; min-width: 30rem; max-width: 50rem; font: 12px sans-serif; }}
</style>
</head>
<body>
<h1>{title}</h1>
{body}
</body>
</html>
"""


def _pm(value: float, error: float, scale: float) -> str:
    """A number with one standard deviation, to two digits of that."""
    value, error = scale * value, scale * error
    if not (error > 0 and isfinite(value)):
        return f"{value:.5g} +- {error:.1g}"
    digits = 1 - floor(log10(error))
    return f"{round(value, digits):.{max(digits, 0)}f} +- {round(error, digits):.{max(digits, 0)}f}"


def edge_rows(found: Findings) -> list[tuple[str, ...]]:
    """One row a load step and edge; K_N in MPa/sqrt(mm), with sqrt(1000) = 31.6 in it."""
    root = 1000**-0.5
    return [
        (
            e.step or "-",
            e.side,
            _pm(e.pressure.edge, e.pressure.edge_error, 1e3),
            _pm(e.pressure.K_N, e.pressure.K_N_error, 1e-6 * root),
            _pm(e.pressure.L_N, e.pressure.L_N_error, 1e-9 * root),
            str(e.pressure.nodes),
        )
        for e in found.edges
    ]


def zone_rows(found: Findings) -> list[tuple[str, ...]]:
    """One row an edge."""
    return [
        (
            zone.side,
            _pm(zone.K_T, zone.K_T_error, 1e-6 * 1000**0.5),
            f"{1e6 * zone.da + 0.0:.4g}",
            _pm(zone.d, zone.error, 1e6),
            f"{1e6 * zone.series:.1g}",
            str(zone.order),
            f"{zone.part:.2g}",
        )
        for zone in found.zones
    ]


def as_text(found: Findings) -> str:
    """Tables for a terminal; +- is one standard deviation."""
    parts = ["Edges", *_aligned([HEAD, *edge_rows(found)])]
    if found.zones:
        parts += [
            "",
            "Slip zones at the end of the half-cycle",
            *_aligned([ZONES, *zone_rows(found)]),
            "",
            f"  {SERIES}",
            f"  {REACH}",
        ]
    parts += ["", "+- is one standard deviation"]
    parts += ["", "Why"]
    for e in found.edges:
        where = f"{e.step}, " if e.step else ""
        if e.pressure.why:
            parts.append(f"  {where}{e.side}: {e.pressure.why}")
    parts += [f"  {side}, shear: {fit.why}" for side, fit in found.shears if fit.why]
    if found.notes:
        parts += ["", "Notes", *(f"  {note}" for note in found.notes)]
    return "\n".join(parts)


def _aligned(rows: Sequence[Sequence[str]]) -> Iterator[str]:
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    for row in rows:
        yield "  " + "  ".join(f"{cell:>{w}}" for cell, w in zip(row, widths, strict=True))


CSV_HEAD = "load_step,side,"
"""What a table of results begins with."""


def as_csv(found: Findings) -> str:
    """One row a load step and edge, in SI units; slip zones where the half-cycle ends."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    names = ["edge", "K_N", "L_N", "edge_error", "K_N_error", "L_N_error", "nodes", "stretch"]
    zone_names = ["K_T", "K_T_error", "da", "d", "error", "series", "order", "part"]
    writer.writerow(["load_step", "side", *names, *zone_names])
    zones = {zone.side: zone for zone in found.zones}
    last = found.edges[-1].step
    for e in found.edges:
        told = zones.get(e.side) if e.step == last else None
        row = [repr(getattr(e.pressure, name)) for name in names]
        more = [repr(getattr(told, name)) if told else "" for name in zone_names]
        writer.writerow([e.step, e.side, *row, *more])
    return out.getvalue()


def as_page(found: Findings, steps: Sequence[Step], title: str) -> str:
    """A page of its own, with a picture of each edge at the end of the half-cycle."""
    body = ["<h2>Edges</h2>", _table(HEAD, edge_rows(found))]
    if found.zones:
        body += [
            "<h2>Slip zones at the end of the half-cycle</h2>",
            _table(ZONES, zone_rows(found)),
        ]
    meant = ["± is one standard deviation", *([SERIES, REACH] if found.zones else [])]
    body.append(f"<p>{'; '.join(meant)}.</p>")
    last = [e for e in found.edges if e.step == steps[-1].name and np.isfinite(e.pressure.edge)]
    zones = {zone.side: zone.d for zone in found.zones}
    for e in last:
        body += [
            f"<h2>Pressure next to the {e.side} edge</h2>",
            _picture(e, steps[-1], zones.get(e.side, float("nan"))),
            f"<p>{escape(e.pressure.why)}.</p>",
        ]
    if found.notes:
        body += ["<h2>Notes</h2>", "<ul>"]
        body += [f"<li>{escape(note)}</li>" for note in found.notes] + ["</ul>"]
    return PAGE.format(title=escape(title), body="\n".join(body))


def _table(head: Iterable[str], rows: Iterable[Sequence[str]]) -> str:
    def line(cells: Iterable[str], tag: str) -> str:
        shown = (escape(cell).replace("+-", "±") for cell in cells)
        return "<tr>" + "".join(f"<{tag}>{cell}</{tag}>" for cell in shown) + "</tr>"

    lines = f"{line(head, 'th')}{''.join(line(row, 'td') for row in rows)}"
    return f'<div class="wide"><table>{lines}</table></div>'


WIDTH, HEIGHT, LEFT, BOTTOM, MARGIN = 640, 360, 70, 45, 15


def _picture(e: Found, step: Step, d: float) -> str:
    """Nodal pressures, the fit and K_N sqrt(s) over the distance from the edge, on log axes."""
    sense = 1 if e.side == SIDES[0] else -1
    s, p = sense * (step.x - e.pressure.edge), step.p
    shown = (s > 0) & (p > 0) & (s <= 4 * e.pressure.stretch)
    s, p = 1e3 * s[shown], 1e-6 * p[shown]
    if len(s) < 2:
        return ""
    fine = np.geomspace(s.min() / 2, 1e3 * e.pressure.stretch, 80)
    first = 1e-6 * e.pressure.K_N * np.sqrt(1e-3 * fine)
    second = first + 1e-6 * e.pressure.L_N * (1e-3 * fine) ** 1.5
    everything = np.concatenate([first, p, second[second > 0]])
    low, high = log10(everything.min()) - 0.05, log10(everything.max()) + 0.05
    near, far = log10(fine.min()), log10(max(s.max(), fine.max())) + 0.02

    def across(x: float) -> float:
        return LEFT + (log10(x) - near) / (far - near) * (WIDTH - LEFT - MARGIN)

    def up(y: float) -> float:
        return HEIGHT - BOTTOM - (log10(y) - low) / (high - low) * (HEIGHT - BOTTOM - MARGIN)

    def curve(x: Sequence[float], y: Sequence[float], style: str) -> str:
        points = " ".join(
            f"{across(a):.1f},{up(b):.1f}" for a, b in zip(x, y, strict=True) if b > 0
        )
        return f'<polyline points="{points}" fill="none" {style}/>'

    parts = ['<div class="wide">']
    parts.append(
        f'<svg viewBox="0 0 {WIDTH} {HEIGHT}" role="img" aria-label="pressure at an edge">'
    )
    base = HEIGHT - BOTTOM
    for x in _ticks(near, far):
        at = f"{across(x):.1f}"
        parts.append(f'<path d="M{at} {MARGIN} V{base}" stroke="#ddd"/>')
        parts.append(f'<text x="{at}" y="{base + 16}" text-anchor="middle">{x:g}</text>')
    for y in _ticks(low, high):
        parts.append(f'<path d="M{LEFT} {up(y):.1f} H{WIDTH - MARGIN}" stroke="#ddd"/>')
        parts.append(f'<text x="{LEFT - 6}" y="{up(y) + 4:.1f}" text-anchor="end">{y:g}</text>')
    parts.append(curve(list(fine), list(first), 'stroke="#888" stroke-dasharray="5 4"'))
    parts.append(curve(list(fine), list(second), 'stroke="#06c" stroke-width="2"'))
    parts += [
        f'<circle cx="{across(a):.1f}" cy="{up(b):.1f}" r="3" fill="#000"/>'
        for a, b in zip(s, p, strict=True)
    ]
    if d > 0 and near < log10(1e3 * d) < far:
        x = across(1e3 * d)
        parts.append(f'<line x1="{x:.1f}" x2="{x:.1f}" y1="{MARGIN}" y2="{base}" stroke="#c30"/>')
        parts.append(f'<text x="{x + 4:.1f}" y="{MARGIN + 12}" fill="#c30">slip zone</text>')
    below = f'x="{(LEFT + WIDTH) / 2}" y="{HEIGHT - 8}" text-anchor="middle"'
    parts.append(f"<text {below}>distance from the edge [mm]</text>")
    beside = f'transform="translate(16 {HEIGHT / 2}) rotate(-90)" text-anchor="middle"'
    parts.append(f"<text {beside}>pressure [MPa]</text>")
    parts.append("</svg></div>")
    legend = "dots: nodes; dashed: K_N sqrt(s); blue: with L_N s^1.5"
    return "\n".join(parts) + f"\n<p>{legend}</p>"


def _ticks(low: float, high: float) -> list[float]:
    """1, 2 and 5 of each decade between two powers of ten."""
    return [
        step * 10.0**power
        for power in range(floor(low) - 1, floor(high) + 1)
        for step in (1, 2, 5)
        if low <= log10(step * 10.0**power) <= high
    ]
