"""From g(x) to NumPy: the stages in order, with their input and output.

    stage          in                         out
    ------------   ------------------------   -----------------------------------------------
    load_geometry  a name or a file           Geometry: g(x), its parameters, its slope
    derive_sheet   Geometry                   FormulaSheet: every formula, named and sourced
    with_closed_forms  FormulaSheet           the same with closed forms beside its integrals
    prove_sheet    FormulaSheet               the same with a proof for every formula
    module_text    proven FormulaSheet        the text of a NumPy module
    demand_right   sheet and text             nothing, or NotProven: runs the text and compares
    package_files  texts of modules           the files of a package
    publish        files, a directory         the directory, replaced as a whole
    differences    files, a directory         the changes that would be made

    build          a name or a file           BuiltBody: the first five stages, as plain data
    build_all      names and files            a BuiltBody for each: several built at once, or read
                                              from the cache

A missing proof stops the build at module_text or demand_right, and nothing is written.  `build`
imports its stages only when it is called, because cached bodies do not need them.
"""

import ast
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter

from derive.body.library import FOLDER, is_in_library, library, load_geometry
from derive.codegen.publish import (
    FULL_STICK,
    RUNTIME,
    Difference,
    differences,
    modules_in,
    package_files,
    publish,
)
from derive.command.cache import key_of, program_as_loaded, program_digest, users_cache
from derive.command.errors import BadOutput, BadProfile, InstalledPackage, NeedsOutput, TwoOfOneName
from derive.command.folder import demand_replaceable
from derive.command.limit import DEFAULT
from derive.command.processes import Bounds, Report, in_processes
from derive.sheet.built import BuiltBody, by_form

GENERATED = Path(__file__).parent.parent / "generated"
"""The package under version control."""

STAGES = (
    *("reading g(x)", "deriving", "looking for closed forms"),
    *("proving", "generating", "testing"),
)
USER_FILE_LIMITS = Bounds(seconds=600, gigabytes=4, stages={STAGES[0]: 60})
"""Limits for a body outside the library; none of twenty such bodies needed a tenth of them."""

DONE, KEPT = "done", "kept"
"""Stages reported for a body that is finished, and for one that is read from the cache."""


def _silent(body: str, stage: str) -> None:
    """Ignore a report."""


def build(source: str, report: Report = _silent, limit: float = DEFAULT) -> BuiltBody:
    """Build one body, from its name or file to the text of its module.

    limit: time in seconds for the search for closed forms of integrals; the text of the module does
    not depend on its outcome.

    Raises UserError for a fault in the source, and NotProven if a proof is missing or insufficient.
    """
    from derive.codegen.module import full_stick_text, module_text
    from derive.codegen.printer import CannotPrint
    from derive.codegen.trial import demand_right
    from derive.proof.prove import prove_sheet
    from derive.sheet.derivation import NONE_IN_TIME, derive_sheet, with_closed_forms

    began = perf_counter()
    report(source, STAGES[0])
    geometry = load_geometry(source)
    report(source, STAGES[1])
    sheet = derive_sheet(geometry)
    report(source, STAGES[2])
    sheet = with_closed_forms(sheet, limit)
    report(source, STAGES[3])
    sheet = prove_sheet(sheet)
    report(source, STAGES[4])
    try:
        text, stuck = module_text(sheet, _origin(source)), full_stick_text(sheet)
        report(source, STAGES[5])
        demand_right(sheet, text, stuck)
    except CannotPrint as error:
        remedy = "use only numbers and functions that NumPy supports"
        why = f"cannot be translated into NumPy code ({error})"
        raise BadProfile(geometry.name, why, remedy) from error
    closed, numerical = by_form(sheet.is_closed)
    verdicts = tuple((name, f.proof.verdict) for name, f in sheet.items() if f.proof)
    proofs = tuple((name, str(f.proof)) for name, f in sheet.items() if f.proof)
    time_limit_note = sheet.remark if sheet.remark.startswith(NONE_IN_TIME) else ""
    seconds = perf_counter() - began
    return BuiltBody(
        geometry.name, text, stuck, seconds, closed, numerical, verdicts, proofs, time_limit_note
    )


def build_all(
    sources: Sequence[str],
    report: Report = _silent,
    jobs: int = 1,
    fresh: bool = False,
    limit: float = DEFAULT,
) -> list[BuiltBody]:
    """The bodies of all sources, in order; `jobs` processes build those that are not in the cache.

    fresh: build all bodies and do not read the cache.
    limit: time in seconds for the search for the closed forms of one body.

    Raises what `build` raises for the first source that fails, and stops work on the others.
    Raises LostProcess if a process ends early, TwoOfOneName before anything is built if the files
    state the same name, and RanAway for a file whose body exceeds the limits USER_FILE_LIMITS.
    """
    _demand_names_of_their_own(sources)
    keys = _keys(sources, limit)
    bodies = {} if fresh else _kept(keys)
    for source in bodies:
        report(source, KEPT)
    missing = [(source, key, limit) for source, key in keys.items() if source not in bodies]
    bounds = None if all(is_in_library(source) for source, *_ in missing) else USER_FILE_LIMITS
    made = in_processes(_build_and_keep, missing, report, jobs, bounds)
    bodies |= {source: body for (source, *_), body in zip(missing, made, strict=True)}
    return [bodies[source] for source in sources]


