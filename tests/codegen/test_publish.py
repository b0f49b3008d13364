"""A package is replaced whole or not at all, and nothing but a package of ours is replaced."""

import errno
import signal
import subprocess
import sys
from collections.abc import Callable
from itertools import count
from pathlib import Path

import pytest

from derive.codegen.publish import MARK, RUNTIME, differences, package_files
from derive.command.errors import BadTarget
from derive.command.folder import MANIFEST, replace_folder
from tests.commands import contents

OLD = package_files({"cylinder": f"{MARK}\nold = 1\n", "wedge": f"{MARK}\nwedge = 1\n"})
NEW = package_files({"cylinder": f"{MARK}\nnew = 2\n", "punch": f"{MARK}\npunch = 2\n"})


def as_bytes(files: dict[str, str]) -> dict[str, bytes]:
    return {name: text.encode() for name, text in files.items()}


@pytest.fixture
def package(tmp_path: Path) -> Path:
    """A published package."""
    replace_folder(OLD, tmp_path / "package")
    return tmp_path / "package"


# ------------------------------------------------------------------ our own package


def test_the_library_of_our_own_package_is_left_alone(package: Path) -> None:
    """Whatever was written there by hand, even if what is generated was changed as well."""
    library = package / RUNTIME
    (library / "arrays.py").write_text("mine = 1\n")
    (library / "notes").mkdir()
    (library / "notes" / "new.md").write_text("mine")
    (package / "cylinder.py").write_text("changed = 1\n")
    before = contents(library)
    files = package_files({"punch": f"{MARK}\npunch = 2\n"}, with_runtime=False)
    assert not any(name.startswith(RUNTIME) for name in files[MANIFEST].split())
    assert {d.name for d in differences(files, package, RUNTIME)} == {
        *("__init__.py", "cylinder.py", MANIFEST, "punch.py", "wedge.py"),
    }
    replace_folder(files, package, RUNTIME)
    assert contents(library) == before
    assert contents(package) == as_bytes(files) | {f"{RUNTIME}/{n}": b for n, b in before.items()}
    assert differences(files, package, RUNTIME) == []
    (package / "mine.py").write_text("mine = 1\n")
    with pytest.raises(BadTarget, match=r"mine\.py"):
        replace_folder(files, package, RUNTIME)


# ------------------------------------------------------------------ accepted


def test_a_package_is_replaced_whole(package: Path) -> None:
    """A module that is no longer wanted goes, and what Python compiled; neighbours stay."""
    (package / "__pycache__").mkdir()
    (package / "__pycache__" / "wedge.cpython-311.pyc").write_bytes(b"old")
    (package.parent / "notes.txt").write_text("mine")
    replace_folder(NEW, package)
    assert contents(package) == as_bytes(NEW)
    assert not (package / "__pycache__").exists()
    assert {p.name for p in package.parent.iterdir()} == {"package", "notes.txt"}


# ------------------------------------------------------------------ refused and untouched


def compiled(folder: Path) -> Path:
    (folder / "__pycache__").mkdir()
    (folder / "__pycache__" / "cylinder.cpython-311.pyc").write_bytes(b"old")
    return folder / "__pycache__"


def without_a_list(folder: Path) -> None:
    """A package of ours, but for the list of its files."""
    (folder / MANIFEST).unlink(missing_ok=True)
    (folder / "wedge.py").write_text(OLD["wedge.py"])


FOREIGN: dict[str, Callable[[Path], object]] = {
    "a copied module": lambda folder: (folder / "my_wedge.py").write_text(OLD["wedge.py"]),
    "a folder": lambda folder: (folder / "data").mkdir(),
    "what is hidden": lambda folder: (folder / ".git").mkdir(),
    "an edited module": lambda folder: (folder / "cylinder.py").write_text(f"{MARK}\nmine = 1\n"),
    "text in the mark of types": lambda folder: (folder / "py.typed").write_text("mine"),
    "no list of files": without_a_list,
    "another list of files": lambda folder: (folder / MANIFEST).write_text("mine"),
    "a package inside": lambda folder: replace_folder(OLD, folder / "inner.py"),
    "beside what is compiled": lambda folder: (compiled(folder) / "keep.txt").write_text("mine"),
    "a folder for what is compiled": lambda folder: (compiled(folder) / "notes.pyc").mkdir(),
    "a file in its place": lambda folder: (folder / "__pycache__").write_text("mine"),
    "a link in its place": lambda folder: (folder / "__pycache__").symlink_to(folder.parent),
}


@pytest.mark.parametrize("add", FOREIGN.values(), ids=FOREIGN)
@pytest.mark.parametrize("filled", [True, False], ids=["in a package", "in an empty directory"])
def test_a_directory_that_holds_anything_else_is_untouched(
    tmp_path: Path, add: Callable[[Path], object], filled: bool
) -> None:
    folder = tmp_path / "package"
    folder.mkdir()
    if filled:
        replace_folder(OLD, folder)
    add(folder)
    before, names = contents(tmp_path), sorted(tmp_path.rglob("*"))
    with pytest.raises(BadTarget) as caught:
        replace_folder(NEW, folder)
    assert str(folder) in caught.value.message
    assert contents(tmp_path) == before
    assert sorted(tmp_path.rglob("*")) == names


