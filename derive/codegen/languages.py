"""Prints the closed formulas of a body as functions of another language.

In:  a FormulaSheet.
Out: source text in C, Fortran, JavaScript, Julia or MATLAB.

Each closed formula of a generated module becomes a function of scalars, whose steps are the symbols
that the sheet defines.  It returns NaN if its conditions are not met.  The formula is printed as
derived.  Unlike the formulas of the generated module it is not rewritten for floating point, so it
loses digits where its terms cancel, for example next to a kink.
"""

import textwrap
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass

from sympy import (
    Abs,
    And,
    Basic,
    Eq,
    Expr,
    Function,
    Integral,
    Max,
    Min,
    Piecewise,
    S,
    Symbol,
    exp,
    log,
)
from sympy.functions.elementary.hyperbolic import HyperbolicFunction, InverseHyperbolicFunction
from sympy.functions.elementary.trigonometric import (
    InverseTrigonometricFunction,
    TrigonometricFunction,
)
from sympy.printing.c import C99CodePrinter
from sympy.printing.codeprinter import CodePrinter
from sympy.printing.fortran import FCodePrinter
from sympy.printing.jscode import JavascriptCodePrinter
from sympy.printing.julia import JuliaCodePrinter
from sympy.printing.octave import OctaveCodePrinter

from derive.codegen import contract
from derive.codegen.contract import CONTRACT
from derive.codegen.program import Program, Step
from derive.errors import NoSuchName
from derive.sheet import FormulaSheet
from derive.symbols import M, P, a, c, e, x

_ELEMENTARY = (
    *(exp, log, Abs, Max, Min, Piecewise),
    *(TrigonometricFunction, InverseTrigonometricFunction),
    *(HyperbolicFunction, InverseHyperbolicFunction),
)

_VALUE = "value"
"""The name of a result, in languages in which a function must name it."""


@dataclass(frozen=True)
class Text:
    """One function, with each part printed in its language."""

    name: str
    arguments: list[str]
    words: str
    steps: list[tuple[str, str]]
    condition: str
    value: str


@dataclass(frozen=True)
class Language:
    """How a language writes expressions and functions.

    comment       the characters that begin a comment line
    function      yields the lines of one function of a body
    file          returns the first and the last lines of a file, from the name of the body and the
                  names of its functions
    keywords      names that an argument cannot have
    ignores_case  whether names that differ only in case are the same
    """

    printer: CodePrinter
    comment: str
    function: Callable[[str, Text], Iterator[str]]
    file: Callable[[str, list[str]], tuple[list[str], list[str]]]
    keywords: frozenset[str]
    ignores_case: bool = False


class _Fortran(FCodePrinter):
    """Prints whole numbers in max and min as reals, because their arguments must have one type."""

    def _print_Max(self, expr: Expr) -> str:
        return self._of_reals("max", expr)

    def _print_Min(self, expr: Expr) -> str:
        return self._of_reals("min", expr)

    def _of_reals(self, name: str, expr: Expr) -> str:
        args = (f"{arg}.0d0" if arg.is_Integer else self._print(arg) for arg in expr.args)
        return f"{name}({', '.join(args)})"


def code_of(sheet: FormulaSheet, language: str) -> str:
    """The closed formulas of a sheet in one of LANGUAGES.

    Raises NoSuchName if the language cannot use one of the names of the body.
    """
    spoken, geometry = LANGUAGES[language], sheet.geometry
    formulas = {name: function for function in CONTRACT for name in function.formulas}
    closed = {n: f for n, f in formulas.items() if n in sheet and _is_elementary(sheet.flat(n))}
    symbols = {s for f in closed.values() for s in (*f.arguments, *f.keywords(sheet))}
    _demand_names(geometry.name, language, map(str, symbols))
    functions = [_text(sheet, name, function, spoken) for name, function in closed.items()]
    first, last = spoken.file(geometry.name, list(closed))
    lacking = [name for name in formulas if name in sheet and name not in closed]
    lines = [*_comment(_heading(sheet, language, lacking), spoken), *first]
    for text in functions:
        lines += ["", *_comment([text.words], spoken), *spoken.function(geometry.name, text)]
    return "\n".join([*lines, *last])


