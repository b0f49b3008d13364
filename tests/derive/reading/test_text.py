"""g(x) as text: read exactly, or refused with a caret under the place; nothing is ever run."""

import time
from collections.abc import Callable
from types import FunctionType
from typing import Any

import pytest
import sympy
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from sympy import (
    Abs,
    Expr,
    Heaviside,
    Max,
    Min,
    Piecewise,
    Rational,
    Symbol,
    sign,
    sqrt,
    symbols,
)

from derive.command.errors import BadText
from derive.command.new_geometry import _Exact
from derive.reading.limits import LARGEST, MOST_TERMS, STEEPEST, terms
from derive.reading.profile import OF_PROFILES, read
from derive.reading.text import LONGEST, parse
from derive.reading.words import ALLOWED, FUNCTIONS
from derive.symbols import x

R, b, k, phi = symbols("R b k phi", positive=True)
third = Rational(1, 3)
DEEPEST = OF_PROFILES.deepest

ACCEPTED = {
    "x**2/(2*R)": x**2 / (2 * R),
    "5e-1*x**2/R": x**2 / (2 * R),
    "1E+2*x": 100 * x,
    "0.1*x": Rational(1, 10) * x,
    "007*x": 7 * x,
    "Abs(x)**(1/3)*b**(2/3)": Abs(x) ** third * b ** (2 * third),
    "abs(x)**1.5/sqrt(R)": Abs(x) ** Rational(3, 2) / sqrt(R),
    "-x**2/R": -(x**2) / R,
    "x**2**3": x**8,
    "---x + +b": b - x,
    "max(x, -x, b) - min(x, -x)": Max(x, -x, b) - Min(x, -x),
    "x*sign(x) + x*Heaviside(x - b)": x * sign(x) + x * Heaviside(x - b),
    "x0_1*x": Symbol("x0_1", positive=True) * x,
}
CONDITIONS = {
    "Abs(x) <= b": Abs(x) <= b,
    "-b < x < b": (-b < x) & (x < b),
    "x < -b or b < x": (x < -b) | (b < x),
    "not x < b": ~(x < b),
    "(x < b or x > R) and x > k": ((x < b) | (x > R)) & (x > k),
}
ACCEPTED |= {
    f"Piecewise((x, {t}), (b, True))": Piecewise((x, c), (b, True)) for t, c in CONDITIONS.items()
}


@pytest.mark.parametrize("text", ACCEPTED)
def test_a_text_is_read_as_what_it_says(text: str) -> None:
    assert read(text) == ACCEPTED[text]


def test_names_come_in_the_order_of_the_text() -> None:
    names = parse("phi*Abs(x - b) + x**2/R + phi", OF_PROFILES).names()
    assert names == {"phi": 0, "x": 8, "b": 12, "R": 22}


def test_every_function_of_the_list_is_callable_and_told() -> None:
    for name, function in OF_PROFILES.functions.items():
        if name != "Piecewise":
            assert read(f"{name}(x/b)") == function.of_sympy(x / b)
        told = ALLOWED.replace("their inverses", " ".join(f"a{f}" for f in FUNCTIONS))
        assert function.of_sympy.__name__ in told


# Every row: a text, the column of its caret, a part of the reason, a part of the remedy.

CODE = [
    ("__import__('os').system('touch X')", 0, "cannot be used as a name", "choose another"),
    ("eval('1')", 0, "eval is not a function", "a function of the list"),
    ("x.real", 1, "attributes", "decimal numbers"),
    ("lambda: 0", 0, "lambda is not allowed", "leave it out"),
    ("'x'", 0, "' has no meaning", "as in Python"),
    ("(y := x)", 3, ": has no meaning", "as in Python"),
    ("y = x", 2, "an assignment", "right-hand side"),
    ("x[0]", 1, "[ is not allowed", "( )"),
]

CHARACTERS = [
    ("x^2/R", 1, "^ does not denote a power", "write **"),
    ("x²/R", 1, "SUPERSCRIPT TWO (U+00B2)", "write **"),
    ("х**2/R", 0, "CYRILLIC SMALL LETTER HA (U+0445)", "ASCII"),
    ("x − b", 2, "MINUS SIGN (U+2212)", "write -"),
    ("x\u202e + b", 1, "RIGHT-TO-LEFT OVERRIDE", "ASCII"),
    ("x\0", 1, "'\\x00' is a character without a name", "ASCII"),
    ("x\udc80", 1, "U+DC80", "ASCII"),
    ("x // 2", 2, "rounds down", "write /"),
]

