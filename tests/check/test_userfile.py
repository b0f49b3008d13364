"""A user's own claims: what is read, what is refused and how, in which formats it is told."""

import json
import re
import tomllib
from pathlib import Path

import pytest

from derive.check.accept import accept
from derive.check.schema import ClaimsFile, Entry
from derive.check.userfile import read_claims
from tests.check.asking import run, told, written

KEYS = set(ClaimsFile.__struct_encode_fields__)
OF_A_CLAIM = set(Entry.__struct_encode_fields__)
ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "claims.md").read_text()
TOML_OF_THE_PAGE = re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)

HEAD = """
title = "A disc"
[variables]
r = "radius"
k = { low = 0.1, high = 0.9 }
[symbols]
R = "r"
A = "pi*((r + k)**2 - k*(2*r + k))"   # a larger disc less a ring
"""
CIRCLE = HEAD + '[[claims]]\nlabel = "area"\nprinted = "A = pi*R**2"\n'
WRONG = HEAD + '[[claims]]\nlabel = "area"\nprinted = "A = 2*pi*R**2"\n'


def one(entry: str) -> str:
    """A claim by its equation, or by several lines of its entry."""
    entry = entry if "printed" in entry or "latex" in entry else f"printed = '{entry}'"
    return f"[[claims]]\nlabel = 'it'\n{entry}\n"


# ------------------------------------------------------------------ the command


@pytest.mark.parametrize(
    ("text", "status", "part"),
    [
        (CIRCLE, 0, "1 claim: 1 by definition"),
        (WRONG, 1, "Not as expected: area"),
        (WRONG + 'expected = "fails"\n', 0, ""),
        (CIRCLE + 'expected = "fails"\n', 1, ""),
        (HEAD + one("unchecked = 'no equation'\nexpected = 'unchecked'\n# printed"), 0, ""),
        ("\ufeff" + CIRCLE, 0, ""),  # a byte order mark is no mistake
    ],
)
def test_the_status_tells_whether_verdicts_are_as_expected(
    tmp_path: Path, text: str, status: int, part: str
) -> None:
    done = run(written(tmp_path, text))
    assert (done.exit_code, part in done.output) == (status, True), done.output


def test_json_has_what_the_contract_says(tmp_path: Path) -> None:
    (wrong,), (right,) = told(tmp_path, WRONG), told(tmp_path, CIRCLE)
    assert {"label", "verdict", "printed", "corrected", "evidence"} <= wrong.keys()
    assert (wrong["label"], wrong["verdict"], wrong["place"]) == ("area", "fails", "claims.toml")
    assert (wrong["printed"], wrong["corrected"]) == ("A = 2*pi*R**2", "A = pi*R**2")
    assert right["corrected"] is None


@pytest.mark.parametrize(
    ("options", "parts"),
    [
        (("--format", "markdown"), ("## Failed", r"A = \pi R^{2}")),
        (("--format", "latex"), (r"\end{document}", r"A = \pi R^{2}")),
        (
            ("--explain", "area"),
            ("printed", "compared with", "symbols", "numbers", "verdict", "corrected", "tried"),
        ),
    ],
)
def test_reports(tmp_path: Path, options: tuple[str, ...], parts: tuple[str, ...]) -> None:
    output = run(written(tmp_path, WRONG), *options).stdout
    assert all(part in output for part in parts)


def test_an_explanation_is_no_wider_than_its_words(tmp_path: Path) -> None:
    words, _, table = run(written(tmp_path, WRONG), "--explain", "area").stdout.partition("numbers")
    assert all(line == line.rstrip() for line in words.splitlines())
    assert max(map(len, table.splitlines())) < 200


# ------------------------------------------------------------------ what is refused

