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


@cache
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


def order() -> list[str]:
    """The theory's modules as its docstring lists them."""
    listed = re.findall(r"^(\w+) {2,}\S", str(derive.theory.__doc__), re.MULTILINE)
    return [f"derive.theory.{name}" for name in listed]


def test_the_theory_s_order_lists_every_module() -> None:
    assert sorted(order()) == [name for name in members("derive.theory") if name.count(".") == 2]


PACKAGES = sorted(n for n in members("derive") if MODULES[n].name == "__init__.py" and "." in n)
FREE = {"derive.geometries"}


@pytest.mark.parametrize("package", [p for p in PACKAGES if p not in FREE])
def test_a_package_lists_its_modules(package: str) -> None:
    text = ast.get_docstring(tree(MODULES[package])) or ""
    listed = re.findall(r"^ *(\w+) +\S", text, re.MULTILINE)
    here = {n.rpartition(".")[2] for n in members(package) if n.count(".") == 2}
    assert here - set(listed) == set()


@pytest.mark.parametrize("name", [n for n in members("derive.theory") if n != "derive.theory"])
def test_a_module_of_the_theory_imports_only_those_above_it(name: str) -> None:
    above = order()[: order().index(name)] if name in order() else order()
    assert inside(imported(name), "derive.theory") <= set(above)


# What only users see; nothing but the commands themselves imports it.
FRONT = tuple(
    f"derive.command.{name}"
    for name in ("checking", "cli", "group", "options", "showing", "terminal", "view")
)

# What the packages and modules on the left never import, at any level.
NEVER = {
    "derive.symbols": ("derive",),
    "derive.command.errors": ("derive", "sympy", "click", "rich"),
    "derive.geometries": ("derive.theory", "derive.proof", "derive.codegen", "numpy"),
    "derive.body": (
        *("derive.theory", "derive.proof", "derive.sheet", "derive.codegen", "derive.check"),
        *("derive.pipeline", *FRONT),
    ),
    "derive.reading": (
        *("derive.theory", "derive.proof", "derive.sheet.formulas", "derive.sheet.derivation"),
        *("derive.codegen", "derive.check", "derive.pipeline", *FRONT),
    ),
    "derive.theory": (
        *("derive.proof", "derive.sheet", "derive.codegen", "derive.pipeline"),
        *("derive.body.library", "derive.reading", *FRONT),
    ),
    "derive.sheet": ("derive.codegen", "derive.pipeline", "derive.check", *FRONT),
    "derive.proof": ("derive.codegen", "derive.pipeline", "derive.check", *FRONT),
    "derive.codegen": ("derive.pipeline", "derive.check", *FRONT),
    "derive.check": ("derive.codegen", *FRONT),
    "derive.handbook": FRONT,
    "derive.pipeline": (*FRONT, "click", "rich"),
    "derive.plot": (
        *("derive.body", "derive.reading", "derive.theory", "derive.sheet", "derive.proof"),
        *("derive.codegen", "derive.check", "derive.pipeline", *FRONT),
        *("sympy", "mpmath", "click", "rich"),
    ),
    "derive": ("tests",),
    "generated": ("derive", "sympy", "mpmath", "tests"),
}


@pytest.mark.parametrize("package", NEVER)
def test_data_flows_one_way(package: str) -> None:
    for name in members(package):
        allowed = {package} if package not in NEVER[package] else set()
        wrong = inside(imported(name), *NEVER[package]) - allowed - {name}
        assert not wrong, f"{name} imports {wrong}"


# Who alone may import what stands on the left.
USERS = {
    "derive.check": {"derive.check", *(f"derive.command.{n}" for n in ("checking", "cli", "view"))},
    "derive.handbook": {
        *("derive.handbook", "derive.check.documents"),
        *("derive.command.cli", "derive.command.showing"),
    },
    "derive.plot": {"derive.plot"},
    "click": {*FRONT},
    "rich": {*FRONT},
    "matplotlib": {"derive.plot", "derive.sheet.picture"},
    "ipywidgets": {"derive.plot"},
    "numba": {"generated.runtime"},
    "generated": {"derive.edge", "generated"},
}


@pytest.mark.parametrize("package", USERS)
def test_few_modules_need_it(package: str) -> None:
    users = {name for name in MODULES if inside(imported(name), package)}
    assert users and users == inside(users, *USERS[package])


def test_no_imports_run_in_a_circle() -> None:
    graph = {name: imported(name, at_load=True) & MODULES.keys() - {name} for name in MODULES}
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        pytest.fail(" -> ".join(error.args[1]))


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


def test_no_text_is_executed() -> None:
    assert {path: found for path in sources(DERIVE) if (found := executed_text(path))} == {}


# ------------------------------------------------------------------ generated and its source


def test_derive_takes_only_the_runtime_of_generated() -> None:
    taken = {m for name in members("derive") for m in inside(imported(name), "generated")}
    assert taken and taken == inside(taken, "generated.runtime")


# ------------------------------------------------------------------ nothing of a machine


MACHINE = re.compile(
    r"(?<![\w.~*-])/(home|work|tmp|root|Users|opt|mnt|private)/[\w.]|\b[A-Za-z]:\\\\?[A-Za-z]\w"
)
REGISTRIES = re.compile(
    r"pypi\.org|pythonhosted\.org|anaconda\.org|npmjs\.(org|com)|crates\.io|(ghcr|docker)\.io"
    r"|proxy\.golang\.org|--(extra-)?index-url|--trusted-host"
)


def lines_of_all_files() -> Iterator[tuple[str, str]]:
    """Of every file but this one, those not committed yet included."""
    listed = subprocess.run(
        ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
        cwd=ROOT,
        capture_output=True,
        check=True,
    )
    for name in filter(None, listed.stdout.decode().split("\0")):
        path = ROOT / name
        if path.is_file() and path != Path(__file__):
            for line in path.read_text(encoding="utf-8", errors="replace").splitlines():
                yield name, line


def test_no_file_holds_a_path_of_a_machine_or_names_a_package_registry() -> None:
    seen = [*lines_of_all_files()]
    assert {"pyproject.toml", "derive/pipeline.py", "generated/wedge.py"} <= {
        name for name, _ in seen
    }
    assert [(n, t) for n, t in seen if MACHINE.search(t) or REGISTRIES.search(t)] == []
