"""What is kept is found again, whole; what is not whole, or may be out of date, is not."""

import json
import os
import shutil
from collections.abc import Callable
from dataclasses import asdict, fields, replace
from hashlib import sha256
from importlib import metadata
from pathlib import Path

import pytest
from platformdirs import user_cache_dir

import derive.command.cache
from derive.body.library import FOLDER
from derive.command.cache import (
    PROGRAM,
    VARIABLE,
    Cache,
    distrusted,
    key_of,
    program_digest,
    users_cache,
)
from derive.command.processes import in_processes
from derive.proof.verdict import Verdict
from derive.sheet.built import Body
from tests.tasks import KEY, write_often

OTHER = "1" * 64
VERDICTS = (("tilt", Verdict.PROVEN), ("L_N_left", Verdict.NUMERICAL))
PROOFS = (("tilt", "proven: I_0 = 0; α"), ("L_N_left", "numerical: 31 digits at 24 points"))
FORMS = ("forward",), ("from (P, M)",)
BODY = Body("hertz", 'text = "α ≤ φ"\r\n', "stuck = 1", 1.25, *FORMS, VERDICTS, PROOFS, "struck")
PLAIN = """from sympy import Abs
from derive import Geometry, parameter, x
geometry = Geometry("body", g=parameter("phi", "slope", unit="rad") * Abs(x))
"""


@pytest.fixture
def cache(tmp_path: Path) -> Cache:
    """A cache that holds BODY under KEY."""
    held = Cache(tmp_path / "some" / "where")
    held.put(KEY, BODY)
    return held


@pytest.fixture
def file(cache: Cache) -> Path:
    """The file of BODY."""
    assert cache.folder is not None
    (path,) = cache.folder.iterdir()
    return path


def names(folder: Path | None) -> set[str]:
    return {path.name for path in folder.iterdir()} if folder else set()


# ------------------------------------------------------------------ kept and found


def test_nothing_of_a_body_is_lost(cache: Cache) -> None:
    """Field by field: equality does not see all of them."""
    assert cache.get(OTHER) is cache.get(None) is None
    found = cache.get(KEY)
    assert found is not None
    assert asdict(found) == asdict(BODY) | {"kept": True}
    for of in fields(Body):  # each could be lost: none of them is what it is by default
        assert of.name == "kept" or getattr(BODY, of.name) != of.default


@pytest.mark.parametrize("proofs", [None, [], [["tilt", "proven: I_0 = 0"]]])
def test_a_body_without_its_proofs_is_as_good_as_none(
    cache: Cache, file: Path, proofs: list[list[str]] | None
) -> None:
    """As a version that knew of none, or lost them, would have kept it: whole, but no more."""
    body = json.loads(file.read_bytes())["body"]
    del body["proofs"]
    body |= {} if proofs is None else {"proofs": proofs}
    digest = derive.command.cache._digest([KEY, body])
    file.write_text(json.dumps({"body": body, "digest": digest}))
    assert cache.get(KEY) is None


# ------------------------------------------------------------------ not whole, not ours


def facts(file: Path) -> dict[str, object]:
    return json.loads(file.read_bytes())


