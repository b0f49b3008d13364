"""Read what a user typed: g(x), and the formulas of a claims file.  No text is ever executed.

    module     input                        output
    --------   --------------------------   -------------------------------------------------
    words                                   the functions that may be called
    text       text, equation or limit      its tree by text.lark, or a refusal with its place
    limits     SymPy expression             whether it is too large, not finite or not real
    value      tree                         a SymPy expression within these limits
    profile    g(x) as text                 its expression, with a symbol for each parameter
    formula    formula of a claims file     an equation, a condition or a limit
    improper                                principal values, and integrals to infinity
    relation                                the relation between the two sides of an equation
    units                                   units and dimensions of expressions
                                            the term of an equation whose units do not fit;
                                            the unit of each parameter, because g is a length
    displays   LaTeX file                   its title, and its displays, numbered as LaTeX does
    lexer      LaTeX                        tokens, each with its depth in brackets: the only place
                                            that knows how things are spelled
    statements tokens of a display          its equations, each with its condition
    substitution                            the angle that an equation introduces
    spellings  tokens                       the symbols, each with a name
    typed      rules of latex.lark          typed text, or a refusal
    latex      tokens of an equation        an equation as text, if only one reading is possible

If a text is refused, the message (`BadText` or `BadFormula` of derive.command.errors) shows it with
a caret under the mistake.
"""
