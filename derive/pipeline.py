"""From g(x) to NumPy: the stages in order, what comes in and what goes out.

    stage          in                         out
    ------------   ------------------------   -----------------------------------------------
    load_geometry  a name or a file           Geometry: g(x), its parameters, its slope
    derive_sheet   Geometry                   FormulaSheet: every formula, named and sourced
    with_closed_forms  FormulaSheet           the same with closed forms beside its integrals
    prove_sheet    FormulaSheet               the same with a proof for every formula
    module_text    proven FormulaSheet        the text of a NumPy module
    demand_right   sheet and text             nothing, or NotProven: the text run and compared
    package_files  texts of modules           the files of a package
    publish        files, a directory         the directory replaced whole, or
    differences    files, a directory         what would change

    build          a name or a file           Body: the first five stages, as plain data
    build_all      names and files            a Body of each, several built at once (parallel.py)
                                              or kept from an earlier run (cache.py)

What is not proven stops the build at module_text or demand_right: nothing is written.  `build`
imports its stages when it is called: what is kept does without them.
"""

import ast
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter

from derive.body import Body, by_form
from derive.cache import key_of, program_as_loaded, program_digest, users_cache
from derive.codegen.publish import (
    FULL_STICK,
    Difference,
    demand_replaceable,
    differences,
    modules_in,
    package_files,
    publish,
)
from derive.errors import BadProfile, InstalledPackage, NeedsOutput, TwoOfOneName
from derive.library import FOLDER, is_in_library, library, load_geometry
from derive.limit import DEFAULT
from derive.parallel import Bounds, Report, in_processes

GENERATED = Path(__file__).parent.parent / "generated"
"""The package that is committed."""

STAGES = (
    *("reading g(x)", "deriving", "looking for closed forms"),
    *("proving", "generating", "trying"),
)
STRANGERS = Bounds(seconds=600, gigabytes=4, stages={STAGES[0]: 60})
"""What a body that is not of the library may take; none of twenty tried took a tenth of it."""

DONE, KEPT = "done", "kept"
"""What a report is told of a body behind its last stage, or of one that enters none."""


def _silent(body: str, stage: str) -> None:
    """A report that tells nobody."""


def build(source: str, report: Report = _silent, limit: float = DEFAULT) -> Body:
    """One body, from its name or file to the text of its module.

    limit: seconds that the search for closed forms of integrals may take; the text does not depend
    on what it finds.

    Raises UserError for what is wrong with the source, NotProven for a proof that falls short.
    """
    from derive.codegen.module import full_stick_text, module_text
    from derive.codegen.printer import CannotPrint
    from derive.codegen.trial import demand_right
    from derive.derivation import NONE_IN_TIME, derive_sheet, with_closed_forms
    from derive.proof.prove import prove_sheet

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
        remedy = "write it with numbers and functions that NumPy has"
        raise BadProfile(geometry.name, f"cannot become code ({error})", remedy) from error
    closed, numerical = by_form(sheet.is_closed)
    verdicts = tuple((name, f.proof.verdict) for name, f in sheet.items() if f.proof)
    proofs = tuple((name, str(f.proof)) for name, f in sheet.items() if f.proof)
    struck = sheet.remark if sheet.remark.startswith(NONE_IN_TIME) else ""
    seconds = perf_counter() - began
    return Body(geometry.name, text, stuck, seconds, closed, numerical, verdicts, proofs, struck)


def build_all(
    sources: Sequence[str],
    report: Report = _silent,
    jobs: int = 1,
    fresh: bool = False,
    limit: float = DEFAULT,
) -> list[Body]:
    """A body of every source, in their order; `jobs` processes build what is not kept.

    fresh: build all, and read nothing of what is kept.
    limit: seconds that the search for the closed forms of one body may take.

    Raises what `build` raises for the first source that fails, and ends the others; LostProcess;
    TwoOfOneName before anything is built, where the files say so; RanAway for a file whose body
    goes beyond STRANGERS.
    """
    _demand_names_of_their_own(sources)
    keys = _keys(sources, limit)
    bodies = {} if fresh else _kept(keys)
    for source in bodies:
        report(source, KEPT)
    missing = [(source, key, limit) for source, key in keys.items() if source not in bodies]
    bounds = None if all(is_in_library(source) for source, *_ in missing) else STRANGERS
    made = in_processes(_build_and_keep, missing, report, jobs, bounds)
    bodies |= {source: body for (source, *_), body in zip(missing, made, strict=True)}
    return [bodies[source] for source in sources]


