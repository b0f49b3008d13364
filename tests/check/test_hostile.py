"""Files that mean harm, or none: clear messages within their limit in time; no code runs.

Keys with a value of another type are in test_userfile.py.
"""

import time
from pathlib import Path

import pytest

from tests.check.asking import run

HEAD = 'seconds = 1\n[variables]\na = "a"\nb = "b"\n[symbols]\n'
CLAIM = "[[claims]]\nlabel = 'it'\n"
DEEP = "(" * 3000 + "a" + ")" * 3000


def claim(text: str, more: str = "") -> str:
    return f"{HEAD}{CLAIM}printed = '{text}'\n{more}"


def symbols(text: str, printed: str = "X = a") -> str:
    return f"{HEAD}{text}\n{CLAIM}printed = '{printed}'\n"


def latex(text: str) -> str:
    return f"{HEAD}{CLAIM}latex = '{text}'\n"


FILES = {
    "cycle of two": symbols('X = "Y"\nY = "X"'),
    "cycle of many": symbols("\n".join(f'X{n} = "X{(n + 1) % 90}"' for n in range(90)), "X0 = a"),
    "a tower of symbols": symbols(
        'X0 = "a"\n' + "\n".join(f'X{n} = "X{n - 1}*X{n - 1}"' for n in range(1, 60)), "X59 = a"
    ),
    "nested integrals": claim("a = " + "integral(" * 30 + "a" + ", s, 0, 1)" * 30),
    "large exponent": claim("a = a**(10**6)"),
    "small exponent": claim("a = 10**(-10**6)"),
    "long sum": claim("a = sum(k, k, 1, 10**9)"),
    "endless sum": claim("a = sum(k, k, 1, oo)"),
    "derivative of all orders": claim("a = diff(sin(a), a, 10**6)"),
    "limit of nothing": claim("a = limit(sin(1/a), a, 0)"),
    "expansion": claim("a = " + "*".join(f"(a + b + {n})" for n in range(90))),
    "require is code": claim("a = a", "require = '__import__(1)'"),
    "as is code": claim("a = b", "as = 'eval(a) -> 0'"),
    "body is empty": claim("a = b", "body = { }"),
    "power of a sum": claim("a = (a + b)**100*(a - b)**100"),
    "many exponentials": claim("a = " + "exp(" * 8 + "a" + ")" * 8),
    "pole": claim("a = integral(1/s, s, -1, 1)"),
    "pv without a pole": claim("a = pv(s, s, 0, 1)"),
    "pv of many poles": claim("a = pv(1/((s - a)*(s - b)), s, 0, 1)"),
    "require is nowhere": claim("a = a + b - b", "require = 'a < 0'"),
    "as goes nowhere": claim("a = b", "as = 'sin(a) -> 2'"),
    "body is a path": claim("a = b", "body = '../../evil.py'"),
    "units are a bomb": symbols("X = { is = 'a', unit = '" + "(" * 500 + "m" + ")" * 500 + "' }"),
    "symbol has odd keys": symbols("X = { exec = 'a' }"),
    "latex input": latex(r"a = \input{/etc/passwd}"),
    "latex deep": latex("a = " + "{" * 900 + "a" + "}" * 900),
    "latex fractions": latex("a = " + r"\frac{a}{" * 150 + "a" + "}" * 150),
    "latex roots": latex("a = " + r"\sqrt{" * 300 + "a" + "}" * 300),
    "latex long": latex("a = " + "a+" * 5000 + "a"),
    "latex integrals": latex(r"a = \int\int\int\int"),
    "latex sum": latex(r"a = \sum_{k=1}^{99999999} k"),
    "many claims": HEAD + "".join(f"[[claims]]\nlabel='{n}'\nprinted='a=a'\n" for n in range(600)),
    "a large file": claim("a = a", "says = '" + "x" * 250_000 + "'"),
    "conventions of code": claim(
        "a = b", "conventions = [{ what = 'x', symbols = { a = 'exec(1)' } }]"
    ),
}

PAPERS = {
    "open braces": r"\newcommand{\a}{" + "{" * 5000 + "}",
    "integrals of nothing": r"\newcommand{\a}{\int \int \int}",
    "many fractions": r"\newcommand{\a}{" + r"\frac" * 500 + "}",
    "an index of nothing": r"\newcommand{\a}{_ = ^}",
    "a bomb of macros": r"\newcommand{\a}{\b\b\b\b}\newcommand{\b}{\c\c\c\c}"
    r"\newcommand{\c}{\d\d\d\d}\newcommand{\d}{\e\e\e\e}\newcommand{\e}{xxxxxxxxxxxx}",
    "a macro of itself": r"\newcommand{\a}{\a\a}",
    "a macro of many arguments": r"\newcommand{\a}[9]{#1#2#3#4#5#6#7#8#9}",
    "a macro that is open": r"\newcommand{\a}{{{{",
    "a definition": r"\def\a#1{#1}",
    "arrays": r"\newcommand{\a}{\begin{array}{" + "c" * 500 + r"} x \end{array}}",
    "overs": r"\newcommand{\a}{" + r"{x \over " * 60 + "x" + "}" * 60 + "}",
    "dashes": r"\newcommand{\a}{" + r"-\!" * 500 + r"\int}",
    "signs": r"\newcommand{\a}{" + r"\pm x " * 200 + "}",
    "relations": r"\newcommand{\a}{" + "x = " * 400 + "x}",
}


def timed(*arguments: object) -> tuple[int, str, float]:
    start = time.monotonic()
    done = run(*arguments)
    return done.exit_code, done.output, time.monotonic() - start


@pytest.mark.slow
@pytest.mark.parametrize("name", FILES)
def test_a_hostile_claims_file(name: str, tmp_path: Path) -> None:
    path = tmp_path / "claims.toml"
    path.write_text(FILES[name], encoding="utf-8")
    code, told, seconds = timed(path)
    assert code in (0, 1, 2)
    assert told.strip()
    assert "Traceback" not in told
    assert seconds < 30
    assert [each.name for each in tmp_path.iterdir()] == ["claims.toml"]


@pytest.mark.slow
@pytest.mark.parametrize("name", PAPERS)
def test_a_hostile_paper(name: str, tmp_path: Path) -> None:
    path = tmp_path / "paper.tex"
    body = r"\begin{document}\begin{equation} y = \a{1}{2}{3} \end{equation}\end{document}"
    path.write_text(PAPERS[name] + body, encoding="utf-8")
    code, told, seconds = timed(path, "--draft", tmp_path / "new.toml")
    assert code in (0, 2)
    assert "Traceback" not in told
    assert seconds < 30
