"""What is kept is found again, whole; what may be out of date is not."""

import os
import shutil
from dataclasses import asdict, fields, replace
from hashlib import sha256
from importlib import metadata
from pathlib import Path

import pytest
from platformdirs import user_cache_dir

import derive.command.cache
from derive.body.library import FOLDER
from derive.command.cache import PROGRAM, VARIABLE, Cache, key_of, program_digest, users_cache
from derive.command.processes import in_processes
from derive.proof.verdict import Verdict
from derive.sheet.built import BuiltBody
from tests.tasks import KEY, write_often

OTHER = "1" * 64
VERDICTS = (("tilt", Verdict.PROVEN), ("L_N_left", Verdict.NUMERICAL))
PROOFS = (("tilt", "proven: I_0 = 0; α"), ("L_N_left", "numerical: 31 digits at 24 points"))
FORMS = ("forward",), ("from (P, M)",)
BODY = BuiltBody(
    "hertz", 'text = "α ≤ φ"\r\n', "stuck = 1", 1.25, *FORMS, VERDICTS, PROOFS, "no form in time"
)
PLAIN = """from sympy import Abs
from derive import Geometry, parameter, x
geometry = Geometry("body", g=parameter("phi", "slope", unit="rad") * Abs(x))
"""


def test_nothing_of_a_body_is_lost(tmp_path: Path) -> None:
    """Field by field: equality does not see all of them."""
    cache = Cache(tmp_path / "some" / "where")
    cache.put(KEY, BODY)
    assert cache.get(OTHER) is cache.get(None) is None
    found = cache.get(KEY)
    assert found is not None
    assert asdict(found) == asdict(BODY) | {"kept": True}
    for of in fields(BuiltBody):  # each could be lost: none of them is what it is by default
        assert of.name == "kept" or getattr(BODY, of.name) != of.default


@pytest.mark.parametrize("content", [b"", b"\xff\xfe\x00", b"{}", b'"hertz"', b"[" * 1_000_000])
def test_a_file_without_a_body_is_replaced(tmp_path: Path, content: bytes) -> None:
    (tmp_path / f"{KEY}.json").write_bytes(content)
    assert Cache(tmp_path).get(KEY) is None
    Cache(tmp_path).put(KEY, BODY)
    assert Cache(tmp_path).get(KEY) == BODY


def test_a_directory_that_cannot_be_is_no_error(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("mine")
    for folder in (tmp_path / "file", tmp_path / "file" / "cache"):
        Cache(folder).put(KEY, BODY)
        assert Cache(folder).get(KEY) is None
    assert (tmp_path / "file").read_text() == "mine"


def test_the_environment_names_the_directory(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(VARIABLE, str(tmp_path))
    assert users_cache() == Cache(tmp_path)
    monkeypatch.setenv(VARIABLE, "")
    assert users_cache() == Cache(None)
    monkeypatch.delenv(VARIABLE)
    assert users_cache() == Cache(Path(user_cache_dir("contact-derive", appauthor=False)))


def test_two_processes_may_keep_the_same_body(tmp_path: Path) -> None:
    """Each finds a whole one after each of its own, one or the other."""
    long = replace(BODY, text="long " * 20_000)
    items = [(str(tmp_path), BODY), (str(tmp_path), long)]
    assert in_processes(write_often, items, lambda *_: None, 2) == [200, 200]
    assert Cache(tmp_path).get(KEY) in (BODY, long)
    assert [path.name for path in tmp_path.iterdir()] == [f"{KEY}.json"]


@pytest.mark.parametrize(("used", "left"), [([], {1, 2, 3}), ([0], {0, 2, 3})])
def test_the_oldest_goes_that_was_not_used(
    used: list[int], left: set[int], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What is not a file of the cache stays."""
    monkeypatch.setattr(derive.command.cache, "MOST", 3)
    keys = [sha256(str(number).encode()).hexdigest() for number in range(4)]
    (tmp_path / "hertz.json").write_text("mine")
    for number in range(3):
        Cache(tmp_path).put(keys[number], BODY)
        os.utime(tmp_path / f"{keys[number]}.json", (1000.0 + number, 1000.0 + number))
    for number in used:
        Cache(tmp_path).get(keys[number])
    Cache(tmp_path).put(keys[3], BODY)
    names = {path.name for path in tmp_path.iterdir()}
    assert names == {f"{keys[number]}.json" for number in left} | {"hertz.json"}


# ------------------------------------------------------------------ keys


@pytest.fixture
def geometry(tmp_path: Path) -> Path:
    path = tmp_path / "body.py"
    path.write_text(PLAIN)
    return path


def test_a_key_depends_on_content_origin_and_program(geometry: Path, tmp_path: Path) -> None:
    """Not on where the file lies, nor on when it was written."""
    found = key_of(geometry, "body.py", OTHER)
    assert found is not None and len(found) == 64
    assert key_of(geometry, "derive/geometries/body.py", OTHER) != found
    assert key_of(geometry, "body.py", KEY) != found
    (tmp_path / "folder").mkdir()
    moved = geometry.rename(tmp_path / "folder" / "another.py")
    os.utime(moved, (1, 1))
    assert key_of(moved, "body.py", OTHER) == found
    moved.write_text(f"{PLAIN}\n")
    assert key_of(moved, "body.py", OTHER) != found


KEPT = [
    "import sympy\n",
    "from sympy.functions import cosh\n",
    "import mpmath\nfrom fractions import Fraction\n",
    "from derive import x as place\n",
]
NOT_KEPT = [
    "import mine\n",
    "from mine import R\n",
    "from .sympy import mine\n",
    "import numpy as np\n",  # which reads files
    "from importlib import import_module\n",
    "from derive import load_geometry\n",
    "from derive.body.library import load_geometry\n",
    "def late():\n    import mine\n",
    "R = open('R.txt').read()\n",
    "exec('import mine')\n",
    "here = __file__\n",
    "geometry = (\n",
    "-" * 200_000 + "1\n",
]


@pytest.mark.parametrize("text", KEPT + NOT_KEPT, ids=lambda text: repr(text)[:40])
def test_a_file_that_could_read_more_is_never_kept(geometry: Path, text: str) -> None:
    geometry.write_text(text + PLAIN)
    assert (key_of(geometry, "body.py", OTHER) is None) == (text in NOT_KEPT)


def test_every_folder_of_the_program_counts(tmp_path: Path) -> None:
    """A line added to its last file, and that file gone, give digests that there were not yet."""
    program = tmp_path / "derive"
    shutil.copytree(PROGRAM, program, ignore=shutil.ignore_patterns("__pycache__"))
    names = [path.relative_to(PROGRAM) for path in PROGRAM.rglob("*.py") if path.parent != FOLDER]
    assert len(names) > 100
    seen = {program_digest(program)}
    last = {name.parent: name for name in sorted(names)}.values()
    for name in (*last, Path("codegen", "solved.txt")):
        with (program / name).open("a") as file:
            file.write("\n")
        changed = program_digest(program)
        (program / name).unlink()
        gone = program_digest(program)
        assert len({changed, gone} - seen) == 2, name
        seen |= {changed, gone}


@pytest.mark.parametrize("library", ["sympy", "ruff"])
def test_the_version_of_a_library_counts(monkeypatch: pytest.MonkeyPatch, library: str) -> None:
    before, real = program_digest(), metadata.version
    monkeypatch.setattr(metadata, "version", lambda name: "0" if name == library else real(name))
    assert program_digest() != before
