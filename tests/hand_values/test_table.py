"""The reader of the hand-worked tables: what it reads, and what it refuses and where."""

from pathlib import Path

import mpmath
import pytest

from tests.hand_values.table import Row, TableError, evaluate, named_values, read_table

HEAD = """\
# A body

## tilt

`tilt(a, c=1, *, R) -> alpha`

| inputs | expected | working |
| --- | --- | --- |
"""
EDGES = """\
## K_T

`K_T(a, c, dQ, dsigma) -> left, right`

| inputs | expected | working |
| --- | --- | --- |
"""


def read(folder: Path, text: str) -> list[Row]:
    path = folder / "body.md"
    path.write_text(text, "utf-8")
    return read_table(path)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("2.e1", 20),
        ("-2**2", -4),
        ("10*0.1 - 1", 0),  # decimals are meant as written
        ("acosh(cosh(3))", 3),
        ("2*ellipe(1/2)*ellipk(1/2) - ellipk(1/2)**2 - pi/2", 0),
        ("besseli0(0) + 2e20*besseli1(1e-20)", 2),
        ("-inf", -mpmath.inf),
    ],
)
def test_a_number(text: str, value: float) -> None:
    found = evaluate(text)
    assert found == value or abs(found - value) < 1e-38


@pytest.mark.parametrize(
    "text",
    [
        *("", "1 +", "inf - inf", "2*nan", "1/0", "log(0)", "sqrt(-1)", "1e99999", "True"),
        *("1 if 1 else 2", "7 // 2", "lambda: 1", "x", "sqrt", "sqrt(1, 2)", "sqrt(x=1)"),
        *("gamma(2)", "__import__('os').system('true')", "pi.real", "sqrt.__globals__"),
    ],
)
def test_anything_else_is_refused(text: str) -> None:
    with pytest.raises(ValueError, match=r"cannot|not"):
        evaluate(text)


@pytest.mark.parametrize("text", ["1", "a=1, 2", "a=1, a=2", "a=1) or b(c=2", "a=1)(b=2", "**a"])
def test_names_without_a_value_are_refused(text: str) -> None:
    with pytest.raises(ValueError, match=r"expected (each )?name=value"):
        named_values(text)


def test_a_row(tmp_path: Path) -> None:
    [row] = read(tmp_path, HEAD + "| `a=3, R=2` | `1/2` | (3 − 1)/4 |\n")
    assert (row.body, row.function, row.place) == ("body", "tilt", "body.md:9")
    assert row.inputs == {"a": 3, "c": 1, "R": 2}
    assert row.arguments == {"a": 3.0, "c": 1.0, "R": 2.0}
    assert row.expected == {"alpha": 0.5}
    assert row.working == "(3 − 1)/4"
    assert str(row) == "body-tilt(a=3, R=2)"


def test_several_tables_of_several_fields_with_prose_between(tmp_path: Path) -> None:
    table = "| inputs | expected | working |\n|---|:--|--:|\n| a=5, R=1 | 2 | \\|4/2\\| |\n"
    edges = "| `a=2, c=2, dQ=0, dsigma=1` | `left=1/4, right=-1/4` | (4/8)/√4 |\n"
    text = HEAD + "| `a=3, R=1` | `1` | 2/2 |\n\n### Wide\n\nWider still:\n\n" + table
    rows = read(tmp_path, f"{text}\n## By hand\n\nProse.\n\n{EDGES}{edges}")
    assert [row.expected.get("alpha") for row in rows] == [1, 2, None]
    assert rows[1].working == "|4/2|"
    assert rows[2].expected == {"left": 0.25, "right": -0.25}


@pytest.mark.parametrize(
    ("text", "line", "message"),
    [
        (HEAD + "| `a=1, R=1` | `0` | |", 9, "the working is empty"),
        (HEAD + "| `a=1, R=1` | `0` |", 9, "a row is | inputs | expected | working |"),
        (HEAD + "`a=1, R=1` | `0` | no bar in front |", 9, "expected a signature"),
        (HEAD + "| `a=1, R=1` | `0` | no bar behind", 9, "a row is"),
        (HEAD + "| `a=1, R=1` | `alpha=0` | too much |", 9, "cannot read the expression"),
        (HEAD + "| `a=1, R=1, phi=1` | `0` | of another body |", 9, "tilt takes no phi"),
        (HEAD + "| `a=1` | `0` | no radius |", 9, "tilt needs R"),
        (HEAD + "| a=1, R=1 | 0 | once |\n| R=2/2, c=1, a=1 | 0 | twice |", 10, "repeats a row"),
        (EDGES + "| a=2, c=2, dQ=0, dsigma=1 | right=1, left=1 | - |", 7, "in this order"),
        ("## slope\n", 1, "unknown function slope"),
        ("## tilt\n\n`load(a) -> P`\n", 3, "the signature of load under tilt"),
        ("## tilt\n\n`tilt(a) -> beta`\n", 3, "tilt gives alpha"),
        ("## tilt\n| inputs | expected | working |\n", 2, "before its signature"),
    ],
)
def test_what_cannot_be_read_is_told_with_its_line(
    tmp_path: Path, text: str, line: int, message: str
) -> None:
    with pytest.raises(TableError) as caught:
        read(tmp_path, text)
    assert str(caught.value).startswith(f"body.md:{line}: ")
    assert message in str(caught.value)