DAMAGES: dict[str, Callable[[Path], bytes]] = {
    "empty": lambda file: b"",
    "half": lambda file: file.read_bytes()[: file.stat().st_size // 2],
    "one byte": lambda file: file.read_bytes().replace(b"text =", b"text +"),
    "no text": lambda file: b"\xff\xfe\x00",
    "other names": lambda file: b"{}",
    "text for a body": lambda file: b'{"body": "hertz", "digest": "0"}',
    "deep": lambda file: b"[" * 1_000_000,
    "no digest": lambda file: json.dumps({"body": facts(file)["body"]}).encode(),
    "wrong digest": lambda file: json.dumps(facts(file) | {"digest": OTHER}).encode(),
    "less of a body": lambda file: json.dumps({**facts(file), "body": {"name": "a"}}).encode(),
}


@pytest.mark.skipif(not hasattr(os, "getuid"), reason="rights of Unix")
@pytest.mark.parametrize("mode", [0o620, 0o602, 0o666])
def test_a_file_that_others_may_write_to_is_replaced(cache: Cache, file: Path, mode: int) -> None:
    file.chmod(mode)
    assert cache.get(KEY) is None
    cache.put(KEY, BODY)
    assert cache.get(KEY) == BODY
    assert file.stat().st_mode & 0o777 == 0o600


@pytest.mark.skipif(not hasattr(os, "getuid"), reason="rights of Unix")
def test_what_belongs_to_another_user_is_not_used(
    cache: Cache, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The advice names a command that helps: the rights of the directory cannot be changed."""
    monkeypatch.setenv(VARIABLE, str(cache.folder))
    assert (users_cache().folder, distrusted()) == (cache.folder, "")
    monkeypatch.setattr("os.getuid", lambda: cache.folder.stat().st_uid + 1)  # type: ignore[union-attr]
    assert (users_cache().folder, cache.get(KEY)) == (None, None)
    assert "belongs to another user: run `export DERIVE_CACHE=" in distrusted()


@pytest.mark.parametrize("damage", DAMAGES)
def test_what_is_not_whole_is_as_good_as_none(cache: Cache, file: Path, damage: str) -> None:
    file.write_bytes(DAMAGES[damage](file))
    assert cache.get(KEY) is None
    cache.put(KEY, BODY)
    assert cache.get(KEY) == BODY


# ------------------------------------------------------------------ directories


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
    assert names(tmp_path) == {f"{KEY}.json"}


# ------------------------------------------------------------------ old entries


def key(number: int) -> str:
    return sha256(str(number).encode()).hexdigest()


@pytest.fixture
def small(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Cache:
    """A cache of three bodies that is full; the first one is the oldest."""
    monkeypatch.setattr(derive.command.cache, "MOST", 3)
    held = Cache(tmp_path)
    for number in range(3):
        held.put(key(number), BODY)
        os.utime(tmp_path / f"{key(number)}.json", (1000.0 + number, 1000.0 + number))
    return held


@pytest.mark.parametrize(("used", "left"), [([], {1, 2, 3}), ([0], {0, 2, 3})])
def test_the_oldest_goes_that_was_not_used(small: Cache, used: list[int], left: set[int]) -> None:
    for number in used:
        small.get(key(number))
    small.put(key(3), BODY)
    assert names(small.folder) == {f"{key(number)}.json" for number in left}


def test_what_a_killed_process_left_half_written_goes_and_what_is_not_ours_stays(
    small: Cache,
) -> None:
    assert small.folder is not None
    half, others = f"{KEY}.abc_123.tmp", {"notes.txt", "hertz.json", f"{KEY}.txt", ".json"}
    for name in (half, *others):
        (small.folder / name).write_text("mine")
        os.utime(small.folder / name, (1, 1))
    small.put(key(3), BODY)
    assert half not in names(small.folder) and others < names(small.folder)


# ------------------------------------------------------------------ keys


@pytest.fixture
def geometry(tmp_path: Path) -> Path:
    path = tmp_path / "body.py"
    path.write_text(PLAIN)
    return path


def test_the_same_has_the_same_key(geometry: Path, tmp_path: Path) -> None:
    """Wherever the file lies, whenever it was written."""
    found = key_of(geometry, "body.py", OTHER)
    assert found is not None
    assert len(found) == 64
    os.utime(geometry, (1, 1))
    (tmp_path / "folder").mkdir()
    moved = geometry.rename(tmp_path / "folder" / "another.py")
    assert key_of(moved, "body.py", OTHER) == found


def test_the_origin_and_the_program_change_the_key(geometry: Path) -> None:
    origins = ("body.py", "derive/geometries/body.py")
    assert len({key_of(geometry, o, p) for o in origins for p in (KEY, OTHER)}) == 4


KEPT = [
    "import sympy\n",
    "from sympy.functions import cosh\n",
    "import mpmath\nfrom fractions import Fraction\n",
    "from derive import x as place\n",
]
NOT_KEPT = [
    "import os\n",
    "import mine\n",
    "from mine import R\n",
    "from . import mine\n",
    "from .sympy import mine\n",
    "import numpy as np\n",  # which reads files
    "from pathlib import Path\n",
    "from importlib import import_module\n",
    "from derive import load_geometry\n",
    "from derive.body.library import load_geometry\n",
    "def late():\n    import mine\n",
    "R = open('R.txt').read()\n",
    "R = eval('3')\n",
    "exec('import mine')\n",
    "mine = __import__('mine')\n",
    "here = __file__\n",
    "reader = __builtins__\n",
    "geometry = (\n",
    "-" * 200_000 + "1\n",
]


@pytest.mark.parametrize("text", KEPT + NOT_KEPT, ids=lambda text: repr(text)[:40])
def test_a_file_that_could_read_more_is_never_kept(geometry: Path, text: str) -> None:
    geometry.write_text(text + PLAIN)
    assert (key_of(geometry, "body.py", OTHER) is None) == (text in NOT_KEPT)


# ------------------------------------------------------------------ the program


@pytest.fixture
def program(tmp_path: Path) -> Path:
    """A copy of the program's sources."""
    ignored = shutil.ignore_patterns("__pycache__")
    return Path(shutil.copytree(PROGRAM, tmp_path / "derive", ignore=ignored))


def test_every_folder_of_the_program_counts(program: Path) -> None:
    """A line added to its last file, and that file gone, give digests that there were not yet."""
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
def test_the_version_of_a_library_counts(
    program: Path, monkeypatch: pytest.MonkeyPatch, library: str
) -> None:
    before, real = program_digest(program), metadata.version
    monkeypatch.setattr(metadata, "version", lambda name: "0" if name == library else real(name))
    assert program_digest(program) != before
