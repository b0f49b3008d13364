"""Data flows one way, and the imports say so; nothing of a machine or a registry is in the files.

The order of the theory's modules is read from the docstring of derive/theory/__init__.py.
"""

import ast
import re
import subprocess
from collections.abc import Iterable, Iterator, Mapping
from functools import cache
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

import derive.theory

ROOT = Path(__file__).parents[1]
DERIVE, GENERATED = ROOT / "derive", ROOT / "generated"
RUNTIME = DERIVE / "runtime"


# ------------------------------------------------------------------ who imports whom


@cache
def tree(path: Path) -> ast.Module:
    return ast.parse(path.read_text(encoding="utf-8"))


def module_name(path: Path) -> str:
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def sources(folder: Path) -> list[Path]:
    return sorted(folder.rglob("*.py"))


MODULES: Mapping[str, Path] = {
    module_name(path): path for folder in (DERIVE, GENERATED) for path in sources(folder)
}


def statements(body: Iterable[ast.stmt], at_load: bool) -> Iterator[ast.stmt]:
    """Import statements: all, or those that are executed when the module is loaded."""
    for node in body:
        if isinstance(node, ast.Import | ast.ImportFrom):
            yield node
        elif at_load and isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            continue
        elif at_load and isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test):
            yield from statements(node.orelse, at_load)
        else:
            yield from statements(ast.iter_child_nodes(node), at_load)  # type: ignore[arg-type]


def imported(name: str, at_load: bool = False) -> set[str]:
    """Dotted names that a module imports; of the project's own, the modules themselves."""
    path, found = MODULES[name], set()
    package = name if path.name == "__init__.py" else name.rpartition(".")[0]
    for node in statements(tree(path).body, at_load):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
            continue
        above = package.rsplit(".", node.level - 1)[0] if node.level else ""
        base = ".".join(filter(None, (above, node.module)))
        for alias in node.names:
            inner = f"{base}.{alias.name}"
            found.add(inner if inner in MODULES else base)
    return found


def inside(names: Iterable[str], *packages: str) -> set[str]:
    """Those of the names that lie in one of the packages."""
    return {n for n in names if any(n == p or n.startswith(f"{p}.") for p in packages)}


def members(package: str) -> list[str]:
    return sorted(inside(MODULES, package))


def test_the_modules_are_found() -> None:
    assert {"derive", "derive.theory.frame", "derive.cli", "generated.hertz"} <= MODULES.keys()
    assert "derive.theory.frame" in imported("derive.theory.moments")
    assert "derive.theory.stick" in imported("derive.derivation")
    assert "generated.runtime.arrays" in imported("generated.hertz")
    assert "derive.pipeline" in imported("derive.cli") - imported("derive.cli", at_load=True)


def order() -> list[str]:
    """The theory's modules as its docstring lists them."""
    listed = re.findall(r"^(\w+) {2,}\S", str(derive.theory.__doc__), re.MULTILINE)
    return [f"derive.theory.{name}" for name in listed]


def test_the_theory_s_order_lists_every_module() -> None:
    assert sorted(order()) == [name for name in members("derive.theory") if name.count(".") == 2]


@pytest.mark.parametrize("name", [n for n in members("derive.theory") if n != "derive.theory"])
def test_a_module_of_the_theory_imports_only_those_above_it(name: str) -> None:
    above = order()[: order().index(name)] if name in order() else order()
    assert inside(imported(name), "derive.theory") <= set(above)


# What the packages and modules on the left never import, at any level.
NEVER = {
    "derive.theory": (
        *("derive.proof", "derive.sheet", "derive.derivation", "derive.codegen"),
        *("derive.pipeline", "derive.view", "derive.cli", "derive.library", "derive.writing"),
    ),
    "derive.proof": (
        *("derive.codegen", "derive.pipeline", "derive.view", "derive.cli", "derive.writing"),
    ),
    "derive.sheet": ("derive.codegen", "derive.pipeline", "derive.view", "derive.cli"),
    "derive.derivation": ("derive.codegen", "derive.pipeline", "derive.view", "derive.cli"),
    "derive.geometry": ("derive.theory", "derive.proof", "derive.sheet", "derive.codegen"),
    "derive.profile": ("derive.theory", "derive.proof", "derive.sheet", "derive.codegen"),
    "derive.codegen": ("derive.pipeline", "derive.view", "derive.cli", "derive.paper"),
    "derive.pipeline": ("derive.view", "derive.cli", "click", "rich"),
    "derive.plot": (
        *("derive.theory", "derive.proof", "derive.sheet", "derive.derivation", "derive.geometry"),
        *("derive.codegen", "derive.pipeline", "derive.view", "derive.cli", "derive.paper"),
        *("derive.library", "derive.writing", "sympy", "mpmath", "click", "rich"),
    ),
    "derive.symbols": ("derive",),
    "derive.errors": ("derive", "sympy", "click", "rich"),
    "derive.runtime": ("derive", "sympy", "mpmath"),
    "derive": ("generated", "tests"),
    "generated": ("derive", "sympy", "mpmath", "tests"),
}


