"""Checks a paper's algebra: what is printed against what follows.

    module       in                          out
    ----------   -------------------------   ---------------------------------------------------
    claim                                    a printed equation as data
    kinks        an expression               where it may kink, jump, peak or be infinite
    domain       an expression, ranges       whether it is shown to be continuous
    draw         a claim                     points: random, over decades, at kinks and spikes
    quadrature   an integrand, cuts          its integral, by two rules that agree
    values       an expression, a point      its value at the working precision
    numbers      two sides, a point          both to 30 digits that are known to be right
    zero         an expression               whether it vanishes identically, by exact steps alone
    repair       a printed equation          others that a slip of the pen could have made of it
    quick        an expression               a few digits of it at once, to tell candidates apart
    bodies       a geometry                  its formulas, each proven
    tending      a claim about a limit       whether both sides come near each other, by what power
    diagnosis    a false equation            by which constant and powers its sides differ
    verdict      a claim                     Finding: verdict, evidence, the corrected equation
    report       findings                    rows, JSON, Markdown, LaTeX, the errata
    page         findings                    one page of HTML
    displays     a LaTeX file                its displays, numbered as LaTeX numbers them
    statements   a display                   its equations, each with its condition
    spellings    an equation in LaTeX        its symbols, and what they may be
    draft        all of these                a claims file to work through
    accept       a claims file               the same with readings that a person has accepted
    formula      a user's text               an equation; only what the white list knows
    latex        a user's LaTeX              an equation as text, if it can be read in one way only
    dimensions   an equation, known units    the term that does not fit
    context      a body, symbols, an equation  the equation with its calls put in
    lines        a claims file               where its claims stand, and the file with one changed
    mistakes     a claims file               all that is wrong with it
    geometry_file  a geometry file          g(x) as text, and units; nothing of it is executed
    userfile     a claims file in TOML       the claims in it
    andresen2020/                            claims files of the paper that the method is from

Nothing but the command line imports this package.  No verdict is typed in: `expected` in a claim
is compared with what was found, and decides the exit status alone.
"""
