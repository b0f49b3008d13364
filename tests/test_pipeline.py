"""What is to be generated is known before SymPy is imported."""

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]

WITHOUT_SYMPY = """
import sys
from derive import pipeline
from derive.command import processes
pipeline.Order(("hertz",), writes=False)
late = {"sympy", "numpy", "scipy"} & set(sys.modules)
assert not late, late
"""


def test_an_order_does_not_wait_for_sympy() -> None:
    subprocess.run([sys.executable, "-c", WITHOUT_SYMPY], check=True, cwd=ROOT)