@pytest.mark.parametrize("package", NEVER)
def test_data_flows_one_way(package: str) -> None:
    for name in members(package):
        allowed = {package} if package not in NEVER[package] else set()
        if package == "derive.runtime":
            allowed = set(members(package))  # its modules are copied together
        wrong = inside(imported(name), *NEVER[package]) - allowed - {name}
        assert not wrong, f"{name} imports {wrong}"


def test_only_the_commands_read_the_paper() -> None:
    users = {name for name in members("derive") if inside(imported(name), "derive.paper")}
    assert {u for u in users if not inside([u], "derive.paper")} == {"derive.cli", "derive.view"}
    for name in members("derive.paper"):
        assert not inside(imported(name), "derive.cli", "derive.view", "derive.codegen")


def test_only_the_commands_read_the_handbook() -> None:
    users = {name for name in members("derive") if inside(imported(name), "derive.handbook")}
    assert {u for u in users if not inside([u], "derive.handbook")} == {"derive.cli"}
    for name in members("derive.handbook"):
        assert not inside(imported(name), "derive.cli", "derive.view", "derive.paper")


def test_only_the_command_line_prints() -> None:
    users = {name for name in members("derive") if inside(imported(name), "click", "rich")}
    assert users <= {"derive.cli", "derive.view"}


def test_only_the_plots_draw_and_nothing_needs_them() -> None:
    users = {name for name in MODULES if inside(imported(name), "matplotlib", "ipywidgets")}
    assert users and all(inside([name], "derive.plot") for name in users)
    above = {name for name in MODULES if inside(imported(name), "derive.plot")}
    assert all(inside([name], "derive.plot") for name in above)


def test_a_geometry_file_imports_derive_and_sympy_alone() -> None:
    for name in members("derive.geometries"):
        assert imported(name) <= {"derive", "sympy"}


def test_no_imports_run_in_a_circle() -> None:
    graph = {name: imported(name, at_load=True) & MODULES.keys() - {name} for name in MODULES}
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        pytest.fail(" -> ".join(error.args[1]))


def test_the_search_for_circles_finds_one() -> None:
    with pytest.raises(CycleError):
        TopologicalSorter({"a": {"b"}, "b": {"c"}, "c": {"a"}}).prepare()


# ------------------------------------------------------------------ no text is executed

EXECUTES = {"eval", "exec", "compile", "__import__"}
READS_TEXT = {"S", "Expr"}


def calls(path: Path) -> Iterator[ast.Call]:
    return (node for node in ast.walk(tree(path)) if isinstance(node, ast.Call))


def last_name(call: ast.Call) -> str:
    """f of f(x), of a.f(x) and of a.b.f(x)."""
    return ast.unparse(call.func).rpartition(".")[2]


def is_text(node: ast.expr) -> bool:
    return isinstance(node, ast.JoinedStr) or (
        isinstance(node, ast.Constant) and isinstance(node.value, str)
    )


def is_strict(call: ast.Call) -> bool:
    """sympify(..., strict=True) refuses text."""
    return any(k.arg == "strict" and ast.unparse(k.value) == "True" for k in call.keywords)


def executes_text(call: ast.Call) -> bool:
    function, name = ast.unparse(call.func).removeprefix("builtins."), last_name(call)
    return (
        function in EXECUTES
        or name == "parse_expr"
        or (name == "sympify" and not is_strict(call))
        or (name in READS_TEXT and any(map(is_text, call.args)))
    )


def executed_text(path: Path) -> list[str]:
    return [ast.unparse(call) for call in calls(path) if executes_text(call)]


@pytest.mark.parametrize("path", sources(DERIVE), ids=module_name)
def test_no_text_is_executed(path: Path) -> None:
    assert executed_text(path) == []


def test_only_the_library_executes_files() -> None:
    loaders = {"exec_module", "run_path", "run_module", "load_module", "spec_from_file_location"}
    users = {
        module_name(path)
        for path in sources(DERIVE)
        if loaders & {last_name(call) for call in calls(path)}
    }
    assert users == {"derive.library"}


