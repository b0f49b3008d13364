"""Three long sources with 134 statements, of which 33 were broken on purpose.

Two textbook chapters in different dialects of LaTeX and a wiki page, written for this test: line
contact after Hertz and Cattaneo, a flat punch with rounded corners under shear and bulk tension,
and contact mechanics in general.  The claims files are drafts by the command that a tester worked
through, who knew which equations were broken.
"""

from pathlib import Path

import pytest
from click.testing import CliRunner

from derive.check.claim import Verdict
from derive.check.report import corrected
from derive.check.userfile import read_claims
from derive.check.verdict import check
from derive.command.cli import main

SOURCES = Path(__file__).parent / "sources"

GOOD = {Verdict.HOLDS, Verdict.NUMERICAL, Verdict.DEFINITION}

# The statements that the draft reads, and the labels of the broken equations.
BROKEN = {
    "johnson": (
        46,
        {
            "eq:peak/3",  # (P E*/(pi R))**2, not **(1/2)
            "eq:gap",  # + ln for - ln
            "eq:opening",  # a for 2 a under the root
            "eq:sx",  # z for 2 z
            "eq:tau",  # (a**2 + z**2)**(1/2) for **(-1/2)
            "eq:yieldload",  # p_Y for p_Y**2
            "eq:sxz",  # m**2 + z**2 for m**2 - z**2
            "eq:fullstick",  # without 1/pi
            "eq:q2",  # a/c for c/a
            "eq:c",  # 1 + Q/(mu P) for 1 - Q/(mu P)
            "eq:slip",  # t**2 + c**2 for t**2 - c**2
            "eq:workforce",  # without a factor 2
        },
    ),
    "flat_rounded": (
        43,
        {
            "sie",  # x + b for x - b
            "law, lawb/3",  # + b sqrt(a**2 - b**2) for -
            "rate",  # b/R for a/R
            "KN",  # sqrt(a) for sqrt(2 a)
            "sharpp",  # P/(2 pi b) for P/(pi b)
            "Qratio",  # 1 + for 1 -
            "e/2",  # sigma/(2 f p0) for sigma/(4 f p0)
            "zones/1",  # a + c - e for a - c - e
            "Kpm/1",  # sigma a/2 for sigma a/4
            "Kpm/2",
            "arm",  # a for a**2
        },
    ),
    "wiki": (
        44,
        {
            "line 16",  # E* for its square
            "line 26",  # E* a for 2 E* a
            "line 30",  # sigma_r + sigma_z for sigma_r - sigma_z
            "line 44",  # ln(a/r - sqrt) for ln(a/r + sqrt)
            "line 50",  # exponent 1/3 for 1/2
            "line 56",  # a quotient of Gamma functions upside down
            "line 64",  # a**2 for a**3
            "line 73",  # 9/4 for 9/8
            "line 79",  # + for -
            "line 91",  # sqrt(x**2 + z**2) for its square
        },
    ),
}


PARTS = 9
UNMENDED = {"sie"}
"""Broken equations for which no correction is found."""


@pytest.mark.slow
@pytest.mark.enough("1-johnson")
@pytest.mark.parametrize("name", BROKEN)
@pytest.mark.parametrize("part", range(PARTS))
def test_what_is_broken_is_found_and_nothing_else(name: str, part: int) -> None:
    claims = read_claims(SOURCES / f"{name}.toml").claims
    assert BROKEN[name][1] <= {claim.entry.label for claim in claims}
    findings = {claim.entry.label: check(claim) for claim in claims[part::PARTS]}
    assert all(finding.as_expected for finding in findings.values())
    found = {label for label, finding in findings.items() if finding.verdict == Verdict.FAILS}
    assert found == BROKEN[name][1] & findings.keys()
    assert {findings[label].verdict for label in findings.keys() - found} <= GOOD
    assert {label for label in found if corrected(findings[label]) is None} <= UNMENDED


@pytest.mark.slow
@pytest.mark.enough("johnson")
@pytest.mark.parametrize("name", BROKEN)
def test_the_draft_reads_the_source(name: str, tmp_path: Path) -> None:
    draft = tmp_path / "draft.toml"
    paper = str(SOURCES / f"{name}.tex")
    run = CliRunner().invoke(main, ["check", paper, "--draft", str(draft)])
    assert run.exit_code == 0 and f"{BROKEN[name][0]} statements read" in run.output
