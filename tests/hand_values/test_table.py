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
FIRST_ROW_LINE = 9

EDGES_HEAD = """\
## K_T

`K_T(a, c, dQ, dsigma) -> left, right`

| inputs | expected | working |
| --- | --- | --- |
"""


def read(tmp_path: Path, text: str) -> list[Row]:
    path = tmp_path / "body.md"
    path.write_text(text, "utf-8")
    return read_table(path)


def refused(tmp_path: Path, text: str) -> str:
    """The message of the error that a file's text raises, without the folder."""
    with pytest.raises(TableError) as error:
        read(tmp_path, text)
    return str(error.value).removeprefix(f"{tmp_path}/")


class TestEvaluate:
    @pytest.mark.parametrize(
        ("text", "value"),
        [
            ("3", 3),
            ("-1/8", -0.125),
            ("2.e1", 20),
            ("2**-50", 2.0**-50),
            ("-2**2", -4),
            (" 4 - 1 ", 3),
            ("log(exp(2))", 2),
            ("acosh(cosh(3))", 3),
            ("2*ellipe(1/2)*ellipk(1/2) - ellipk(1/2)**2 - pi/2", 0),
            ("besseli0(0) + 2e20*besseli1(1e-20)", 2),
        ],
    )
    def test_a_number(self, text: str, value: float) -> None:
        assert abs(evaluate(text) - value) < 1e-38

    def test_decimals_are_meant_as_written(self) -> None:
        assert evaluate("10*0.1 - 1") == 0
        assert evaluate("1e300*1e-300 - 1") < 1e-38

    def test_not_finite_is_said_outright(self) -> None:
        assert mpmath.isnan(evaluate("nan"))
        assert evaluate("inf") == mpmath.inf
        assert evaluate("-inf") == -mpmath.inf

    @pytest.mark.parametrize(
        "text",
        [
            "",
            "1 +",
            "inf - inf",
            "2*nan",
            "1/0",
            "log(0)",
            "sqrt(-1)",
            "1e99999",
            "True",
            "1 if 1 else 2",
            "7 // 2",
            "lambda: 1",
            "x",
            "sqrt",
            "sqrt(1, 2)",
            "sqrt(x=1)",
            "gamma(2)",
            "__import__('os')",
            "__import__('os').system('true')",
            "pi.real",
            "sqrt.__globals__",
        ],
    )
    def test_anything_else_is_refused(self, text: str) -> None:
        with pytest.raises(ValueError, match=r"cannot|not"):
            evaluate(text)


class TestNamedValues:
    @pytest.mark.parametrize(
        "text", ["1", "a=1, 2", "a=1, a=2", "a=1) or b(c=2", "a=1)(b=2", "**a"]
    )
    def test_anything_else_is_refused(self, text: str) -> None:
        with pytest.raises(ValueError, match=r"expected (each )?name=value"):
            named_values(text)


class TestReading:
    def test_a_row(self, tmp_path: Path) -> None:
        [row] = read(tmp_path, HEAD + "| `a=3, c=1/2, R=2` | `5/8` | (3 − 1/2)/4 |\n")
        assert (row.body, row.function, row.line) == ("body", "tilt", FIRST_ROW_LINE)
        assert row.inputs == {"a": 3, "c": 0.5, "R": 2}
        assert row.expected == {"alpha": 0.625}
        assert row.working == "(3 − 1/2)/4"
        assert str(row) == "body-tilt(a=3, c=1/2, R=2)"
        assert row.place == f"body.md:{FIRST_ROW_LINE}"

    def test_a_default_is_filled_in(self, tmp_path: Path) -> None:
        [row] = read(tmp_path, HEAD + "| `a=3, R=1` | `1` | half of 2 |\n")
        assert row.arguments == {"a": 3.0, "c": 1.0, "R": 1.0}

    def test_several_fields(self, tmp_path: Path) -> None:
        row = "| `a=2, c=2, dQ=0, dsigma=1` | `left=1/4, right=-1/4` | (4/8)/√4 |\n"
        assert read(tmp_path, EDGES_HEAD + row)[0].expected == {"left": 0.25, "right": -0.25}

    def test_backticks_are_optional_and_bars_can_be_escaped(self, tmp_path: Path) -> None:
        [row] = read(tmp_path, HEAD + r"| a=1, R=1 | 0 | \|a\| = \|c\| |")
        assert row.working == "|a| = |c|"

    def test_several_tables_with_prose_between(self, tmp_path: Path) -> None:
        table = "| inputs | expected | working |\n|---|:--|--:|\n| `a=5, R=1` | `2` | 4/2 |\n"
        text = HEAD + "| `a=3, R=1` | `1` | 2/2 |\n\n### Wide\n\nWider still:\n\n" + table
        assert [row.expected["alpha"] for row in read(tmp_path, text)] == [1, 2]


class TestRefusing:
    @pytest.mark.parametrize(
        ("row", "message"),
        [
            ("| `a=1, R=1` | `0` | |", "the working is empty"),
            ("| `a=1, R=1` | `0` |", "expected three cells"),
            ("| `a=1, R=1` | `0` | no bar behind", "starts and ends with |"),
            ("| `a=1, R=one` | `0` | a name | ", "'one' is not allowed"),
            ("| `a=1, R=1` | `alpha=0` | a name too many |", "cannot read the expression"),
            ("| `a=1, R=__import__('os')` | `0` | a trick |", "is not allowed"),
            ("| `a=1, R=1, phi=1` | `0` | of another body |", "tilt takes no phi"),
            ("| `a=1` | `0` | no radius |", "tilt needs R"),
        ],
    )
    def test_a_row_with_its_line(self, tmp_path: Path, row: str, message: str) -> None:
        error = refused(tmp_path, HEAD + row + "\n")
        assert error.startswith(f"body.md:{FIRST_ROW_LINE}: ")
        assert message in error

    @pytest.mark.parametrize("again", ["`a=1, R=1`", "`R=2/2, a=1`", "a=1, c=1, R=1"])
    def test_a_repeated_row(self, tmp_path: Path, again: str) -> None:
        error = refused(tmp_path, HEAD + f"| a=1, R=1 | 0 | once |\n| {again} | 0 | twice |\n")
        assert error.startswith("body.md:10: repeats the row of line 9")

    @pytest.mark.parametrize("value", ["left=1", "right=1, left=1", "left=1, right=1, M=1"])
    def test_fields_other_than_the_result_has(self, tmp_path: Path, value: str) -> None:
        row = f"| `a=2, c=2, dQ=0, dsigma=1` | `{value}` | fields |\n"
        error = refused(tmp_path, EDGES_HEAD + row)
        assert error == "body.md:7: expected a value for each of left, right, in this order"

    @pytest.mark.parametrize(
        ("text", "line", "message"),
        [
            ("## slope\n", 1, "unknown function slope"),
            ("## tilt\n\n`tilt(a)`\n", 3, "expected a signature"),
            ("## tilt\n\n`load(a) -> P`\n", 3, "the signature of load under tilt"),
            ("## tilt\n\n`tilt(a) -> beta`\n", 3, "tilt gives alpha"),
            ("## tilt\n| inputs | expected | working |\n", 2, "before its signature"),
            ("## By hand\n\n| a | b |\n", 3, "outside a function's section"),
            (HEAD.replace("working", "remark"), 7, "a table starts with"),
            (HEAD.replace("---", "row"), 8, "under the table's head"),
        ],
    )
    def test_a_section_with_its_line(
        self, tmp_path: Path, text: str, line: int, message: str
    ) -> None:
        error = refused(tmp_path, text)
        assert error.startswith(f"body.md:{line}: ")
        assert message in error