def test_the_search_for_executed_text_finds_it(tmp_path: Path) -> None:
    lines = ["eval(t)", "exec(t)", "builtins.eval(t)", "__import__(t)", "S('x')", "S(f'{t}')"]
    lines += ["sympify(t)", "sympy.sympify(t, strict=False)", "parse_expr(t)"]
    harmless = ["sympify(t, strict=True)", "S(1)", "re.compile(t)", "poly.eval(1)"]
    path = tmp_path / "bad.py"
    path.write_text("\n".join(lines + harmless))
    assert executed_text(path) == lines


# ------------------------------------------------------------------ generated and its source


def test_the_runtime_is_copied_byte_by_byte_below_a_header() -> None:
    for path in sources(RUNTIME):
        copy = GENERATED / "runtime" / path.relative_to(RUNTIME)
        header, _, rest = copy.read_bytes().partition(b"\n")
        assert header.startswith(b"# Generated")
        assert rest == path.read_bytes(), path.name


def test_every_generated_file_has_its_source() -> None:
    runtime = {f"runtime/{path.relative_to(RUNTIME).as_posix()}" for path in sources(RUNTIME)}
    bodies = {p.name for p in (DERIVE / "geometries").glob("*.py") if p.name != "__init__.py"}
    held = {p.relative_to(GENERATED).as_posix() for p in GENERATED.rglob("*") if p.is_file()}
    kept = {name for name in held if "__pycache__" not in name}
    assert kept == runtime | bodies | {"__init__.py", "edge.py", "full_stick.py", "py.typed"}


def test_the_runtime_alone_knows_numba_and_formulas_do_not_load_it() -> None:
    users = {name for name in MODULES if inside(imported(name), "numba")}
    assert users == inside(users, "derive.runtime", "generated.runtime")
    loaded = {"generated.hertz"}
    while more := {m for n in loaded for m in imported(n, at_load=True) & MODULES.keys()} - loaded:
        loaded |= more
    assert "generated.runtime.body" in loaded and not loaded & users


# ------------------------------------------------------------------ nothing of a machine


@cache
def files() -> tuple[Path, ...]:
    """Every file of the repository, those not committed yet included."""
    listed = subprocess.run(
        ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
        cwd=ROOT,
        capture_output=True,
        check=True,
    )
    names = listed.stdout.decode().split("\0")
    return tuple(ROOT / name for name in names if name and (ROOT / name).is_file())


def texts() -> Iterator[tuple[Path, str]]:
    for path in files():
        try:
            yield path, path.read_text(encoding="utf-8")
        except UnicodeDecodeError:
            continue


# Put together here, so that this file does not hold what it looks for.
_HOMES = ("home", "work", "tmp", "root", "Users", "opt", "mnt", "private")
MACHINE = re.compile(
    "|".join([rf"(?<![\w.~*-])/{home}/[\w.]" for home in _HOMES] + [r"\b[A-Za-z]:\\\\?[A-Za-z]\w"])
)
REGISTRIES = re.compile(
    "|".join(
        re.escape(".".join(parts))
        for parts in (
            ("pypi", "org"),
            ("pythonhosted", "org"),
            ("anaconda", "org"),
            ("npmjs", "org"),
            ("npmjs", "com"),
            ("crates", "io"),
            ("ghcr", "io"),
            ("docker", "io"),
            ("proxy", "golang", "org"),
        )
    )
    + r"|--(extra-)?index-url|--trusted-host"
)


def mentions(pattern: re.Pattern[str]) -> list[str]:
    return [
        f"{path.relative_to(ROOT)}:{number}: {line.strip()}"
        for path, text in texts()
        if path != Path(__file__)
        for number, line in enumerate(text.splitlines(), start=1)
        if pattern.search(line)
    ]


def test_no_file_holds_a_path_of_a_machine() -> None:
    assert mentions(MACHINE) == []


def test_no_file_names_a_package_registry() -> None:
    assert mentions(REGISTRIES) == []


def test_the_files_are_found() -> None:
    names = {str(path.relative_to(ROOT)) for path in files()}
    assert {"pyproject.toml", "Makefile", "derive/cli.py", "generated/wedge.py"} <= names


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("/" + "home/someone/file", True),
        ("in '/" + "tmp/x'", True),
        ("C:" + "\\Users", True),
        ("derive/home/file.py", False),
        ("N/m, Pa/sqrt(m)", False),
        ("https://example.invalid/work/of", False),
        ("e.g.: \\alpha", False),
    ],
)
def test_a_path_of_a_machine_is_recognised(text: str, found: bool) -> None:
    assert bool(MACHINE.search(text)) is found
