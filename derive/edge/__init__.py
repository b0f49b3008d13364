"""Compute slip zones from a finite-element table, for the command `derive edge`.

table   reads an exported file and returns its load steps in SI units
find    computes coefficients, movements and slip zones of both edges, with their uncertainties
report  writes the results as text, as CSV, or as an HTML page

The mathematics is in generated/runtime/edge.

Raises OtherRuntime if Python finds another version of that library, in the current folder for
instance.
"""

from pathlib import Path

import generated.runtime
from derive.command.errors import OtherRuntime

VERSION = 2
"""The version of generated/runtime that this package needs."""

if getattr(generated.runtime, "VERSION", 0) != VERSION:
    raise OtherRuntime(str(Path(generated.runtime.__path__[0]).parent))
