"""Prints the closed formulas of a body as functions of another language.

In:  a FormulaSheet.
Out: source text in C, Fortran, JavaScript, Julia or MATLAB.

Each closed formula of a generated module becomes a function of scalars, whose steps are the symbols
that the sheet defines.  In Fortran and MATLAB it takes arrays as well.  It returns NaN where its
conditions are not met.  The formula is printed as derived.  Unlike the formulas of the generated
module, it is not rewritten for floating point, so it loses digits where its terms cancel, for
example next to a kink, and can be NaN at a kink.
"""

import shlex
import textwrap
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass

from sympy import (
    And,
    Basic,
    Eq,
    Expr,
    Gt,
    Max,
    Min,
    NumberSymbol,
    S,
    Symbol,
)
from sympy.printing.c import C99CodePrinter
from sympy.printing.codeprinter import CodePrinter
from sympy.printing.fortran import FCodePrinter
from sympy.printing.jscode import JavascriptCodePrinter
from sympy.printing.julia import JuliaCodePrinter
from sympy.printing.octave import OctaveCodePrinter

from derive.codegen import contract
from derive.codegen.contract import CONTRACT
from derive.codegen.program import Program
from derive.command.errors import NoSuchName
from derive.sheet.formulas import FormulaSheet
from derive.symbols import M, P, a, c, e, x
from derive.theory.parts import Definition

_VALUE = "value"
"""The name of a result, in languages in which a function must name it."""


@dataclass(frozen=True)
class Language:
    """How a language writes expressions and functions; the texts are templates of `str.format`.

    comment       the characters that begin a comment line
    function      one function of a body
    step          the line that computes one symbol
    argument      one argument of a function
    inside        a value that is replaced by zero outside the contact
    first, last   the first and the last lines of a file
    keywords      names that an argument cannot have
    ignores_case  whether names that differ only in case are the same
    """

    printer: CodePrinter
    comment: str
    function: str
    step: str
    keywords: str
    argument: str = "{}"
    inside: str = "x > -a && x < c ? {} : 0.0"
    first: str = ""
    last: str = ""
    ignores_case: bool = False

    def read(self, name: str) -> str:
        """A name as the language reads it: names that are read alike are the same name."""
        return name.lower() if self.ignores_case else name


class _Fortran(FCodePrinter):
    """Prints as reals the whole numbers in max and min, and those too long for an integer."""

    def _print_Max(self, expr: Expr) -> str:
        args = (f"{arg}.0d0" if arg.is_Integer else self._print(arg) for arg in expr.args)
        return f"{type(expr).__name__.lower()}({', '.join(args)})"

    _print_Min = _print_Max

    def _print_Integer(self, expr: Expr) -> str:
        return f"{expr}.0d0" if abs(expr) >= 2**31 else str(expr)


def code_of(sheet: FormulaSheet, language: str, given: str = "") -> str:
    """The closed formulas of a sheet in one of LANGUAGES.

    given: the file of the body, if it is not in the library.

    Raises NoSuchName if the language cannot use one of the names of the body.
    """
    spoken, geometry = LANGUAGES[language], sheet.geometry
    formulas = {name: function for function in CONTRACT for name in function.formulas}
    closed = {n: f for n, f in formulas.items() if sheet.is_closed(n)}
    names = {s.name for f in closed.values() for s in (*f.arguments, *f.keywords(sheet))}
    own = {q.name for q in geometry.parameters}  # last, because only these can be renamed
    _demand_names(geometry.name, language, closed, [*sorted(names - own), *sorted(names & own)])
    lacking = [name for name in formulas if name in sheet and name not in closed]
    handles = "\n".join(f"    functions.{name} = @{name};" for name in closed)
    first = spoken.first.format(body=geometry.name, handles=handles)
    head = "\n".join(
        [
            *_comment(_heading(sheet, language, given or geometry.name, lacking), spoken),
            *first.splitlines(),
        ]
    )
    functions = (_function(sheet, name, function, spoken) for name, function in closed.items())
    last = spoken.last.format(body=geometry.name)
    return "\n\n".join([head, *functions, *last.splitlines()])


