"""A package is replaced whole or not at all, and nothing but a package of ours is replaced."""

import errno
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from derive.codegen import publish as publisher
from derive.codegen.mark import MARK
from derive.codegen.publish import (
    demand_replaceable,
    differences,
    modules_in,
    package_files,
    publish,
)
from derive.errors import BadOutput
from derive.pipeline import GENERATED

OLD = package_files({"cylinder": f"{MARK}\nold = 1\n", "wedge": f"{MARK}\nwedge = 1\n"})
NEW = package_files({"cylinder": f"{MARK}\nnew = 2\n", "punch": f"{MARK}\npunch = 2\n"})


def contents(folder: Path) -> dict[str, bytes]:
    """Every file below a folder, by its relative path."""
    return {str(p.relative_to(folder)): p.read_bytes() for p in folder.rglob("*") if p.is_file()}


def as_bytes(files: dict[str, str]) -> dict[str, bytes]:
    return {name: text.encode() for name, text in files.items()}


@pytest.fixture
def package(tmp_path: Path) -> Path:
    """A published package."""
    publish(OLD, tmp_path / "package")
    return tmp_path / "package"


# ------------------------------------------------------------------ what a package holds


def test_a_package_holds_its_modules_and_what_they_need() -> None:
    files = package_files({"cylinder": "text"})
    assert {"__init__.py", "py.typed", "cylinder.py", "runtime/slip/zone.py"} <= files.keys()
    assert files["cylinder.py"] == "text"
    assert all(text.startswith(MARK) for name, text in files.items() if "runtime" in name)


def test_modules_of_a_package_are_read_back(package: Path) -> None:
    assert modules_in(package) == {
        "cylinder": OLD["cylinder.py"],
        "wedge": OLD["wedge.py"],
    }
    assert modules_in(package / "nowhere") == {}


def test_a_package_of_an_earlier_version_may_be_replaced(package: Path) -> None:
    """It does not list its modules."""
    (package / "__init__.py").write_text(f'{MARK}\n"""Contact laws."""\n')
    publish(NEW, package)
    assert contents(package) == as_bytes(NEW)


def test_the_committed_package_may_be_replaced() -> None:
    demand_replaceable(GENERATED)


# ------------------------------------------------------------------ accepted


def test_a_directory_that_is_absent_is_made(tmp_path: Path) -> None:
    publish(NEW, tmp_path / "some" / "where" / "package")
    assert contents(tmp_path / "some" / "where" / "package") == as_bytes(NEW)
    assert [p.name for p in (tmp_path / "some" / "where").iterdir()] == ["package"]


def test_a_package_is_replaced_whole(package: Path) -> None:
    """A module that is no longer wanted goes, and what Python compiled; neighbours stay."""
    (package / "__pycache__").mkdir()
    (package / "__pycache__" / "wedge.cpython-311.pyc").write_bytes(b"old")
    (package.parent / "notes.txt").write_text("mine")
    publish(NEW, package)
    assert contents(package) == as_bytes(NEW)
    assert {p.name for p in package.parent.iterdir()} == {"package", "notes.txt"}


def test_texts_are_written_byte_by_byte(tmp_path: Path) -> None:
    files = package_files({"cylinder": f"{MARK}\n# α ≤ φ\r\n"})
    publish(files, tmp_path / "package")
    assert contents(tmp_path / "package") == as_bytes(files)


# ------------------------------------------------------------------ refused and untouched


def add_notes(folder: Path) -> None:
    (folder / "notes.txt").write_text("mine")


def add_module(folder: Path) -> None:
    (folder / "mine.py").write_text('"""Mine."""\n')


def add_folder(folder: Path) -> None:
    (folder / "data").mkdir()


def add_hidden(folder: Path) -> None:
    (folder / ".git").mkdir()


def add_package_inside(folder: Path) -> None:
    publish(OLD, folder / "inner.py")


def add_to_what_is_compiled(folder: Path) -> None:
    (folder / "__pycache__").mkdir()
    (folder / "__pycache__" / "cylinder.cpython-311.pyc").write_bytes(b"old")
    (folder / "__pycache__" / "keep.txt").write_text("mine")


def add_a_folder_to_what_is_compiled(folder: Path) -> None:
    (folder / "__pycache__" / "notes.pyc").mkdir(parents=True)


def add_a_file_in_its_place(folder: Path) -> None:
    (folder / "__pycache__").write_text("mine")


def add_a_link_in_its_place(folder: Path) -> None:
    (folder / "__pycache__").symlink_to(folder.parent)


def take_the_mark_off(folder: Path) -> None:
    for path in folder.glob("*.py"):
        path.write_text("# mine now\n" + path.read_text())
    (folder / "cylinder.py").write_text("mine = 1\n")


def copy_a_module(folder: Path) -> None:
    (folder / "my_wedge.py").write_text(f"{MARK}\nmine = 1\n")
    (folder / "__init__.py").write_text(NEW["__init__.py"])


