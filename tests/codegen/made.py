"""Modules of bodies that are in no library, made, imported and forgotten again."""

from collections.abc import Iterator
from contextlib import contextmanager
from types import ModuleType

from sympy import Expr

from derive import Geometry
from derive.codegen.module import module_text
from derive.codegen.trial import imported
from derive.pipeline import GENERATED
from derive.sheet.derivation import derive_sheet
from tests.derive.bodies import assumed

STUCK = (GENERATED / "full_stick.py").read_text(encoding="utf-8")


def text_of_body(g: Expr) -> str:
    """The module of g(x), its formulas taken as proven."""
    geometry = Geometry("body", g=g).described("A body.")
    return module_text(assumed(derive_sheet(geometry)), "body.py")


@contextmanager
def module_of(text: str) -> Iterator[ModuleType]:
    """A text as a module; its kernels run as plain Python."""
    with imported("body", text, STUCK) as module:
        yield module
