"""Writes a geometry file from g(x) given as text.  No part of the text is ever executed.

    module       input                       output
    ----------   -------------------------   ---------------------------------------------
    lengths      SymPy expression            the unit of each parameter, because g is a length
    python       tree                        the same formula as exact Python
    draft        all of these, and reading   a Geometry and the text of its file
    apart        the input of a user         the same, made in a process with limits
    options      NAME=TEXT                   the text given for each parameter
    target       text of a file, a path      the file, written completely or not at all

The text is read by derive.reading.
"""