def _is_elementary(expr: Expr) -> bool:
    return all(isinstance(call, _ELEMENTARY) for call in expr.atoms(Function, Integral))


def _heading(sheet: FormulaSheet, language: str, lacking: list[str]) -> Iterator[str]:
    """The description of the file, the units of the parameters, and the formulas left out."""
    yield sheet.title
    yield f"Closed formulas, printed by `derive show {sheet.geometry.name} --code {language}`."
    yield (
        "The formulas are printed as derived: they lose digits where terms cancel, for example "
        "next to a kink.  They return NaN if their conditions are not met."
    )
    for q in sheet.geometry.parameters:
        yield f"{q.name}: {q.meaning} [{q.unit}]"
    if lacking:
        yield f"Not included, because they are integrals: {', '.join(lacking)}."


def _text(sheet: FormulaSheet, name: str, function: contract.Function, language: Language) -> Text:
    """One formula as a function; the symbols of the sheet that occur in it become steps."""
    formula, print_ = sheet[name], _printing(language)
    symbols = (*function.arguments, *function.keywords(sheet))
    steps = [Step(s, expr, "") for s, expr in sheet.defined_in(name).items()]
    steps += [Step(e, M / P, "")] if P in symbols else []
    program = Program({name: sheet.shown(name)}, tuple(steps))
    condition, words = And(*function.conditions(sheet)), f"{formula.meaning} [{formula.unit}]"
    if x in symbols:
        inside = Step(Symbol("x_in", real=True), Max(-a, Min(x, c)), "")
        program = program.mapped(lambda expr: expr.xreplace({x: inside.symbol})).with_steps(inside)
        condition = And(condition, Eq(x, Symbol(x.name)))  # in C, a maximum ignores NaN
        words += "; zero outside the contact"
    program = program.ordered().renamed([*map(str, symbols), _VALUE])
    return Text(
        name,
        [print_(symbol) for symbol in symbols],
        f"{formula.head}, {words}",
        [(print_(step.symbol), print_(step.expr)) for step in program.steps],
        print_(condition),
        print_(program.outputs[name]),
    )


def _printing(language: Language) -> Callable[[Basic], str]:
    def printed(expr: Basic) -> str:
        constants, unknown, text = language.printer.doprint(expr)
        assert not unknown, f"no code is known for {unknown}"
        for constant, digits in constants:
            text = text if constant == S.Pi else text.replace(str(constant), digits)
        return str(text)

    return printed


def _demand_names(body: str, language: str, names: Iterable[str]) -> None:
    spoken, given = LANGUAGES[language], sorted({body, *names})
    for name in given:
        if name in (*spoken.keywords, _VALUE):
            raise NoSuchName(body, language, name, "is reserved in code of that language")
    seen: dict[str, str] = {}
    for name in given if spoken.ignores_case else ():
        if seen.setdefault(name.lower(), name) != name:
            raise NoSuchName(
                body,
                language,
                name,
                f"is the same name as {seen[name.lower()]!r}, because upper and lower case are not "
                "distinguished",
            )


def _comment(paragraphs: Iterable[str], language: Language) -> Iterator[str]:
    for paragraph in paragraphs:
        for line in textwrap.wrap(paragraph, 96):
            yield f"{language.comment} {line}"


def _c(body: str, text: Text) -> Iterator[str]:
    arguments = ", ".join(f"double {name}" for name in text.arguments)
    yield f"double {body}_{text.name}({arguments})"
    yield "{"
    yield f"    if (!({text.condition})) return NAN;"
    for name, value in text.steps:
        yield f"    const double {name} = {value};"
    yield f"    return {text.value};"
    yield "}"


def _fortran(body: str, text: Text) -> Iterator[str]:
    arguments = ", ".join(text.arguments)
    yield f"elemental function {text.name}({arguments}) result({_VALUE})"
    yield f"    real(dp), intent(in) :: {arguments}"
    yield f"    real(dp) :: {', '.join([_VALUE, *(name for name, _ in text.steps)])}"
    yield f"    {_VALUE} = ieee_value(1.0_dp, ieee_quiet_nan)"
    yield f"    if (.not. ({text.condition})) return"
    for name, value in text.steps:
        yield f"    {name} = {value}"
    yield f"    {_VALUE} = {text.value}"
    yield f"end function {text.name}"


