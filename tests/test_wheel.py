"""The package as its users have it: installed from a wheel, without the optional libraries."""

import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]

OPTIONAL = ("latex2mathml", "matplotlib", "tqdm", "dask", "ipywidgets", "nbformat")

BLOCKING = f"""
import sys
sys.modules.update(dict.fromkeys({OPTIONAL}))  # an import then fails
import derive.proof.verdict
derive.proof.verdict.POINTS = 2  # for 24, a third of a minute
"""

EXAMPLES = r"""
import doctest, importlib.util, re, sys
from pathlib import Path
text = Path(sys.argv[1]).read_text(encoding="utf-8")
test = doctest.DocTestParser().get_doctest(text, {}, "README", None, 0)
done = doctest.DocTestRunner().run(test, clear_globs=False)
assert done.attempted >= 14, done
del sys.modules["matplotlib"]
(plot,) = re.findall(r"```python\n(import matplotlib.*?)```", text, re.S)
if importlib.util.find_spec("matplotlib"):
    exec(plot, test.globs)
sys.exit(done.failed)
"""

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the installed package, its command, and nothing optional."""
    folder = tmp_path_factory.mktemp("installed")
    pip = [sys.executable, "-m", "pip", "--disable-pip-version-check", "--quiet"]
    source, names = folder / "source", ("pyproject.toml", "README.md", "LICENSE")
    for package in ("derive", "generated"):
        compiled = shutil.ignore_patterns("__pycache__")
        shutil.copytree(ROOT / package, source / package, ignore=compiled)
    for name in names:  # a build in the clone would leave files there, and take up old ones
        shutil.copy(ROOT / name, source / name)
    made = [*pip, "wheel", str(source), "--no-deps", "--wheel-dir", str(folder)]
    done = subprocess.run(made, capture_output=True, text=True)
    if done.returncode and "No matching distribution" in done.stderr:
        pytest.skip("no setuptools can be downloaded, which builds the wheel")
    assert done.returncode == 0, done.stderr
    (wheel,) = folder.glob("*.whl")
    shutil.unpack_archive(wheel, folder / "site", "zip")
    (folder / "site" / "sitecustomize.py").write_text(BLOCKING)
    return folder


def run(installed: Path, folder: Path, *arguments: str) -> "subprocess.CompletedProcess[str]":
    """Python in a folder of the user's, with the installed package; nothing is compiled."""
    paths = {"PYTHONPATH": str(installed / "site")}
    settings = os.environ | paths | {"NUMBA_DISABLE_JIT": "1", "MPLBACKEND": "Agg"}
    command = [sys.executable, *arguments]
    return subprocess.run(command, cwd=folder, env=settings, capture_output=True, text=True)


def derive(installed: Path, folder: Path, line: str) -> "subprocess.CompletedProcess[str]":
    main = "import sys; from derive.command.cli import main; sys.argv[0] = 'derive'; main()"
    return run(installed, folder, "-c", main, *shlex.split(line))


def test_the_readme_s_lines_run_as_printed(installed: Path, tmp_path: Path) -> None:
    """Its commands in their order, then all examples, and the plot, which needs an extra."""
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    (block,) = re.findall(r"```sh\n(derive new.*?)```", readme, re.S)
    lines = re.findall(r"^derive (.*?)(?: +#.*)?$", block, re.M)
    lines += [f"check {ROOT / 'examples' / 'cattaneo_mindlin.toml'}"]
    assert len(lines) >= 4
    for line in lines:
        done = derive(installed, tmp_path, line)
        assert done.returncode == 0, (line, done.stderr)
    done = run(installed, tmp_path, "-c", EXAMPLES, str(ROOT / "README.md"))
    assert done.returncode == 0, done.stdout + done.stderr


def test_what_needs_an_extra_is_refused(installed: Path, tmp_path: Path) -> None:
    done = derive(installed, tmp_path, "show hertz --html")
    assert done.returncode == 2
    assert "pip install 'contact-derive[handbook]'" in done.stderr
