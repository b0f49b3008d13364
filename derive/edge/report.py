"""Write the results from a table as text, as CSV, or as a page with the fit on log axes."""

import csv
import io
from collections.abc import Iterator, Sequence
from dataclasses import asdict
from math import floor, isfinite, log10

import numpy as np
from markupsafe import Markup

from derive.command.terminal import folded
from derive.edge.find import INWARD, Findings, FittedEdge
from derive.edge.table import Step
from derive.sheet.page import templates

HEAD = ("load step", "edge", "x [mm]", "K_N [MPa/sqrt(mm)]", "L_N [MPa/mm**(3/2)]", "nodes")
ZONES = (
    "edge",
    "K_T [MPa sqrt(mm)]",
    "movement [um]",
    "slip zone [um]",
    "series [um]",
    "order",
    "d/reach",
)

SERIES = "series is the change that one more term would make"
REACH = "d/reach is the slip zone divided by the distance at which the next term equals the first"


def _pm(value: float, error: float, scale: float) -> str:
    """Write a number with one standard deviation, to two significant digits of the latter."""
    value, error = scale * value, scale * error
    if not (error > 0 and isfinite(value)):
        return f"{value:.5g} +- {error:.1g}"
    digits = 1 - floor(log10(error))
    return f"{round(value, digits):.{max(digits, 0)}f} +- {round(error, digits):.{max(digits, 0)}f}"


def edge_rows(findings: Findings) -> list[tuple[str, ...]]:
    """Return one row for each load step and edge; 1 Pa/sqrt(m) is 1e-6/sqrt(1000) MPa/sqrt(mm)."""
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
        for e in findings.edges
    ]


def zone_rows(findings: Findings) -> list[tuple[str, ...]]:
    """Return one row for each edge with a slip zone."""
    return [
        (
            e.side,
            _pm(e.shear.K_T, e.shear.K_T_error, 1e-6 * 1000**0.5),
            f"{1e6 * e.da + 0.0:.4g}",
            _pm(e.zone.d, e.zone.error, 1e6),
            f"{1e6 * e.zone.series:.1g}",
            str(e.zone.order),
            f"{e.zone.part:.2g}",
        )
        for e in findings.edges
        if e.shear and e.zone
    ]


def as_text(findings: Findings) -> str:
    """Return tables for a terminal; +- is one standard deviation."""
    parts = ["Edges", *_aligned([HEAD, *edge_rows(findings)])]
    if zones := zone_rows(findings):
        parts += [
            "",
            "Slip zones at the end of the half-cycle",
            *_aligned([ZONES, *zones]),
            "",
            f"  {SERIES}",
            f"  {REACH}",
        ]
    parts += ["", "+- is one standard deviation"]
    parts += ["", "Reasons"]
    for e in findings.edges:
        where = f"{e.step}, " if e.step else ""
        if e.pressure.why:
            parts.append(folded(f"  {where}{e.side}: {e.pressure.why}"))
    parts += [
        folded(f"  {e.side}, shear: {e.shear.why}")
        for e in findings.edges
        if e.shear and e.shear.why
    ]
    if findings.notes:
        parts += ["", "Notes", *(folded(f"  {note}") for note in findings.notes)]
    return "\n".join(parts)


def _aligned(rows: Sequence[Sequence[str]]) -> Iterator[str]:
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    for row in rows:
        yield "  " + "  ".join(f"{cell:>{w}}" for cell, w in zip(row, widths, strict=True))


CSV_HEAD = "load_step,side,"
"""The beginning of a table of results, by which it is recognised."""


def as_csv(findings: Findings) -> str:
    """Return one row for each load step and edge in SI units; the last step has slip zones."""
    names = ["load_step", "side", "edge", "K_N", "L_N", "edge_error", "K_N_error", "L_N_error"]
    names += ["nodes", "stretch"]
    names += ["K_T", "K_T_error", "da", "d", "error", "series", "order", "part"]
    out = io.StringIO()
    writer = csv.DictWriter(out, names, extrasaction="ignore", lineterminator="\n")
    writer.writeheader()
    for e in findings.edges:
        row = {"load_step": _inert(e.step), "side": e.side, **e.pressure._asdict()}
        if e.shear and e.zone:
            row = e.shear._asdict() | {"da": e.da} | asdict(e.zone) | row
        writer.writerow(row)
    return out.getvalue()


def _inert(label: str) -> str:
    """A label that a spreadsheet shows and does not compute: a formula begins with = + - or @."""
    return f"'{label}" if label[:1] in tuple("=+-@\t\r") else label


def as_page(findings: Findings, steps: Sequence[Step], title: str) -> str:
    """Return an HTML page with a picture of each edge at the end of the half-cycle."""
    last = [e for e in findings.edges if e.step == steps[-1].name and np.isfinite(e.pressure.edge)]
    zones = zone_rows(findings)
    made = templates("derive.edge", "edge")
    return made.get_template("report.html").render(
        title=title,
        edge_head=HEAD,
        edges=edge_rows(findings),
        zone_head=ZONES,
        zones=zones,
        legend=["± is one standard deviation", *([SERIES, REACH] if zones else [])],
        pictures=[(e, _picture(e, steps[-1])) for e in last],
        notes=findings.notes,
    )


def _picture(e: FittedEdge, step: Step) -> Markup:
    """Plot nodal pressures, the fit and K_N sqrt(s) against the distance s on log axes."""
    from derive.sheet.picture import Line, curves

    s, p = INWARD[e.side] * (step.x - e.pressure.edge), step.p
    shown = (s > 0) & (p > 0) & (s <= 4 * e.pressure.stretch)
    s, p = s[shown], p[shown]
    if len(s) < 2:
        return Markup()
    fine = np.geomspace(s.min() / 2, e.pressure.stretch, 80)
    first = e.pressure.K_N * np.sqrt(fine)
    second = first + e.pressure.L_N * fine**1.5
    above = second > 0
    drawn = [
        ("√s term", fine, first, "--"),
        ("both terms", fine[above], second[above], "-"),
        ("nodes", s, p, "k."),
    ]
    if e.zone and fine[0] < e.zone.d < s.max():
        heights = np.array([min(p.min(), first.min()), max(p.max(), first.max())])
        drawn.append(("end of the slip zone", np.full(2, e.zone.d), heights, "C3-"))
    lines = [Line(name, 1e3 * x, 1e-6 * y, look) for name, x, y, look in drawn]
    labels = "pressure at an edge", "distance from the edge [mm]", "pressure [MPa]"
    return curves(*labels, lines, is_log=True)
