"""Check the equations of a paper against formulas that are derived independently.

    module         input                     output
    -------------  ------------------------  --------------------------------------------------
    claim                                    the data class of a printed equation
    draw           claim                     points: random, over decades, at kinks and at spikes
    sides          claim, point              both sides to digits that are certain
    zero           expression                whether exact steps show that it vanishes identically
    repair         one side of an equation   similar expressions that may have been intended
    bodies         entry `body`              a body and its formulas, each proven
    tending        claim about a limit       whether the sides approach each other, and how fast
    diagnosis      false equation            by what its sides differ, and where it is true
    judge          two sides                 whether they agree, with the evidence for it
    intervals      inequality                whether it is true over the whole ranges of variables
    correction     false claim               the simplest change that makes it true
    basis          true claim                what its verdict rests on: the body or definitions
    verdict        claim                     Finding: verdict, evidence, corrected equation
    report         findings                  evidence, errata and remarks in words; JSON
    documents      findings                  Markdown, LaTeX and HTML, by templates
    meanings       four answers of a user    the standard meanings of a paper's letters
    draft          LaTeX file                a claims file for the user to complete
    accept         claims file               the same file with what a user accepted
    schema         tables of a claims file   typed records, or an error with its place
    mistakes       errors in a claims file   one error that reports all; the reason for one claim
    declarations   the file's own tables     body, ranges, units and spellings for all claims
    context        body and symbols          their meanings; an equation without calls of formulas
    equation       a claim's equation        the comparison that it stands for
    claim_table    table [[claims]]          a claim, with the reading of its LaTeX; unchecked if
                                             an entry is wrong or the reading is not accepted
    userfile       claims file in TOML       its claims
    andresen2020/                            claims files of the paper that introduced the method

Text from the user, such as an equation, is read by derive.reading.

Only the command line imports this package.  Verdicts are always computed.  The entry `expected`
of a claim is compared with the computed verdict, and affects only the exit status.
"""
