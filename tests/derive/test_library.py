"""Geometry files: found, executed once, leaving nothing behind; what is wrong with a bad one."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from derive.errors import BadGeometryFile, BadProfile, UnknownGeometry
from derive.library import FOLDER, library, load_geometry

CYLINDER = '''"""A cylinder of one's own."""
from derive import Geometry, parameter, x

radius = parameter("radius", "radius", unit="m")
geometry = Geometry("cylinder", g=x**2 / (2 * radius))
'''


@pytest.fixture
def cylinder(tmp_path: Path) -> Path:
    path = tmp_path / "cylinder.py"
    path.write_text(CYLINDER)
    return path


def written(path: Path, text: str) -> Path:
    path.write_text(text)
    return path


def test_the_library_is_the_folder() -> None:
    assert {"hertz", "wedge"} <= set(library())
    assert list(library()) == sorted(library())
    assert not any(name.startswith("_") for name in library())


@pytest.mark.parametrize("name", library())
def test_a_body_of_the_library_bears_its_file_s_name_and_words(name: str) -> None:
    body = load_geometry(name)
    assert body.name == name
    assert body.description
    assert all(q.meaning for q in body.parameters)


def test_a_file_is_loaded_by_text_and_by_path(cylinder: Path) -> None:
    for given in (cylinder, str(cylinder)):
        body = load_geometry(given)
        assert (body.name, str(body.g)) == ("cylinder", "x**2/(2*radius)")
        assert body.description == "A cylinder of one's own."


def test_a_file_in_the_current_folder_is_loaded_by_its_name(
    cylinder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(cylinder.parent)
    assert load_geometry("cylinder.py").name == "cylinder"


def test_a_name_of_the_library_is_not_looked_for_on_disk(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "hertz").mkdir()
    monkeypatch.chdir(tmp_path)
    assert load_geometry("hertz").name == "hertz"


def test_a_file_is_executed_once_and_leaves_nothing_behind(tmp_path: Path) -> None:
    diary = tmp_path / "diary.txt"
    path = written(
        tmp_path / "body.py",
        CYLINDER + f"with open({str(diary)!r}, 'a') as file:\n    file.write('x')\n",
    )
    before, writes = set(sys.modules), sys.dont_write_bytecode
    load_geometry(path)
    assert diary.read_text() == "x"
    assert {p.name for p in tmp_path.iterdir()} == {"body.py", "diary.txt"}
    assert set(sys.modules) == before
    assert sys.dont_write_bytecode == writes


def test_loading_leaves_no_bytecode_in_a_fresh_interpreter(cylinder: Path) -> None:
    code = f"from derive.library import load_geometry; load_geometry({str(cylinder)!r})"
    subprocess.run([sys.executable, "-c", code], check=True, cwd=Path(__file__).parents[2])
    assert [p.name for p in cylinder.parent.iterdir()] == ["cylinder.py"]


@pytest.mark.slow
def test_the_library_s_own_files_leave_no_bytecode() -> None:
    for name in library():
        load_geometry(name)
    held = {path.name.split(".")[0] for path in FOLDER.glob("__pycache__/*")}
    assert held.isdisjoint(library())


def test_an_edited_file_is_read_again(cylinder: Path) -> None:
    load_geometry(cylinder)
    written(cylinder, CYLINDER.replace("(2 * radius)", "radius"))
    assert str(load_geometry(cylinder).g) == "x**2/radius"


def test_two_files_may_use_one_name_for_two_things(cylinder: Path, tmp_path: Path) -> None:
    load_geometry(cylinder)
    other = written(tmp_path / "other.py", CYLINDER.replace('"radius", unit', '"gauge", unit'))
    assert load_geometry(other).parameters[0].meaning == "gauge"


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    path = tmp_path / "nowhere.py"
    with pytest.raises(BadGeometryFile) as caught:
        load_geometry(path)
    assert caught.value == BadGeometryFile(str(path), "there is no such file")
    assert "geometry = Geometry(name, g=...)" in caught.value.message


def test_an_unknown_name_is_answered_with_those_there_are() -> None:
    with pytest.raises(UnknownGeometry) as caught:
        load_geometry("sphere")
    assert caught.value == UnknownGeometry("sphere", library())
    assert "hertz" in caught.value.message
    assert "path of a geometry file" in caught.value.message


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("geometry = (", "SyntaxError"),
        ("  geometry = 1", "IndentationError"),
        ("from derive import sphere", "ImportError"),
        ("import no_such_module_anywhere", "ModuleNotFoundError"),
        ("geometry = Geometry('body', g=x**2)", "NameError"),
        ("from derive import Geometry\ngeometry = Geometry('body')", "TypeError"),
        ("geometry = 1 / 0", "ZeroDivisionError"),
        ("from derive import x\ngeometry = x.square", "AttributeError"),
        ("raise ValueError('no')", "ValueError"),
        ("open('no such file anywhere')", "FileNotFoundError"),
        ("import this_file_is_fine\0", ""),
        ("", "defines no `geometry`"),
        ("geometry = None", "defines no `geometry`"),
        ("from derive import x\ngeometry = x**2", "defines no `geometry`"),
        ("from derive import Geometry\ngeometry = Geometry", "defines no `geometry`"),
    ],
)
def test_a_bad_file_is_refused_with_the_reason(tmp_path: Path, text: str, why: str) -> None:
    path = written(tmp_path / "bad.py", text)
    with pytest.raises(BadGeometryFile) as caught:
        load_geometry(path)
    assert str(path) in caught.value.message
    assert why in caught.value.message
    assert [p.name for p in tmp_path.iterdir()] == ["bad.py"]


def test_a_file_of_bytes_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "bytes.py"
    path.write_bytes(b"\xff\xfe\x00geometry")
    with pytest.raises(BadGeometryFile):
        load_geometry(path)


@pytest.mark.parametrize("name", ["body.txt", "body"])
def test_a_file_that_is_no_python_is_refused(tmp_path: Path, name: str) -> None:
    with pytest.raises(BadGeometryFile) as caught:
        load_geometry(written(tmp_path / name, CYLINDER))
    assert "no Python file" in caught.value.message


def test_a_folder_is_no_geometry_file(tmp_path: Path) -> None:
    with pytest.raises(BadGeometryFile):
        load_geometry(tmp_path)


def test_what_is_wrong_with_the_profile_comes_through(tmp_path: Path) -> None:
    path = written(tmp_path / "concave.py", CYLINDER.replace("g=x**2", "g=-x**2"))
    with pytest.raises(BadProfile) as caught:
        load_geometry(path)
    assert caught.value.geometry == "cylinder"


def test_the_bytecode_switch_is_restored_after_a_failure(tmp_path: Path) -> None:
    writes = sys.dont_write_bytecode
    with pytest.raises(BadGeometryFile):
        load_geometry(written(tmp_path / "bad.py", "geometry = ("))
    assert sys.dont_write_bytecode == writes


PRESSES = """import os, signal
os.kill(os.getpid(), signal.SIGINT)
while True:
    pass
"""


@pytest.mark.skipif(os.name == "nt", reason="no signal can be sent to a process of one's own")
def test_ctrl_c_while_a_file_is_loaded_is_no_mistake_in_the_file(
    tmp_path: Path,
) -> None:
    (tmp_path / "presses.py").write_text(PRESSES)
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        with pytest.raises(KeyboardInterrupt):
            load_geometry(tmp_path / "presses.py")
        assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    finally:
        signal.signal(signal.SIGINT, before)