def _javascript(body: str, text: Text) -> Iterator[str]:
    yield f"export function {text.name}({', '.join(text.arguments)}) {{"
    yield f"    if (!({text.condition})) return NaN;"
    for name, value in text.steps:
        yield f"    const {name} = {value};"
    yield f"    return {text.value};"
    yield "}"


def _julia(body: str, text: Text) -> Iterator[str]:
    yield f"function {text.name}({', '.join(text.arguments)})"
    yield f"    ({text.condition}) || return NaN"
    for name, value in text.steps:
        yield f"    {name} = {value}"
    yield f"    return {text.value}"
    yield "end"


def _matlab(body: str, text: Text) -> Iterator[str]:
    yield f"function {_VALUE} = {text.name}({', '.join(text.arguments)})"
    yield f"    {_VALUE} = NaN;"
    yield f"    if ~({text.condition}), return, end"
    for name, value in text.steps:
        yield f"    {name} = {value};"
    yield f"    {_VALUE} = {text.value};"
    yield "end"


def _c_file(body: str, names: list[str]) -> tuple[list[str], list[str]]:
    pi = ["#ifndef M_PI", "#define M_PI 3.14159265358979323846", "#endif"]
    return ["#include <math.h>", *pi], []


def _fortran_file(body: str, names: list[str]) -> tuple[list[str], list[str]]:
    return [
        f"module {body}",
        "use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan",
        "implicit none",
        "integer, parameter, private :: dp = kind(1.0d0)",
        "real(dp), parameter, private :: pi = 3.1415926535897932d0",
        "contains",
    ], ["", f"end module {body}"]


def _julia_file(body: str, names: list[str]) -> tuple[list[str], list[str]]:
    return [f"module {body}"], ["", "end"]


def _matlab_file(body: str, names: list[str]) -> tuple[list[str], list[str]]:
    """MATLAB can call only the first function of a file, so this one returns the others."""
    handles = [f"    functions.{name} = @{name};" for name in names]
    return [f"function functions = {body}()", *handles, "end"], []


def _words(text: str) -> frozenset[str]:
    return frozenset(text.split())


_PLAIN: Mapping[str, object] = {"human": False}
_HYPERBOLIC = {name: name for name in ("asinh", "acosh", "atanh")}

LANGUAGES: Mapping[str, Language] = {
    "c": Language(
        C99CodePrinter({**_PLAIN, "math_macros": {S.Pi: "M_PI"}}),
        "//",
        _c,
        _c_file,
        _words(
            "auto break case char const continue default do double else enum extern float for "
            "goto if inline int long register restrict return short signed sizeof static struct "
            "switch typedef union unsigned void volatile while"
        ),
    ),
    "fortran": Language(
        _Fortran(
            {
                **_PLAIN,
                "standard": 2008,
                "source_format": "free",
                "name_mangling": False,
                "user_functions": _HYPERBOLIC,
            }
        ),
        "!",
        _fortran,
        _fortran_file,
        _words("dp pi"),
        ignores_case=True,
    ),
    "javascript": Language(
        JavascriptCodePrinter(dict(_PLAIN)),
        "//",
        _javascript,
        lambda body, names: ([], []),
        _words(
            "await break case catch class const continue debugger default delete do else enum "
            "export extends false finally for function if implements import in instanceof "
            "interface let new null package private protected public return static super switch "
            "this throw true try typeof var void while with yield"
        ),
    ),
    "julia": Language(
        JuliaCodePrinter({**_PLAIN, "contract": False, "user_functions": {"atan2": "atan"}}),
        "#",
        _julia,
        _julia_file,
        _words(
            "baremodule begin break catch const continue do else elseif end export false finally "
            "for function global if import let local macro module pi quote return struct true try "
            "using while"
        ),
    ),
    "matlab": Language(
        OctaveCodePrinter(dict(_PLAIN)),
        "%",
        _matlab,
        _matlab_file,
        _words(
            "break case catch classdef continue else elseif end for function global if otherwise "
            "parfor persistent pi return spmd switch try while"
        ),
    ),
}
"""The languages of `derive show NAME --code LANGUAGE`."""
