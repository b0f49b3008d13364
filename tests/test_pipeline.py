"""Many bodies at once: the same as one by one, and nothing twice that did not change."""

import subprocess
import sys
from pathlib import Path

import pytest

import derive.command.cache
import derive.pipeline
from derive.body.library import FOLDER, library
from derive.command.cache import users_cache
from derive.command.errors import NotProven
from derive.command.processes import Report
from derive.pipeline import STAGES, build_all
from derive.proof.verdict import Verdict
from derive.sheet.built import BuiltBody

ROOT = Path(__file__).parents[1]

VERDICTS = (("tilt", Verdict.PROVEN),)
PROOFS = (("tilt", "proven: a stand-in for a proof"),)


@pytest.fixture
def asked(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The sources that a `build` without any work was asked for."""
    sources = []

    def build(source: str, report: Report, limit: float) -> BuiltBody:
        sources.append(source)
        for stage in STAGES:
            report(source, stage)
        path = FOLDER / f"{source}.py" if source in library() else Path(source)
        return BuiltBody(
            Path(source).stem, path.read_text(), "", 0.5, ("forward",), (), VERDICTS, PROOFS
        )

    monkeypatch.setattr(derive.pipeline, "build", build)
    monkeypatch.setattr(
        derive.pipeline, "USER_FILE_LIMITS", None
    )  # another process would know of neither
    return sources


@pytest.fixture
def files(tmp_path: Path) -> list[str]:
    """Geometry files of one's own."""
    paths = [tmp_path / name for name in ("b.py", "a.py", "c.py")]
    for path in paths:
        text = FOLDER.joinpath("hertz.py").read_text().replace('"hertz"', f'"{path.stem}"')
        path.write_text(f"{text}# {path.name}\n")
    return [str(path) for path in paths]


# ------------------------------------------------------------------ in earnest


WITHOUT_SYMPY = """
import sys
from derive.body import library
from derive.command import cache, processes
from derive.sheet import built
for name in library.library():
    assert cache.key_of(library.FOLDER / f"{name}.py", name, cache.program_as_loaded())
cache.users_cache().get("0" * 64)
late = {"sympy", "numpy", "scipy"} & set(sys.modules)
assert not late, late
"""


def test_to_find_what_is_kept_does_not_wait_for_sympy() -> None:
    subprocess.run([sys.executable, "-c", WITHOUT_SYMPY], check=True, cwd=ROOT)


# ------------------------------------------------------------------ kept


def test_only_what_changed_is_built_again(asked: list[str], files: list[str]) -> None:
    first = build_all(files)
    second = build_all(files)
    assert asked == files
    assert second == first
    assert [body.kept for body in (*first, *second)] == [False] * 3 + [True] * 3
    assert [body.seconds for body in second] == [0.5] * 3
    with Path(files[1]).open("a") as file:
        file.write("# more\n")
    found = build_all(files)
    assert asked == [*files, files[1]]
    assert [body.kept for body in found] == [True, False, True]
    assert found[1].text.endswith("# more\n")


def test_a_change_of_the_program_builds_everything_again(
    asked: list[str], files: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    build_all(files)
    for name in ("program_as_loaded", "program_digest"):
        monkeypatch.setattr(derive.pipeline, name, lambda: "another program")
    build_all(files)
    assert asked == files * 2


@pytest.mark.parametrize("program", [False, True])
def test_what_changes_while_it_is_built_is_not_kept(
    asked: list[str], files: list[str], monkeypatch: pytest.MonkeyPatch, program: bool
) -> None:
    """Its file or the program: nobody knows whether it follows from the old or from the new."""

    def report(source: str, stage: str) -> None:
        if stage == STAGES[2] and program:
            monkeypatch.setattr(derive.pipeline, "program_digest", lambda: "another program")
        elif stage == STAGES[2]:
            Path(source).write_text("# changed\n")

    build_all(files[:1], report)
    folder = users_cache().folder
    assert folder is not None
    assert not folder.exists()


def test_what_was_built_before_a_failure_is_kept(
    asked: list[str], files: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """So the next run, after the repair, does not begin anew."""
    build = derive.pipeline.build

    def failing(source: str, report: Report, limit: float) -> BuiltBody:
        if source == files[2]:
            raise NotProven(source)
        return build(source, report, limit)

    with monkeypatch.context() as patched, pytest.raises(NotProven):
        patched.setattr(derive.pipeline, "build", failing)
        build_all(files)
    assert [body.kept for body in build_all(files)] == [True, True, False]