def _demand_names_of_their_own(sources: Iterable[str]) -> None:
    """Raise TwoOfOneName where names that are written out in the files are the same."""
    known: set[str] = set()
    for source in dict.fromkeys(sources):
        name = source if is_in_library(source) else _name_in(source)
        if name in known:
            raise TwoOfOneName(name)
        known |= {name} - {""}


def _name_in(file: str) -> str:
    """What a file names its one Geometry, without running it; empty where that cannot be seen."""
    with suppress(OSError, ValueError, SyntaxError, RecursionError, MemoryError):
        path = Path(file)
        tree = ast.parse(path.read_bytes() if path.is_file() else b"")
        calls = [node for node in ast.walk(tree) if isinstance(node, ast.Call)]
        named = [c.args[0] for c in calls if ast.unparse(c.func) == "Geometry" and c.args]
        if len(named) == 1 and isinstance(named[0], ast.Constant):
            return str(named[0].value)
    return ""


def _keys(sources: Iterable[str], limit: float) -> dict[str, str | None]:
    """Every source once, with the key of its body; None if that is not kept."""
    if users_cache().folder is None:
        return dict.fromkeys(sources)
    program = program_as_loaded()
    return {source: _key(source, program, limit) for source in sources}


def _key(source: str, program: str, limit: float) -> str | None:
    """The key of a body; another limit may find closed forms that this one does not."""
    origin = _origin(source) if limit == DEFAULT else f"{_origin(source)} within {limit:g} s"
    return key_of(_path(source), origin, program)


def _kept(keys: Mapping[str, str | None]) -> dict[str, Body]:
    """Bodies of an earlier run, by source."""
    found = {source: users_cache().get(key) for source, key in keys.items()}
    return {source: body for source, body in found.items() if body}


def _build_and_keep(asked: tuple[str, str | None, float], report: Report) -> Body:
    """One body; kept under its key, unless a file that it follows from has changed meanwhile."""
    source, key, limit = asked
    body = build(source, report, limit)
    if key is not None and key == _key(source, program_digest(), limit):
        users_cache().put(key, body)
    report(source, DONE)
    return body


def _path(source: str) -> Path:
    """The file that holds g(x)."""
    return FOLDER / f"{source}.py" if is_in_library(source) else Path(source)


def _origin(source: str) -> str:
    """Where g(x) came from, without anything that differs between machines."""
    return f"derive/geometries/{source}.py" if is_in_library(source) else Path(source).name


@dataclass(frozen=True)
class Order:
    """What is to be generated, and where to; a wrong order is refused before any work.

    sources: names and files; none for the whole library.
    folder: None for the package `generated`.

    Raises NeedsOutput for a file without a folder, InstalledPackage for no folder where `generated`
    is an installed one, BadOutput for a folder that must not be replaced.
    """

    sources: tuple[str, ...] = ()
    folder: Path | None = None

    def __post_init__(self) -> None:
        if self.folder is not None:
            demand_replaceable(self.folder)
            return
        for source in self.sources:
            if not is_in_library(source):
                load_geometry(source)  # a name that is unknown is told first
                raise NeedsOutput(source)
        if not (GENERATED.parent / "pyproject.toml").exists():  # no clone: an installation
            raise InstalledPackage(str(GENERATED))

    @property
    def target(self) -> Path:
        """The directory to write."""
        return self.folder or GENERATED

    @property
    def names(self) -> tuple[str, ...]:
        """Every source once, in the order given."""
        return tuple(dict.fromkeys(self.sources)) or library()

    def files(self, bodies: Iterable[Body]) -> dict[str, str]:
        """The package: the bodies made, and those of `generated` that were not asked for.

        Raises TwoOfOneName.
        """
        made: dict[str, str] = {}
        for body in bodies:
            if body.name in made:
                raise TwoOfOneName(body.name)
            made |= {body.name: body.text, FULL_STICK: body.stuck}
        kept = modules_in(GENERATED) if self.folder is None and self.sources else {}
        return package_files(kept | made)

    def write(self, bodies: Iterable[Body]) -> bool:
        """Write the package; False if nothing had to change."""
        files = self.files(bodies)
        if not differences(files, self.target):
            return False
        publish(files, self.target)
        return True

    def check(self, bodies: Iterable[Body]) -> list[Difference]:
        """What in the directory is not as it would be written."""
        return differences(self.files(bodies), self.target)
