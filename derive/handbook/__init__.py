"""The formula handbook: HTML pages that need only a browser.

    module    input                              output
    -------   --------------------------------   -----------------------------------------------
    curves    a sheet, the text of its module    g(x), and the pressure of some contacts
    page      a sheet, its BuiltBody                  one page; the index of several pages

Only the commands import this package, and docs/site, whose pages show the same figures in the same
style, templates/figures.css.  A page contains its own style, pictures and formulas, so that nothing
is downloaded when it is viewed.
"""

from importlib.util import find_spec

from derive.command.errors import MissingLibrary

for _library in ("latex2mathml", "matplotlib"):
    if find_spec(_library) is None:
        raise MissingLibrary(_library, "the handbook", "handbook")
