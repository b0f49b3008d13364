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
    replace_folder files, a directory         the directory, replaced as a whole
    differences    files, a directory         the changes that would be made

    proven_sheet   a name or a file           the proven sheet: the stages to prove_sheet
    sheet_and_body  a name or a file          the same and a BuiltBody: the stages to demand_right
    each_in_process  names and files          what is made for each; several at once

A missing proof stops the build at module_text or demand_right, and nothing is written.
The stages are imported only when they are called, because only they need SymPy.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, TypeVar

from derive.body.library import file_of, is_in_library, library, load_geometry
from derive.codegen.publish import (
    FULL_STICK,
    RUNTIME,
    Difference,
    differences,
    modules_in,
    package_files,
)
from derive.command.errors import BadProfile, NeedsOutput, TwoOfOneName
from derive.command.folder import demand_replaceable, replace_folder
from derive.command.limit import DEFAULT
from derive.command.processes import Bounds, Report, in_processes, silent
from derive.sheet.built import BuiltBody, by_form

if TYPE_CHECKING:
    from derive.sheet.formulas import FormulaSheet

Made = TypeVar("Made")

GENERATED = Path(__file__).parent.parent / "generated"
"""The package under version control."""

STAGES = (
    *("reading g(x)", "deriving", "looking for closed forms"),
    *("proving", "generating", "testing"),
)
USER_FILE_LIMITS = Bounds(seconds=600, gigabytes=4, stages={STAGES[0]: 60})
"""Limits for a body outside the library; none of twenty such bodies needed a tenth of them."""

DONE = ""
"""What is reported in place of a stage for a body that is finished."""


def proven_sheet(source: str, report: Report, limit: float) -> "FormulaSheet":
    """The sheet of a body with a proof for every formula, from its name or file.

    limit: time in seconds for the search for closed forms of integrals

    Raises UserError for a fault in the source.
    """
    from derive.proof.prove import prove_sheet
    from derive.sheet.derivation import derive_sheet, with_closed_forms

    report(source, STAGES[0])
    geometry = load_geometry(source)
    report(source, STAGES[1])
    sheet = derive_sheet(geometry)
    report(source, STAGES[2])
    sheet = with_closed_forms(sheet, limit)
    report(source, STAGES[3])
    return prove_sheet(sheet)


def time_limit_note(sheet: "FormulaSheet") -> str:
    """A message if the search for closed forms reached its time limit, otherwise empty."""
    from derive.sheet.derivation import NONE_IN_TIME

    late = sheet.remark.startswith(NONE_IN_TIME)
    return f"{sheet.geometry.name}: {sheet.remark}" if late else ""


def sheet_and_body(
    source: str, report: Report = silent, limit: float = DEFAULT
) -> "tuple[FormulaSheet, BuiltBody]":
    """Build one body, from its name or file to the text of its module; its proven sheet as well.

    limit: as in `proven_sheet`; the text of the module does not depend on the outcome.

    Raises UserError for a fault in the source, and NotProven if a proof is missing or insufficient.
    """
    from derive.codegen.module import full_stick_text, module_text
    from derive.codegen.printer import CannotPrint
    from derive.codegen.trial import demand_right

    began = perf_counter()
    sheet = proven_sheet(source, report, limit)
    report(source, STAGES[4])
    try:
        text, stuck = module_text(sheet, _origin(source)), full_stick_text(sheet)
        report(source, STAGES[5])
        demand_right(sheet, text, stuck)
    except CannotPrint as error:
        remedy = "use only numbers and functions that NumPy supports"
        why = f"cannot be translated into NumPy code ({error})"
        raise BadProfile(sheet.geometry.name, why, remedy) from error
    closed, numerical = by_form(sheet.is_closed)
    verdicts = tuple((name, f.proof.verdict) for name, f in sheet.items() if f.proof)
    name, seconds = sheet.geometry.name, perf_counter() - began
    return sheet, BuiltBody(name, text, stuck, seconds, closed, numerical, verdicts)


def built(source: str, report: Report, limit: float) -> tuple[str, BuiltBody]:
    """The note of `time_limit_note`, and the body; a process can return them."""
    sheet, body = sheet_and_body(source, report, limit)
    report(source, DONE)
    return time_limit_note(sheet), body


def each_in_process(
    make: Callable[[str, Report], Made],
    sources: Sequence[str],
    report: Report,
    jobs: int = 1,
    limited: bool = False,
) -> list[Made]:
    """What `make` returns for every source; `jobs` processes are at work.

    limited: whether the limits USER_FILE_LIMITS, which are those for a file, also hold for bodies
        of the library

    Raises RanAway if a process ends early, or exceeds the limits.
    """
    limited = limited or not all(map(is_in_library, sources))
    return in_processes(make, sources, report, jobs, USER_FILE_LIMITS if limited else None)


def _origin(source: str) -> str:
    """The source of g(x), without anything that differs between machines."""
    return f"derive/geometries/{source}.py" if is_in_library(source) else Path(source).name


@dataclass(frozen=True)
class Order:
    """What to generate, and where; an invalid order is refused before any work is done.

    sources: names and files; empty for the whole library.
    folder: None for the package `generated`.
    writes: False if the directory is only compared.

    Raises NeedsOutput if there is no folder for a file, or `generated` is an installed package, and
    BadTarget for a folder that cannot be replaced.
    """

    sources: tuple[str, ...] = ()
    folder: Path | None = None
    writes: bool = True

    def __post_init__(self) -> None:
        if self.folder is not None:
            if self.writes:
                demand_replaceable(self.folder)
            return
        for source in self.sources:
            if not is_in_library(source):
                file_of(source)
                why = (
                    "is not in the library, and the package `generated` contains only bodies of it"
                )
                raise NeedsOutput(source, why, f" {source}")
        installed = not (GENERATED.parent / "pyproject.toml").exists()
        if installed and self.writes:
            why = "belongs to an installed package and is not changed"
            raise NeedsOutput(str(GENERATED), why, "".join(f" {s}" for s in self.sources))
        if self.writes:
            demand_replaceable(GENERATED, self.kept)

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

    def fulfil(self, bodies: Iterable[BuiltBody]) -> list[Difference]:
        """Write the package if this is wanted; return how the directory differed from it before."""
        files = self.files(bodies)
        found = differences(files, self.target, self.kept)
        if found and self.writes:
            replace_folder(files, self.target, self.kept)
        return found