BAD = {
    "no TOML": ("title = ", "not valid TOML"),
    "a deep list": (
        "a = " + "[" * 3000 + '"]"' + "]" * 3000,
        "nested too deeply, and at most 8 levels",
    ),
    "no claims": (HEAD, "the file has no tables [[claims]]"),
    "numbers for claims": (
        "claims = [1, 2]\n",
        "claim 1: 1 is not allowed; it must be a table",
        "claim 2: 2 is not",
    ),
    "symbol is a list": (CIRCLE.replace('"r"', "[1]", 1), "symbol 'R': is = [1] is not allowed"),
    "name of a function": (CIRCLE.replace("R =", "sin ="), "'sin' is reserved"),
    "unit": (CIRCLE.replace("high = 0.9", "high = 0.9, unit = 'furlong'"), "unit such as N/m"),
    "unknown key": ('colour = "red"\n' + CIRCLE, "'colour'"),
    "no label": (HEAD + '[[claims]]\nprinted = "A = R"\n', "no label"),
    "unknown body": ('body = "sphere"\n' + CIRCLE, "not in the library"),
    "bad name": (CIRCLE.replace("[symbols]", '[symbols]\n"a b" = "r"'), "not a valid name"),
    "no limit": ("seconds = nan\n" + CIRCLE, "seconds = nan is not allowed; seconds must be"),
    "no time": ("seconds = 0\n" + CIRCLE, "seconds = 0 is not allowed; seconds must be a number"),
    "truth as a bound": (CIRCLE.replace("low = 0.1", "low = false"), "low must be a number"),
    "bad range": (CIRCLE.replace("low = 0.1", "low = 3"), "no valid range"),
    "twice": (CIRCLE + '[[claims]]\nlabel = "area"\nprinted = "A = R"\n', "label 'area'"),
    "control character": (CIRCLE.replace('"area"', '"a\\u001b[2J"'), "control character"),
    "no spelling": (CIRCLE + '[latex]\n"x" = ["a"]\n', "latex[...] must be a text"),
    "bad symbol": (CIRCLE.replace('R = "r"', 'R = "pi*q"'), "does not define q"),
    "symbol of a parameter": (
        'body = "hertz"\n[variables]\nl = "l"\n[symbols]\nR = "2*l"\n' + one("R = 2*l"),
        "claims.toml:5: symbol 'R'",
        "already a parameter of the body",
    ),
    "symbol of no body": (
        HEAD + 'P = "lod(r, r)"\n' + one("body = 'none'\nprinted = 'r = r'"),
        "symbols: P: lod is not a function",
    ),
    "all at once": (
        CIRCLE.replace('R = "r"', 'R = "pi*q"').replace("low = 0.1", "low = 3")
        + 'colour = "red"\nexpected = "maybe"\n[[claims]]\nlabel = "next"\nprinted = "A = ("\n',
        *("6 errors", "claims.toml:5: variable 'k'", "claims.toml:7, symbols"),
        *("claims.toml:9: claim 'area'", "claims.toml:14, claim 'next'"),
    ),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_input_is_one_message_and_status_two(case: str, tmp_path: Path) -> None:
    text, *parts = BAD[case]
    done = run(written(tmp_path, text))
    assert done.exit_code == 2, done.output
    assert all(part in done.stderr for part in parts), done.stderr
    assert "Traceback" not in done.stderr
    assert done.stdout == ""


DAY = "1979-05-27"
"""A date in TOML, which no key allows."""


@pytest.mark.parametrize("key", sorted(OF_A_CLAIM - {"label", "printed"}))
def test_a_key_of_a_claim_with_a_value_of_another_type(key: str, tmp_path: Path) -> None:
    text = CIRCLE.replace("printed", "latex") if key in ("part", "understood") else CIRCLE
    right = '[[claims]]\nlabel = "right"\nprinted = "A = pi*R**2"\n'
    done = run(written(tmp_path, f"{text}{key} = {DAY}\n{right}"), "--format", "json")
    wrong, other = json.loads(done.stdout)
    assert (done.exit_code, other["verdict"], wrong["verdict"]) == (1, "by definition", "unchecked")
    assert key in wrong["reason"]
    assert "could not be read" not in wrong["reason"]


BAD_CLAIMS = {
    "unknown key": (CIRCLE + 'colour = "red"\n', "the key 'colour' is unknown"),
    "two mistakes": (
        CIRCLE + 'colour = "red"\nfamily = 3\n',
        "; family = 3 is not allowed: family",
    ),
    "no equation": (CIRCLE.replace("printed", "says"), "`printed` and `latex`"),
    "unknown function": (CIRCLE.replace("pi*R", "eval(R)*R"), "not a function"),
    "deep": (CIRCLE.replace("pi*R", "(" * 60 + "R"), "nested deeper"),
    "unknown verdict": (CIRCLE + 'expected = "maybe"\n', "expected must be one of holds, "),
    "key of a convention": (
        CIRCLE + 'conventions = [{ what = "w", contradicts = "eq. (0)" }]\n',
        "the key 'contradicts' is unknown: leave it out of conventions",
    ),
    "ends": (CIRCLE.replace('"A =', '"integral(s, s, oo, 0) ='), "wrong order"),
    "an endless value": (
        CIRCLE.replace('"A =', '"pv(1/(s - 1), s, 0, oo) ='),
        "an end of this principal value is infinite",
    ),
    "likeness": (CIRCLE.replace("A = pi", "A ~ pi"), "~ cannot be checked"),
    "unread LaTeX": (CIRCLE.replace("printed", "latex"), "p is neither"),
    "body": (CIRCLE + 'body = "sphere"\n', "not in the library"),
    "own symbol": (CIRCLE + "symbols = { R = 'r*q' }\n", "the symbol R has no meaning in this"),
    "require": (CIRCLE + "require = 'q > 0'\n", "require: the claims file does not define q"),
    "an equation for a condition": (
        CIRCLE + "require = 'k = 1/2'\n",
        "require: 'k = 1/2' is an equation and not a condition: use `symbols`",
    ),
    "limit": (CIRCLE + "as = 'r = 0'\n", "as: this is not a limit"),
    "order": (CIRCLE + "order = 2\n", "`as` is missing: give `order` as a number"),
    "never": (CIRCLE + "require = 'r < 0'\n", "its conditions are never satisfied"),
    "part": (CIRCLE.replace("printed", "latex") + "part = 9\n", "part = 9"),
    "two statements": (
        CIRCLE.replace('printed = "A = pi*R**2"', "latex = 'A = R = 2'"),
        "the LaTeX has 2 statements",
    ),
    "given": (
        CIRCLE + "given = ['nothing']\n",
        "given: 'nothing' is not the label of an earlier claim",
    ),
    "symbol": (CIRCLE + "symbols = { R = true }\n", "symbols[...] must be a number or a text"),
    "value of no variable": (CIRCLE + "cases = [{ q = 1 }]\n", "cases: 'q' is not a variable"),
    "a case with a gap": (CIRCLE + "cases = [{ k = 0.5 }]\n", "cases: r has no value: give every"),
    "range": (CIRCLE + "ranges = { r = [false, true] }\n", "ranges[...][0] must be a number"),
}


@pytest.mark.parametrize("case", BAD_CLAIMS)
def test_what_concerns_one_claim_leaves_the_others_judged(case: str, tmp_path: Path) -> None:
    text, part = BAD_CLAIMS[case]
    right = '[[claims]]\nlabel = "right"\nprinted = "A = pi*R**2"\n'
    done = run(written(tmp_path, text + right), "--format", "json")
    wrong, other = json.loads(done.stdout)
    assert (done.exit_code, other["verdict"], wrong["verdict"]) == (1, "by definition", "unchecked")
    assert part in wrong["reason"]
    assert "claims.toml" not in wrong["reason"]


@pytest.mark.parametrize("given", ["nowhere.toml", ".", "a" * 300, "bytes.toml"])
def test_a_file_that_is_none(given: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "bytes.toml").write_bytes(b"\xff\xfe\x00")
    done = run(given)
    assert done.exit_code == 2
    if given == "bytes.toml":
        assert "UTF-8" in done.stderr
        assert "check paper.tex --draft FILE` writes one" in done.stderr  # a wheel has no example


def test_an_unknown_label_shows_the_nearest(tmp_path: Path) -> None:
    done = run(written(tmp_path, CIRCLE), "--explain", "aera")
    assert (done.exit_code, "area" in done.stderr) == (2, True)


# ------------------------------------------------------------------ corrections

WEDGE = """
body = "wedge"
seconds = 100
[variables]
a = "left edge"
c = "right edge"
[symbols]
A = "a"
"""
TURNED = "conventions = [{ what = 'counted from the right', symbols = { A = 'c' } }]"
BODIES = """
body = "hertz"
[variables]
a = { unit = "m" }
R_1 = { unit = "m" }
R_2 = { unit = "m" }
[symbols]
P = "load(a, a)"
Q = "P/2"
[latex]
'\\phi' = "phi"
"""


@pytest.mark.parametrize(
    ("printed", "more", "verdict", "corrected"),
    [
        ("load(a, c) = 2*E_star*phi*sqrt(a*c)", "", "fails", "load(a, c) = E_star*phi*sqrt(a*c)"),
        # A names the left edge; counted from the other side it is the right one
        ("load(A, a) = E_star*phi*sqrt(a*c)", TURNED, "convention", "load(A, a) = E_star*a*phi"),
        ("load(A, a) = E_star*phi*a*c", TURNED, "fails", "load(A, a) = E_star*a*phi"),
    ],
)
def test_conventions_and_calls_of_formulas_in_a_correction(
    tmp_path: Path, printed: str, more: str, verdict: str, corrected: str
) -> None:
    (it,) = told(tmp_path, f"{WEDGE}{one(printed)}{more}\n")
    assert (it["verdict"], it["corrected"], it["printed"]) == (verdict, corrected, printed)
    assert ("counted from the right" in it["evidence"]) == (verdict == "convention")


# ------------------------------------------------------------------ readings to accept


def test_what_was_understood_must_be_accepted(tmp_path: Path) -> None:
    claim = "[[claims]]\nlabel = 'area'\nlatex = 'A = \\pi R^2'\n"
    path = written(tmp_path, HEAD + claim)
    (read,) = read_claims(path).claims
    assert "A = " in read.text and read.to_accept
    (it,) = told(tmp_path, HEAD + claim)
    assert it["verdict"] == "unchecked"
    assert read.text in it["reason"]
    accepted = (read.text, "by definition"), ("A = 2*pi*R**2", "unchecked")
    for understood, verdict in accepted:
        (it,) = told(tmp_path, f"{HEAD}{claim}understood = '{understood}'\n")
        assert it["verdict"] == verdict


TO_ACCEPT = (
    HEAD
    + """
[[claims]]   # with words behind it
label = "first"
latex = 'A = \\pi R^2'

# a remark before the second
[[claims]]
label = "second"
understood = "A = R"
latex = 'A = \\pi R R'
[[claims]]
label = "third"
printed = "A = pi*R**2"
"""
)


def test_readings_are_accepted_one_by_one(tmp_path: Path) -> None:
    path = written(tmp_path, TO_ACCEPT)
    assert "0 accepted, 2 left" in run(path, "--accept", answers="n\nq\n").output
    assert path.read_text() == TO_ACCEPT
    done = run(path, "--accept", answers="every\n\n")
    assert "'every' is not y" in done.output and "0 accepted, 2 left" in done.output
    assert path.read_text() == TO_ACCEPT
    assert "2 accepted, 0 left" in run(path, "--accept", answers="all\n").output
    path.write_text(TO_ACCEPT)
    assert "1 accepted, 1 left" in run(path, "--accept", answers="y\n").output  # the input ends
    path.write_text(TO_ACCEPT)
    assert "1 accepted, 1 left" in run(path, "--accept", answers="n\ny\n").output
    assert [each.name for each in read_claims(path).claims if each.to_accept] == ["first"]
    assert "1 accepted, 0 left" in run(path, "--accept", answers="y\n").output
    assert run(path).exit_code == 0
    before, after = (tomllib.loads(text)["claims"] for text in (TO_ACCEPT, path.read_text()))
    for claim in (*before, *after):
        claim.pop("understood", None)
    assert before == after
    assert "# a remark before the second" in path.read_text()


def test_what_a_verdict_depends_on_is_shown_with_the_reading(tmp_path: Path) -> None:
    text = HEAD + (
        "[[claims]]\nlabel = 'limit'\nlatex = 'A \\sim R'\nas = 'r -> 0'\norder = 2\n"
        "[[claims]]\nlabel = 'rest'\nlatex = 'A \\sim R'\nrequire = ['r > k', 'k > 0']\n"
        "given = ['limit']\n[[claims]]\nlabel = 'unread'\nlatex = 'A = R ?'\n"
        "[[claims]]\nlabel = 'part'\nlatex = 'A = R'\npart = 2\n"
        "[[claims]]\nlabel = 'key'\nlatex = 'A = R'\nrequier = 'r > k'\n"
    )
    path = written(tmp_path, text)
    first, second = run(path, "--accept", answers="n\ny\n").output.split("2 of 2")
    for line in ("as          r -> 0", "order       2"):
        assert line in first
    for line in ("require     r > k and k > 0", "given       limit", "unchecked   ~ cannot be"):
        assert line in second
    assert "unchecked: unread: ? is neither" in second
    assert "unchecked: part: part = 2 is not the number" in second
    assert "unchecked: key: the key 'requier' is unknown" in second
    assert [each["verdict"] for each in told(tmp_path, path.read_text())] == ["unchecked"] * 5


def test_what_cannot_be_written_is_left_as_it_was(tmp_path: Path) -> None:
    """tomlkit would move the second claim before the table between the claims."""
    claim = "[[claims]]\nlabel = '{}'\nlatex = 'A = R'\n"
    text = f"{HEAD}{claim.format('x')}[signs]\nA = ['x']\n{claim.format('y')}"
    path = written(tmp_path, text)
    done = run(path, "--accept", answers="y\nn\n")
    assert (done.exit_code, "by hand" in done.output) == (2, True)
    assert path.read_text() == text
    assert [each.name for each in tmp_path.iterdir()] == [path.name]


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        (
            "[[claims]]\nlabel = 'a'\nlatex = '''\nA = R\n[[claims]]\n [c]'''\naccepted = false",
            "[[claims]]\nlabel = 'a'\nlatex = '''\nA = R\n[[claims]]\n [c]'''\naccepted = true\n"
            'understood = "A = R"\n',
        ),
        (
            "claims = [{ label = 'a', latex = 'A = R' }]  # a\r\n\r\n",
            "claims = [{ label = 'a', latex = 'A = R', understood = \"A = R\"}]  # a\r\n\r\n",
        ),
        (
            "[[claims]]  # a\nlabel='a'\nunderstood   =   '' # b\nlatex = 'A = R'\n\n# end",
            "[[claims]]  # a\nlabel='a'\nunderstood   =   \"A = R\" # b\nlatex = 'A = R'\n\n# end",
        ),
    ],
)
def test_an_acceptance_changes_nothing_else(tmp_path: Path, text: str, wanted: str) -> None:
    path = tmp_path / "claims.toml"
    path.write_bytes(text.encode())
    accept(path, {"a": "A = R"})
    assert path.read_bytes().decode() == wanted