def _heading(sheet: FormulaSheet, language: str, given: str, lacking: list[str]) -> Iterator[str]:
    """The description of the file, the units of the parameters, and the formulas left out."""
    yield sheet.title
    yield f"Closed formulas, printed by `derive show {shlex.quote(given)} --code {language}`."
    yield (
        "The formulas are printed as derived: they lose digits where terms cancel, for example "
        "next to a kink, and can be NaN at one.  They return NaN if their conditions are not met."
    )
    for q in sheet.geometry.parameters:
        yield f"{q.name}: {q.meaning} [{q.unit}]"
    if lacking:
        yield f"Not included, because they are integrals: {', '.join(lacking)}."


def _function(
    sheet: FormulaSheet, name: str, function: contract.Function, language: Language
) -> str:
    """One formula as a function; the symbols of the sheet that occur in it become steps."""
    body, formula, print_ = sheet.geometry.name, sheet[name], _printing(language)
    symbols = (*function.arguments, *function.keywords(sheet))
    steps = [Definition(s, expr, "") for s, expr in sheet.defined_in(name).items()]
    steps += [Definition(e, M / P, "")] if P in symbols else []
    program = Program({name: sheet.shown(name)}, tuple(steps))
    positive = (Gt(symbol, 0, evaluate=False) for symbol in function.keywords(sheet))
    condition = And(*function.conditions(sheet), *positive)
    words = f"{formula.meaning} [{formula.unit}]"
    if x in symbols:
        inside = Definition(Symbol("x_in", real=True), Max(-a, Min(x, c)), "")
        program = program.mapped(lambda expr: expr.xreplace({x: inside.symbol})).with_steps(inside)
        condition = And(condition, Eq(x, Symbol(x.name)))  # in C, a maximum ignores NaN
        words += "; zero outside the contact"
    program = program.ordered().renamed([body, *map(str, symbols), _VALUE], language.read)
    values = {print_(step.symbol): print_(step.expr) for step in program.steps}
    text = language.function.format(
        body=body,
        name=name,
        arguments=", ".join(language.argument.format(print_(symbol)) for symbol in symbols),
        locals=" &\n        ".join(textwrap.wrap(", ".join([_VALUE, *values]), 96)),
        condition=print_(condition),
        steps="".join(language.step.format(*step) + "\n" for step in values.items()),
        value=(language.inside if x in symbols else "{}").format(print_(program.outputs[name])),
    )
    return "\n".join([*_comment([f"{formula.head}, {words}"], language), text])


def _printing(language: Language) -> Callable[[Basic], str]:
    def printed(expr: Basic) -> str:
        digits = {number: number.n(17) for number in expr.atoms(NumberSymbol) - {S.Pi}}
        _, unknown, text = language.printer.doprint(expr.xreplace(digits))
        assert not unknown, f"no code is known for {unknown}"
        return str(text)

    return printed


def _demand_names(body: str, language: str, taken: Iterable[str], given: Iterable[str]) -> None:
    """Refuse a name that the language or the printed file uses for something else."""
    spoken = LANGUAGES[language]
    seen = {spoken.read(name): name for name in (*spoken.keywords.split(), _VALUE, *taken)}
    for name in (body, *given):
        first = seen.get(spoken.read(name))
        if first == name:
            raise NoSuchName(body, language, name, "cannot be used as a name in that language")
        if first:
            why = f"is the same name as {first!r}, because upper and lower case are not "
            raise NoSuchName(body, language, name, why + "distinguished")
        seen[spoken.read(name)] = name


def _comment(paragraphs: Iterable[str], language: Language) -> Iterator[str]:
    for paragraph in paragraphs:
        for line in textwrap.wrap(paragraph, 96, break_long_words=False, break_on_hyphens=False):
            yield f"{language.comment} {line}"


_CALLED = "acos acosh asin asinh atan atan2 atanh cos cosh exp log sin sinh sqrt tan tanh"
"""Functions that a formula may call, in the languages in which arguments would hide them."""