GRAMMAR = [
    ("", 0, "empty", "x**2/(2*R)"),
    ("2x", 1, "operator is missing", "2*x"),
    ("R(x)", 0, "R is not a function", "R*(...)"),
    ("Abs*x", 0, "Abs is a function", "Abs(...)"),
    ("Abs()", 4, "missing before )", "add it"),
    (f"Max({', '.join('x' * 21)})", 0, "Max takes 1 to 20 arguments", "others"),
    ("x +", 3, "ends too early", "add a number"),
    ("(x", 2, "not closed", "add )"),
    ("x)", 1, "no matching (", "add ("),
    ("2,5*x", 1, "a comma", "2.5"),
    ("|x|", 0, "|x| cannot be used", "Abs(x)"),
    ("(" * 10**6 + "x" + ")" * 10**6, LONGEST, "2000001 characters", "shorten"),
    ("(" * 200 + "x" + ")" * 200, DEEPEST, "nested deeper than 30", "fewer"),
    ("x**" * 200 + "x", 3 * DEEPEST + 1, "nested deeper than 30", "fewer"),
]

NAMES = [
    ("n*x", 0, "parameter 'n' is reserved by the theory", "letters and digits"),
    ("x*w_1", 2, "reserved by the theory", "letters and digits"),
    ("Geometry*x", 0, "used by the geometry file itself", "letters and digits"),
]

MEANING = [
    ("x < b", 2, "a condition cannot be used as a value", "Piecewise"),
    ("(x, b)", 0, "a pair cannot be used as a value", "Piecewise"),
    ("Piecewise(x)", 10, "must be pairs", "(value, condition)"),
    ("Piecewise((x, x and b))", 14, "a value cannot be used as a condition", "x < b"),
    ("Piecewise((x, 1 < 2))", 16, "compares two constants", "compare x"),
    ("Piecewise((x, x > x))", 0, "is not finite", "another"),
    ("1/0", 1, "is not finite", "another"),
    ("sqrt(-1)*x", 0, "is not real", "another"),
    ("9**9**9**9", 4, "exponent is too large", "100"),
    ("x**101", 1, "exponent is too large", "100"),
    ("(x + b + R + k)**50", 15, "1000 terms", "another"),
    ("x**60*x**60", 5, "powers above 100", "another"),
    ("exp(exp(exp(9)))", 4, "above 1e100 or below 1e-100", "another"),
    ("9" * 1000, 0, "number is too long", "40 digits"),
    ("*".join(["1e90"] * 20), 4, "above 1e100 or below 1e-100", "another"),
]

REFUSED = CODE + CHARACTERS + GRAMMAR + NAMES + MEANING


@pytest.mark.parametrize(
    ("text", "column", "why", "remedy"),
    REFUSED,
    ids=[ascii(text)[1:40] + f" ({i})" for i, (text, *_) in enumerate(REFUSED)],
)
def test_a_bad_text_is_refused_at_its_place(text: str, column: int, why: str, remedy: str) -> None:
    began = time.perf_counter()
    with pytest.raises(BadText) as caught:
        read(text)
    error = caught.value
    assert time.perf_counter() - began < 5
    assert (error.given, error.column) == (text, column)
    assert why in error.why and remedy in error.remedy
    assert error.message.startswith(f"{error.why}: {error.remedy}\n")
    assert error.message.endswith(f"allowed in g(x): {ALLOWED}")
    _, shown, below, _ = error.message.splitlines()
    assert below.strip() == "^"
    place = below.index("^")
    assert shown[place : place + 1].strip() in (text[column : column + 1], "?", "")
    assert len(shown) < 100 and shown.isprintable()


# Random formulas: the same text for Python, in which numbers and conditions are SymPy's.

Pair = tuple[str, str]
LEAVES = [(name, name) for name in ("x", "R", "b", "k", "pi")]
LEAVES += [(str(i), f"Integer({i})") for i in (0, 1, 2, 3, 12)]
LEAVES += [(text, f"Rational('{text}')") for text in ("0.5", "2.75", ".1", "1e-2", "3.E1")]
WORDS = {"and": "&", "or": "|", "&": "&", "|": "|"}


