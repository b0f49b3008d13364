"""The Monte Carlo example on a cluster of processes of this machine: nothing leaves loopback."""

import importlib
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from generated import wedge
from generated.runtime.kernels import COMPILING

ROOT = Path(__file__).parents[2]
EXAMPLE = ROOT / "examples" / "monte_carlo.py"

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def monte_carlo() -> Any:
    """The example as a module."""
    spec = importlib.util.spec_from_file_location("monte_carlo", EXAMPLE)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def expected(of: Any, samples: int) -> Any:
    """The same by NumPy alone, all samples at once."""
    P, M, f = (of.drawn(name, 0, 0, samples) for name in of.SCATTER)
    left, right, regime = of.slip_zones(P, M, f)
    bins = {"bins": of.BINS, "range": (0.0, of.LONGEST)}
    counts = [np.histogram(zone, **bins)[0] for zone in (left, right)]
    return of.Counts(*counts, np.bincount(regime, minlength=len(wedge.Regime)))


@pytest.mark.enough("1-1")
@pytest.mark.parametrize(("chunk", "workers"), [(1, 1), (5, 2)])
def test_the_monte_carlo_counts_what_numpy_counts(
    monte_carlo: Any, tmp_path: Path, chunk: int, workers: int
) -> None:
    """Whatever the chunks and the workers: 120,000 samples, the last stream of them not whole."""
    samples = 2 * monte_carlo.STREAM + 20_000
    wanted = expected(monte_carlo, samples)
    lines = [*monte_carlo.report(wanted)]
    command = [sys.executable, "-W", "error", str(EXAMPLE), f"--out={tmp_path / 'slip.csv'}"]
    command += [f"--chunk={chunk * monte_carlo.STREAM}", f"--workers={workers}"]
    path = os.environ | {"PYTHONPATH": str(ROOT)}
    done = subprocess.run(
        [*command, f"--samples={samples}"], cwd=ROOT, capture_output=True, text=True, env=path
    )
    assert done.returncode == 0, done.stderr
    assert done.stderr.replace(f"{COMPILING}\n", "") == ""
    rows = np.genfromtxt(tmp_path / "slip.csv", delimiter=",", skip_header=1)
    assert_array_equal(rows[:, 2], wanted.left)
    assert_array_equal(rows[:, 3], wanted.right)
    assert done.stdout.splitlines()[-len(lines) :] == lines
    assert "100%" in done.stdout


@pytest.mark.parametrize(
    ("argument", "words"),
    [
        ("--samples=0", "must be a whole number, such as 1e8 or 1000000, got 0"),
        ("--chunk=7", "--chunk must be a multiple of 50000, got 7"),
        ("--out=nowhere/slip.csv", "there is no directory nowhere"),
        ("--scheduler=tcp://127.0.0.1:1", "no cluster answers at tcp://127.0.0.1:1"),
    ],
)
def test_the_monte_carlo_says_what_is_wrong(
    monte_carlo: Any,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    argument: str,
    words: str,
) -> None:
    monkeypatch.setattr(sys, "argv", ["monte_carlo.py", argument, "--wait=1"])
    with pytest.raises(SystemExit) as caught:
        monte_carlo.main()
    assert words in f"{caught.value}{capsys.readouterr().err}"
    assert caught.value.code not in (0, None)