_PLAIN: Mapping[str, object] = {"human": False}
_HYPERBOLIC = {name: name for name in ("asinh", "acosh", "atanh")}
_FREE_FORM = {"standard": 2008, "source_format": "free", "name_mangling": False}

LANGUAGES: Mapping[str, Language] = {
    "c": Language(
        C99CodePrinter({**_PLAIN, "math_macros": {S.Pi: "M_PI"}}),
        "//",
        """\
double {body}_{name}({arguments})
{{
    if (!({condition})) return NAN;
{steps}    return {value};
}}""",
        "    const double {} = {};",
        "auto break case char const continue default do double else enum extern float for goto if "
        "inline int long register restrict return short signed sizeof static struct switch typedef "
        "union unsigned void volatile while cbrt fabs fmax fmin pow M_PI NAN " + _CALLED,
        argument="double {}",
        first="""\
#include <math.h>
#ifndef M_PI
#define M_PI 3.14159265358979323846
#endif""",
    ),
    "fortran": Language(
        _Fortran({**_PLAIN, **_FREE_FORM, "user_functions": _HYPERBOLIC}),
        "!",
        """\
elemental function {name}({arguments}) result(value)
    double precision, intent(in) :: {arguments}
    double precision :: {locals}
    value = ieee_value(1.0d0, ieee_quiet_nan)
    if (.not. ({condition})) return
{steps}    value = {value}
end function {name}""",
        "    {} = {}",
        "abs ieee_quiet_nan ieee_value max merge min pi " + _CALLED,
        first="""\
module {body}
use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
implicit none
double precision, parameter, private :: pi = 3.1415926535897932d0
contains""",
        last="end module {body}",
        inside="merge({}, 0.0d0, x > -a .and. x < c)",
        ignores_case=True,
    ),
    "javascript": Language(
        JavascriptCodePrinter(dict(_PLAIN)),
        "//",
        """\
export function {name}({arguments}) {{
    if (!({condition})) return NaN;
{steps}    return {value};
}}""",
        "    const {} = {};",
        "await break case catch class const continue debugger default delete do else enum export "
        "extends false finally for function if implements import in instanceof interface let new "
        "null package private protected public return static super switch this throw true try "
        "typeof var void while with yield Math NaN",
    ),
    "julia": Language(
        JuliaCodePrinter({**_PLAIN, "contract": False, "user_functions": {"atan2": "atan"}}),
        "#",
        """\
function {name}({arguments})
    ({condition}) || return NaN
{steps}    return {value}
end""",
        "    {} = {}",
        "baremodule begin break catch const continue do else elseif end export false finally for "
        "function global if import let local macro module pi quote return struct true try using "
        "while NaN abs max min " + _CALLED,
        first="module {body}",
        last="end",
    ),
    "matlab": Language(
        OctaveCodePrinter(dict(_PLAIN)),
        "%",
        """\
function value = {name}({arguments})
    [valid, {arguments}] = valid_states({condition}, {arguments});
    value = NaN(size(valid));
{steps}    value(valid) = {value};
end""",
        "    {} = {};",
        "break case catch classdef continue else elseif end for function global if otherwise "
        "parfor persistent pi return spmd switch try while "
        "NaN abs max min size valid valid_states zero_unless " + _CALLED,
        first="""\
% Returns handles of the functions below, because a file offers only its first function to others.
function functions = {body}()
{handles}
end

% Expands all arguments to a common size, and keeps of each the elements of the valid states.
function [valid, varargout] = valid_states(valid, varargin)
    for k = 1:numel(varargin)
        valid = valid & true(size(varargin{{k}}));
    end
    for k = 1:numel(varargin)
        expanded = varargin{{k}} + zeros(size(valid));
        varargout{{k}} = expanded(valid);
    end
end

% The value where the condition is true, and zero elsewhere.
function value = zero_unless(condition, value)
    value(~condition) = 0;
end""",
        inside="zero_unless(x > -a & x < c, {})",
    ),
}
"""The languages of `derive show NAME --code LANGUAGE`."""