@pytest.mark.parametrize("body", ["hertz", "wedge"])
def test_implicit_equations_are_checked_as_the_page_says(body: str, tmp_path: Path) -> None:
    """The stick zone is the contact at P - dQ/(2 f) and alpha - dsigma/(4 f E*)."""
    (shown,) = [text for text in TOML_OF_THE_PAGE if text.startswith("[variables]\na = ")]
    claim = "printed = 'stick_m(P, tilt(a, c), dQ, dsigma) = m'\nrequire = 'm < a and n < c'"
    (it,) = told(tmp_path, f"body = '{body}'\n{shown}{one(claim)}")
    assert it["verdict"] == "holds", it["reason"]


def test_a_parameter_is_defined_as_the_page_says(tmp_path: Path) -> None:
    (shown,) = [text for text in TOML_OF_THE_PAGE if text.startswith("[[claims]]")]
    (it,) = told(tmp_path, BODIES + shown)
    assert it["verdict"] == "by definition", it["reason"]


def test_what_can_be_judged_is_judged_and_the_symbol_to_define_is_named(tmp_path: Path) -> None:
    text = CIRCLE.replace("[symbols]", '[symbols]\nT = ""\nU = "2*T"\nV = "U**2"')
    text += '[[claims]]\nlabel = "names"\nprinted = "A = Z + W*Z"\n' + one("A = V")
    area, names, it = told(tmp_path, text)
    assert area["verdict"] == "by definition"
    assert "the symbols W, Z have no meaning" in names["reason"]
    assert names["printed"] == "A = Z + W*Z"
    assert "the symbol T has no meaning: define it" in it["reason"]
    done = run(written(tmp_path, text))
    assert (done.exit_code, "the symbol T has no meaning" in done.stdout) == (1, True)


def test_the_page_lists_every_key_of_a_claim() -> None:
    listed = set(re.findall(r"`(\w+)`", "".join(re.findall(r"^\| (`.*?) \|", PAGE, re.MULTILINE))))
    assert listed >= OF_A_CLAIM