def _demand_names_of_their_own(sources: Iterable[str]) -> None:
    """Raise TwoOfOneName if two files literally state the same name."""
    known: set[str] = set()
    for source in dict.fromkeys(sources):
        name = stated_name(source)
        if name in known:
            raise TwoOfOneName(name)
        known |= {name} - {""}


def stated_name(source: str) -> str:
    """The name of a body, which is read from its file without running it; "" if unclear."""
    if is_in_library(source):
        return source
    with suppress(OSError, ValueError, SyntaxError, RecursionError, MemoryError):
        path = Path(source)
        tree = ast.parse(path.read_bytes() if path.is_file() else b"")
        calls = [node for node in ast.walk(tree) if isinstance(node, ast.Call)]
        named = [c.args[0] for c in calls if ast.unparse(c.func) == "Geometry" and c.args]
        if len(named) == 1 and isinstance(named[0], ast.Constant):
            return str(named[0].value)
    return ""


def _keys(sources: Iterable[str], limit: float) -> dict[str, str | None]:
    """Every source once, with the key of its body, or None if the body is never kept."""
    if users_cache().folder is None:
        return dict.fromkeys(sources)
    program = program_as_loaded()
    return {source: _key(source, program, limit) for source in sources}


def _key(source: str, program: str, limit: float) -> str | None:
    """The key of a body; it includes an unusual limit, which may lead to other closed forms."""
    origin = _origin(source) if limit == DEFAULT else f"{_origin(source)} within {limit:g} s"
    return key_of(_path(source), origin, program)


def _kept(keys: Mapping[str, str | None]) -> dict[str, BuiltBody]:
    """Cached bodies, by source."""
    found = {source: users_cache().get(key) for source, key in keys.items()}
    return {source: body for source, body in found.items() if body}


def _build_and_keep(asked: tuple[str, str | None, float], report: Report) -> BuiltBody:
    """Build one body, and keep it under its key unless a file it depends on has changed."""
    source, key, limit = asked
    body = build(source, report, limit)
    if key is not None and key == _key(source, program_digest(), limit):
        users_cache().put(key, body)
    report(source, DONE)
    return body


def _is_file(source: str) -> bool:
    with suppress(OSError, ValueError):  # not a valid file name
        return Path(source).is_file()
    return False


def _path(source: str) -> Path:
    """The file that contains g(x)."""
    return FOLDER / f"{source}.py" if is_in_library(source) else Path(source)


def _origin(source: str) -> str:
    """The source of g(x), without anything that differs between machines."""
    return f"derive/geometries/{source}.py" if is_in_library(source) else Path(source).name


@dataclass(frozen=True)
class Order:
    """What to generate, and where; an invalid order is refused before any work is done.

    sources: names and files; empty for the whole library.
    folder: None for the package `generated`.
    writes: False if the directory is only compared.

    Raises NeedsOutput for a file without a folder, InstalledPackage if there is no folder and
    `generated` is an installed package, and BadOutput for a folder that cannot be replaced.
    """

    sources: tuple[str, ...] = ()
    folder: Path | None = None
    writes: bool = True

    def __post_init__(self) -> None:
        if self.folder is not None:
            if self.writes:
                demand_replaceable(self.folder, BadOutput)
            return
        for source in self.sources:
            if not is_in_library(source):
                if not _is_file(source):
                    load_geometry(source)  # reports what is wrong; a file is never run here
                raise NeedsOutput(source)
        installed = not (GENERATED.parent / "pyproject.toml").exists()
        if installed and self.writes:
            raise InstalledPackage(str(GENERATED))
        if self.writes:
            demand_replaceable(GENERATED, BadOutput, self.kept)

    @property
    def target(self) -> Path:
        """The directory to be written."""
        return self.folder or GENERATED

    @property
    def kept(self) -> str:
        """The folder of `generated` that is hand-written and left alone; "" in other packages."""
        return RUNTIME if self.folder is None else ""

    @property
    def names(self) -> tuple[str, ...]:
        """Every source once, in the order given."""
        return tuple(dict.fromkeys(self.sources)) or library()

    def files(self, bodies: Iterable[BuiltBody]) -> dict[str, str]:
        """The files of the package: the bodies given, and those of `generated` that stay.

        Raises TwoOfOneName.
        """
        made: dict[str, str] = {}
        for body in bodies:
            if body.name in made:
                raise TwoOfOneName(body.name)
            made |= {body.name: body.text, FULL_STICK: body.stuck}
        kept = modules_in(GENERATED) if self.folder is None and self.sources else {}
        return package_files(kept | made, with_runtime=not self.kept)

    def write(self, bodies: Iterable[BuiltBody]) -> list[Difference]:
        """Write the package; return how the directory differed from it before."""
        files = self.files(bodies)
        found = differences(files, self.target, self.kept)
        if found:
            publish(files, self.target, self.kept)
        return found

    def check(self, bodies: Iterable[BuiltBody]) -> list[Difference]:
        """The differences between the directory and what would be written."""
        return differences(self.files(bodies), self.target, self.kept)
