"""The reader of the hand-worked tables: what it reads, and what it refuses and where."""

from pathlib import Path

import pytest

from tests.hand_values.table import Row, TableError, evaluate, read_table

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


@pytest.mark.parametrize(
    ("text", "line", "message"),
    [
        (HEAD + "| `a=1, R=1` | `0` | |", 9, "the working is empty"),
        (HEAD + "| `a=1, R=1` | `0` |", 9, "a row is | inputs | expected | working |"),
        (HEAD + "| `a=1, R=1, phi=1` | `0` | of another body |", 9, "tilt takes no phi"),
        (HEAD + "| `a=1` | `0` | no radius |", 9, "tilt needs R"),
        (HEAD + "| a=1, R=1 | 0 | once |\n| R=2/2, c=1, a=1 | 0 | twice |", 10, "repeats a row"),
        (EDGES + "| a=2, c=2, dQ=0, dsigma=1 | right=1, left=1 | - |", 7, "in this order"),
        ("## slope\n", 1, "unknown function slope"),
        ("## tilt\n\n`load(a) -> P`\n", 3, "the signature of load under tilt"),
    ],
)
def test_what_cannot_be_read_is_told_with_its_line(
    tmp_path: Path, text: str, line: int, message: str
) -> None:
    with pytest.raises(TableError) as caught:
        read(tmp_path, text)
    assert str(caught.value).startswith(f"body.md:{line}: ")
    assert message in str(caught.value)