FOREIGN = (
    copy_a_module,
    *(add_notes, add_module, add_folder, add_hidden, add_package_inside, take_the_mark_off),
    *(add_to_what_is_compiled, add_a_folder_to_what_is_compiled),
    *(add_a_file_in_its_place, add_a_link_in_its_place),
)


@pytest.mark.parametrize("add", FOREIGN)
@pytest.mark.parametrize("filled", [True, False], ids=["in a package", "in an empty directory"])
def test_a_directory_that_holds_anything_else_is_untouched(
    tmp_path: Path, add: Callable[[Path], None], filled: bool
) -> None:
    folder = tmp_path / "package"
    folder.mkdir()
    if filled:
        publish(OLD, folder)
    add(folder)
    before, names = contents(tmp_path), sorted(tmp_path.rglob("*"))
    with pytest.raises(BadOutput) as caught:
        publish(NEW, folder)
    assert str(folder) in caught.value.message
    assert contents(tmp_path) == before
    assert sorted(tmp_path.rglob("*")) == names


def test_a_file_is_no_package(tmp_path: Path) -> None:
    path = tmp_path / "package"
    path.write_text("mine")
    with pytest.raises(BadOutput):
        publish(NEW, path)
    assert path.read_text() == "mine"


def test_a_directory_below_a_file_is_refused(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("mine")
    with pytest.raises(BadOutput):
        publish(NEW, tmp_path / "file" / "package")
    assert contents(tmp_path) == {"file": b"mine"}


@pytest.mark.parametrize("target", ["elsewhere", "nowhere"])
def test_a_link_is_not_replaced(tmp_path: Path, target: str) -> None:
    (tmp_path / "elsewhere").mkdir()
    link = tmp_path / "package"
    link.symlink_to(tmp_path / target)
    with pytest.raises(BadOutput):
        publish(NEW, link)
    assert link.is_symlink()
    assert contents(tmp_path) == {}


# ------------------------------------------------------------------ a failure in the middle


class Failure:
    """A method of Path that fails from its `after`-th call on, as often as `times`."""

    def __init__(self, method: str, error: BaseException, after: int, times: int = 1) -> None:
        self.real, self.error = getattr(Path, method), error
        self.calls, self.window = 0, range(after, after + times)

    def __get__(self, path: Path, _: type | None = None) -> Callable[..., object]:
        return lambda *args, **kwargs: self(path, *args, **kwargs)

    def __call__(self, path: Path, *args: object, **kwargs: object) -> object:
        self.calls += 1
        if self.calls in self.window:
            raise self.error
        return self.real(path, *args, **kwargs)


FULL = OSError(errno.ENOSPC, "No space left on device")


def failing(
    monkeypatch: pytest.MonkeyPatch, method: str, error: BaseException, after: int, times: int = 1
) -> None:
    monkeypatch.setattr(Path, method, Failure(method, error, after, times))


@pytest.fixture
def in_two_steps(monkeypatch: pytest.MonkeyPatch) -> None:
    """A system that cannot exchange two directories in one step."""
    monkeypatch.setattr("derive.exchange._exchanged", lambda *_: False)


@pytest.mark.usefixtures("in_two_steps")
@pytest.mark.parametrize(
    ("method", "after"),
    [("write_bytes", 1), ("write_bytes", 3), ("replace", 1), ("replace", 2), ("mkdir", 2)],
)
def test_a_failure_in_the_middle_leaves_the_old_package(
    package: Path, monkeypatch: pytest.MonkeyPatch, method: str, after: int
) -> None:
    with monkeypatch.context() as patch:
        failing(patch, method, FULL, after)
        with pytest.raises(BadOutput, match=r"No space left on device.*: free some space"):
            publish(NEW, package)
    assert contents(package.parent) == {f"package/{n}": b for n, b in as_bytes(OLD).items()}
    assert [p.name for p in package.parent.iterdir()] == ["package"]


@pytest.mark.usefixtures("in_two_steps")
@pytest.mark.parametrize(("method", "after"), [("write_bytes", 2), ("replace", 1), ("replace", 2)])
@pytest.mark.parametrize("error", [KeyboardInterrupt(), MemoryError()], ids=["ctrl-c", "memory"])
def test_an_interruption_leaves_the_old_package(
    package: Path,
    monkeypatch: pytest.MonkeyPatch,
    method: str,
    after: int,
    error: BaseException,
) -> None:
    with monkeypatch.context() as patch:
        failing(patch, method, error, after)
        with pytest.raises(type(error)):
            publish(NEW, package)
    assert contents(package.parent) == {f"package/{n}": b for n, b in as_bytes(OLD).items()}


KILLED = """
import os, signal, sys
from pathlib import Path
from derive.codegen import publish
from tests.codegen.test_publish import NEW
real = publish.put_in_place
def killed(fresh, folder, old):
    Path.replace = lambda *_: os.kill(os.getpid(), signal.SIGKILL)  # the first step of two
    if sys.argv[2] == "after":
        real(fresh, folder, old)
    os.kill(os.getpid(), signal.SIGKILL)
publish.put_in_place = killed
publish.publish(NEW, Path(sys.argv[1]))
"""


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere it takes two steps")
@pytest.mark.parametrize(("moment", "left"), [("before", OLD), ("after", NEW)])
def test_a_package_is_in_place_at_every_moment(
    package: Path, moment: str, left: dict[str, str]
) -> None:
    """A kill leaves the old one or the new one, and a next run goes on from there."""
    ended = subprocess.run(
        [sys.executable, "-c", KILLED, str(package), moment], cwd=Path(__file__).parents[2]
    )
    assert ended.returncode == -signal.SIGKILL
    assert contents(package) == as_bytes(left)
    publish(OLD, package)
    assert contents(package) == as_bytes(OLD)


@pytest.mark.usefixtures("in_two_steps")
def test_an_old_package_that_cannot_be_put_back_is_not_deleted(
    package: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The new package cannot be moved in, nor the old one back: it must be somewhere still."""
    with monkeypatch.context() as patch:
        failing(patch, "replace", FULL, after=2, times=2)
        with pytest.raises(BadOutput):
            publish(NEW, package)
    held = [path.read_bytes() for path in package.parent.rglob("cylinder.py")]
    assert as_bytes(OLD)["cylinder.py"] in held


def leftover(package: Path, name: str = ".package-597qa82p", age: float = 60) -> Path:
    """The hidden directory of a run that was killed while it wrote."""
    left = package.parent / name
    (left / "fresh" / "runtime").mkdir(parents=True)
    (left / "fresh" / "cylinder.py").write_bytes(as_bytes(OLD)["cylinder.py"])
    (left / "fresh" / "cut.py").touch()
    then = time.time() - age
    os.utime(left, (then, then))
    return left


@pytest.mark.skipif(sys.platform == "win32", reason="no locks of directories")
def test_what_a_killed_run_left_is_removed_by_the_next(package: Path) -> None:
    left = leftover(package)
    publish(NEW, package)
    assert contents(package) == as_bytes(NEW)
    assert not left.exists()


@pytest.mark.parametrize("name", [".other-597qa82p", ".package-1", "package-597qa82p", ".package"])
def test_what_has_another_name_stays(package: Path, name: str) -> None:
    left = leftover(package, name)
    publish(NEW, package)
    assert left.exists()


def test_what_is_young_or_holds_another_file_stays(package: Path) -> None:
    young, mine = leftover(package, age=0), leftover(package, ".package-abcdefgh")
    (mine / "fresh" / "notes.txt").write_text("mine")
    publish(NEW, package)
    assert young.exists()
    assert (mine / "fresh" / "notes.txt").read_text() == "mine"


@pytest.mark.skipif(sys.platform == "win32", reason="no locks of directories")
def test_what_another_run_uses_stays(package: Path) -> None:
    left = leftover(package)
    with publisher._in_use(left) as locked:
        assert locked
        publish(NEW, package)
    assert left.exists()


def test_a_module_that_was_edited_is_called_so(package: Path) -> None:
    files = package_files({"cylinder": f"{MARK}\n"})
    publish(files, package)
    (package / "cylinder.py").write_text("mine = 1\n")
    with pytest.raises(
        BadOutput, match=r"'cylinder\.py', which was changed after it was generated"
    ):
        publish(files, package)


# ------------------------------------------------------------------ differences


def test_every_file_that_differs_is_named(package: Path) -> None:
    (package / "__pycache__").mkdir()
    assert differences(OLD, package) == []
    (package / "notes.txt").write_text("mine")
    (package / "py.typed").unlink()
    found = {d.name: d.what for d in differences(NEW, package)}
    assert found == {
        "__init__.py": "changed",
        "cylinder.py": "changed",
        "notes.txt": "not generated",
        "punch.py": "missing",
        "py.typed": "missing",
        "wedge.py": "not generated",
    }


def test_in_an_absent_directory_everything_is_missing(tmp_path: Path) -> None:
    found = differences(NEW, tmp_path / "nowhere")
    assert [d.name for d in found] == sorted(NEW)
    assert {d.what for d in found} == {"missing"}


@pytest.mark.parametrize("place", [0, -1])
def test_one_byte_is_a_difference(package: Path, place: int) -> None:
    path = package / "runtime" / "arrays.py"
    text = bytearray(path.read_bytes())
    text[place] ^= 1
    path.write_bytes(text)
    (found,) = differences(OLD, package)
    assert (found.name, found.what) == ("runtime/arrays.py", "changed")


def test_a_change_is_shown_line_by_line(package: Path) -> None:
    (found,) = [d for d in differences(NEW, package) if d.name == "cylinder.py"]
    assert {"-old = 1", "+new = 2"} <= set(found.diff.splitlines())


def test_what_is_no_text_is_a_difference_all_the_same(package: Path) -> None:
    (package / "cylinder.py").write_bytes(b"\xff\xfe\x00")
    assert [d.name for d in differences(OLD, package)] == ["cylinder.py"]


def test_a_folder_in_the_place_of_a_file_is_a_difference(package: Path) -> None:
    (package / "cylinder.py").unlink()
    (package / "cylinder.py").mkdir()
    assert [d.name for d in differences(OLD, package)] == ["cylinder.py"]