@pytest.mark.parametrize("place", ["file", "file/package", "to_elsewhere", "to_nowhere"])
def test_a_file_a_place_below_one_and_a_link_are_no_package(tmp_path: Path, place: str) -> None:
    (tmp_path / "file").write_text("mine")
    (tmp_path / "elsewhere").mkdir()
    for name in ("elsewhere", "nowhere"):
        (tmp_path / f"to_{name}").symlink_to(tmp_path / name)
    with pytest.raises(BadTarget):
        replace_folder(NEW, tmp_path / place)
    assert contents(tmp_path) == {"file": b"mine"}
    assert all((tmp_path / f"to_{name}").is_symlink() for name in ("elsewhere", "nowhere"))


# ------------------------------------------------------------------ a failure in the middle


FULL = OSError(errno.ENOSPC, "No space left on device")


def failing(
    patch: pytest.MonkeyPatch, method: str, error: BaseException, after: int, times: int = 1
) -> None:
    """Lets a method of Path fail from its `after`-th call on, as often as `times`."""
    real, number = getattr(Path, method), count(1)

    def fails(*given: object, **more: object) -> object:
        if next(number) in range(after, after + times):
            raise error
        return real(*given, **more)

    patch.setattr(Path, method, fails)


@pytest.mark.parametrize(
    ("error", "method", "after"),
    [
        *((FULL, *at) for at in (("write_bytes", 1), ("write_bytes", 3), ("mkdir", 2))),
        *((FULL, "replace", 1), (FULL, "replace", 2)),
        *((KeyboardInterrupt(), "write_bytes", 2), (MemoryError(), "write_bytes", 2)),
        *((KeyboardInterrupt(), "replace", 1), (KeyboardInterrupt(), "replace", 2)),
    ],
    ids=repr,
)
def test_a_failure_or_ctrl_c_in_the_middle_leaves_the_old_package(
    package: Path, monkeypatch: pytest.MonkeyPatch, error: BaseException, method: str, after: int
) -> None:
    told = "No space left on device" if error is FULL else None
    with monkeypatch.context() as patch:
        failing(patch, method, error, after)
        with pytest.raises(BadTarget if error is FULL else type(error), match=told):
            replace_folder(NEW, package)
    assert contents(package.parent) == {f"package/{n}": b for n, b in as_bytes(OLD).items()}
    assert [p.name for p in package.parent.iterdir()] == ["package"]


def test_an_old_package_that_cannot_be_put_back_is_not_deleted(
    package: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The new package cannot be moved in, nor the old one back: it must be somewhere still."""
    with monkeypatch.context() as patch:
        failing(patch, "replace", FULL, after=2, times=2)
        with pytest.raises(BadTarget):
            replace_folder(NEW, package)
    held = [path.read_bytes() for path in package.parent.rglob("cylinder.py")]
    assert as_bytes(OLD)["cylinder.py"] in held


ENDED = """
import os, signal, sys
from pathlib import Path
from derive.command.processes import end
from derive.command import folder
from tests.codegen.test_publish import NEW
signal.signal(signal.SIGTERM, end)
signal.signal(signal.SIGINT, signal.default_int_handler)
for name in ("mkdtemp", "rmtree"):
    home = folder.tempfile if name == "mkdtemp" else folder.shutil
    def ended(*given, real=getattr(home, name), name=name, **more):
        done = real(*given, **more)
        if sys.argv[2] == name:
            os.kill(os.getpid(), int(sys.argv[3]))
        return done
    setattr(home, name, ended)
folder.replace_folder(NEW, Path(sys.argv[1]))
"""


@pytest.mark.skipif(sys.platform == "win32", reason="signals of Unix")
@pytest.mark.parametrize("kind", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("moment", ["mkdtemp", "rmtree"])
def test_a_signal_waits_until_nothing_hidden_is_left(package: Path, moment: str, kind: int) -> None:
    ended = subprocess.run(
        [sys.executable, "-c", ENDED, str(package), moment, str(int(kind))],
        cwd=Path(__file__).parents[2],
        capture_output=True,
    )
    assert ended.returncode in (-kind, 128 + kind, 1), ended.stderr
    assert contents(package) == as_bytes(NEW)
    assert [path.name for path in package.parent.iterdir()] == ["package"]


# ------------------------------------------------------------------ differences


def test_every_file_that_differs_is_named_and_its_change_shown_line_by_line(package: Path) -> None:
    (package / "__pycache__").mkdir()
    assert differences(OLD, package) == []
    (package / "notes.txt").write_text("mine")
    (package / "py.typed").unlink()
    found = {d.name: d for d in differences(NEW, package)}
    assert {"-old = 1", "+new = 2"} <= set(found["cylinder.py"].diff.splitlines())
    assert {name: d.what for name, d in found.items()} == {
        **dict.fromkeys(("__init__.py", "cylinder.py", MANIFEST), "changed"),
        "notes.txt": "not generated",
        **{"punch.py": "missing", "py.typed": "missing", "wedge.py": "not generated"},
    }
