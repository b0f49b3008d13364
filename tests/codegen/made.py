"""Modules of bodies that are in no library, made, imported and forgotten again."""

from collections.abc import Iterator
from contextlib import contextmanager
from types import ModuleType

from sympy import Expr

from derive import Geometry
from derive.codegen.module import module_text
from derive.codegen.trial import imported
from derive.pipeline import GENERATED
from derive.proof.verdict import Verdict
from derive.sheet.built import BuiltBody, by_form
from derive.sheet.derivation import derive_sheet
from derive.sheet.formulas import FormulaSheet
from tests.derive.bodies import assumed

STUCK = (GENERATED / "full_stick.py").read_text(encoding="utf-8")


def text_of_body(g: Expr) -> str:
    """The module of g(x), its formulas taken as proven."""
    geometry = Geometry("body", g=g).described("A body.")
    return module_text(assumed(derive_sheet(geometry)), "body.py")


def body_of(sheet: FormulaSheet, text: str) -> BuiltBody:
    """A body without the seconds that its text takes."""
    verdicts = tuple((name, Verdict.PROVEN) for name in sheet)
    return BuiltBody(sheet.geometry.name, text, STUCK, 0.0, *by_form(sheet.is_closed), verdicts)


@contextmanager
def module_of(text: str) -> Iterator[ModuleType]:
    """A text as a module; its kernels run as plain Python."""
    with imported("body", text, STUCK) as module:
        yield module
