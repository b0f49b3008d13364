"""Writes a geometry file from g(x) given as text, of which nothing is ever executed.

    module       in                          out
    ----------   -------------------------   ---------------------------------------------
    vocabulary                               what a text may hold: names of functions
    tokens       text                        tokens, each with its column
    grammar      tokens                      a tree
    meaning      tree                        a SymPy expression, no larger than `limits`
    lengths      SymPy expression            the unit of each parameter, as g is a length
    python       tree                        the same formula as exact Python
    draft        all of these                a Geometry and the text of its file
    apart        what a user says            the same, made in a process that has limits
    options      NAME=TEXT                   what is said of each parameter
    target       text of a file, a place     the file, whole or not at all

What is refused is shown with a caret under the place: `derive.errors.BadText`.
"""