def pick(draw: st.DrawFn, *options: str) -> str:
    return draw(st.sampled_from(options))


@st.composite
def formulas(draw: st.DrawFn, depth: int = 3) -> Pair:
    """A formula for the program, and the same for Python."""
    if depth == 0 or draw(st.booleans()):
        return draw(st.sampled_from(LEAVES))
    kind = pick(draw, "flat", "flat", "flat", "sign", "( )", "of one", "of two", "Piecewise")
    parts = [draw(formulas(depth - 1)) for _ in range(draw(st.integers(2, 4)))]
    if kind == "flat":  # precedence decides what belongs together
        return flat(draw, parts)
    if kind == "Piecewise":
        condition = draw(conditions())
        cases = zip(parts[0], condition, parts[1], strict=True)
        first, second = (f"Piecewise(({p}, {c}), ({q}, True))" for p, c, q in cases)
        return first, second
    before = {
        "sign": pick(draw, "-", "- ", "+", "-+-"),
        "( )": "(",
        "of one": pick(draw, "Abs", "sqrt", "sign", "exp", "cosh", "atan", "Heaviside") + "(",
        "of two": pick(draw, "Max", "Min") + "(",
    }[kind]
    after = "" if kind == "sign" else ")"
    first, second = (
        before + (f"{p}, {q}" if kind == "of two" else p) + after
        for p, q in zip(*parts[:2], strict=True)
    )
    return first, second


def flat(draw: st.DrawFn, parts: list[Pair]) -> Pair:
    ours, theirs = parts[0]
    for more_of_ours, more_of_theirs in parts[1:]:
        sign_, blank = pick(draw, "+", "-", "*", "/", "**"), pick(draw, "", " ", "  ")
        ours += blank + sign_ + blank + more_of_ours
        theirs += sign_ + more_of_theirs
    return ours, theirs


@st.composite
def conditions(draw: st.DrawFn, depth: int = 2) -> Pair:
    """A condition; Python needs parentheses where the program needs none."""
    if depth == 0 or draw(st.booleans()):
        (p, q), order = draw(formulas(1)), pick(draw, "<", "<=", ">", ">=")
        if draw(st.booleans()):
            return f"x {order} {p}", f"(x {order} {q})"
        return f"-b - x {order} x < {p}", f"((-b - x {order} x) & (x < {q}))"
    first, second = draw(conditions(depth - 1)), draw(conditions(depth - 1))
    if draw(st.booleans()):
        return f"{pick(draw, 'not ', '~')}({first[0]})", f"(~{first[1]})"
    word = pick(draw, *WORDS)
    return f"({first[0]}) {word} ({second[0]})", f"({first[1]} {WORDS[word]} {second[1]})"


def computed(code: str) -> Any:
    """What Python makes of an expression with the names of SymPy."""
    space = vars(sympy) | {"x": x, "R": R, "b": b, "k": k}
    function: Callable[[], Any] = FunctionType(compile(code, "<formula>", "eval"), space)
    return function()


def read_or_skip(text: str) -> Expr:
    """The formula of a text that is well formed; one that is not real or finite is passed over."""
    try:
        return read(text)
    except BadText as error:
        assert error.why.startswith(("the result", "the exponent", "this compares")), error.message
        assume(False)
        raise


@pytest.mark.slow
@settings(max_examples=150)
@given(formulas())
def test_a_text_means_what_it_means_in_python_and_what_is_written_of_it(pair: Pair) -> None:
    text, wanted = pair
    expr = read_or_skip(text)
    assert expr == computed(wanted)
    assert sympy.sympify(computed(_Exact().doprint(expr))) == expr


@settings(max_examples=300)
@given(st.text("x2b*+-/(),.<&|~^ =[]'_ae1\0é", max_size=12))
def test_any_text_is_read_or_refused(text: str) -> None:
    try:
        assert isinstance(read(text), Expr)
    except BadText as error:
        assert 0 <= error.column <= len(text)


def test_the_limits_are_where_they_are_said_to_be() -> None:
    assert read(f"x**{STEEPEST}") == x**STEEPEST
    assert read("1e100*x") == LARGEST * x
    assert terms(read("(x + b)**100")) == 101 <= MOST_TERMS
    assert read("(" * DEEPEST + "x" + ")" * DEEPEST) == x
    assert read("x" + " " * (LONGEST - 1)) == x
