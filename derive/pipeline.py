"""From g(x) to NumPy: the stages in order, what comes in and what goes out.

    stage          in                         out
    ------------   ------------------------   -----------------------------------------------
    load_geometry  a name or a file           Geometry: g(x), its parameters, its slope
    derive_sheet   Geometry                   FormulaSheet: every formula, named and sourced
    prove_sheet    FormulaSheet               the same with a proof for every formula
    module_text    proven FormulaSheet        the text of a NumPy module
    package_files  texts of modules           the files of a package
    publish        files, a directory         the directory replaced whole, or
    differences    files, a directory         what would change

What is not proven stops the build at module_text: nothing is written.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter

from derive.codegen.module import module_text
from derive.codegen.printer import CannotPrint
from derive.codegen.publish import (
    Difference,
    demand_replaceable,
    differences,
    modules_in,
    package_files,
    publish,
)
from derive.derivation import derive_sheet
from derive.errors import BadProfile, NeedsOutput, TwoOfOneName
from derive.library import is_in_library, library, load_geometry
from derive.proof.prove import prove_sheet
from derive.sheet import FormulaSheet

GENERATED = Path(__file__).parent.parent / "generated"
"""The package that is committed."""

STAGES = ("reading g(x)", "deriving", "proving", "generating")

Report = Callable[[str, str], None]
"""Told the body and the stage that it enters."""


@dataclass(frozen=True)
class Body:
    """One body at the end of the pipeline."""

    sheet: FormulaSheet
    text: str
    seconds: float

    @property
    def name(self) -> str:
        """The body's name, and its module's."""
        return self.sheet.geometry.name


def build(source: str, report: Report = lambda body, stage: None) -> Body:
    """One body, from its name or file to the text of its module.

    Raises UserError for what is wrong with the source, NotProven for a proof that falls short.
    """
    began = perf_counter()
    report(source, STAGES[0])
    geometry = load_geometry(source)
    report(source, STAGES[1])
    sheet = derive_sheet(geometry)
    report(source, STAGES[2])
    sheet = prove_sheet(sheet)
    report(source, STAGES[3])
    try:
        text = module_text(sheet, _origin(source))
    except CannotPrint as error:
        remedy = "write it with numbers and functions that NumPy has"
        raise BadProfile(geometry.name, f"cannot become code ({error})", remedy) from error
    return Body(sheet, text, perf_counter() - began)


def _origin(source: str) -> str:
    """Where g(x) came from, without anything that differs between machines."""
    return f"derive/geometries/{source}.py" if is_in_library(source) else Path(source).name


@dataclass(frozen=True)
class Order:
    """What is to be generated, and where to; a wrong order is refused before any work.

    sources: names and files; none for the whole library.
    folder: None for the package `generated`.

    Raises NeedsOutput for a file without a folder, BadOutput for a folder that must not be
    replaced.
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
            made[body.name] = body.text
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
