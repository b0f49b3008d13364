"""What an installed package does without a clone, and `generated` without SymPy."""

import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner

import derive.pipeline
from derive.body.library import library
from derive.command.cli import main

ROOT = Path(__file__).parents[1]

WITHOUT = """
import sys

blocked = ("sympy", "mpmath", "flint", "gmpy2", "derive", "click", "rich", "matplotlib")
blocked += ("scipy", "threadpoolctl", "numba")
for name in blocked:
    sys.modules[name] = None  # an import of it fails
from importlib import import_module

for body in sys.argv[1:]:
    import_module("generated." + body)
from generated import hertz

here = hertz.contact(1.2, 0.1, E_star=1.0, R=1.0)
friction = {"f": 0.5, "E_star": 1.0, "R": 1.0}
assert hertz.stick_zone(here, here, 0.1, 0.01, **friction).regime == 1
assert hertz.stick_zone(here, here, 0.3, 0.3245, **friction, mixed=True).regime == 3
print(hertz.load(1.5, 1.0, E_star=1.0, R=1.0))
"""


def test_generated_needs_nothing_of_the_derivation() -> None:
    command = [sys.executable, "-c", WITHOUT, *library(), "edge", "full_stick"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert float(done.stdout) == pytest.approx(1.22718463, rel=1e-8)  # 25 pi/64: pi (5/2)^2/16


@pytest.mark.parametrize("asked", [[], ["hertz"]])
def test_an_installed_package_is_not_written_to(
    asked: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    installed = tmp_path / "site-packages" / "generated"
    installed.mkdir(parents=True)
    monkeypatch.setattr(derive.pipeline, "GENERATED", installed)
    done = CliRunner().invoke(main, ["generate", *asked])
    assert done.exit_code == 2
    assert done.output.count("\n") == 1
    assert "--out" in done.output and "installed" in done.output
    assert not list(installed.iterdir())
