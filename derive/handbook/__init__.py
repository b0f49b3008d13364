"""The formula handbook: pages of HTML that need nothing but a browser.

    module    in                                 out
    -------   --------------------------------   -----------------------------------------------
    mathml    LaTeX of the sheet                 MathML, which browsers draw by themselves
    prose     words of the sheet                 HTML, its powers, roots and signs set
    picture   curves                             an SVG picture
    curves    a sheet, the text of its module    g(x), and the pressure of some contacts
    page      a sheet, its Body                  one page; the index of several
    shelf     pages, a file or a directory       the pages on disk, whole or not at all

Only the commands read this package.  A page holds its own style, pictures and formulas: nothing is
fetched when it is viewed.
"""

from importlib.util import find_spec

from derive.errors import MissingLibrary

for _library in ("jinja2", "latex2mathml"):
    if find_spec(_library) is None:
        raise MissingLibrary(_library, "the handbook", "handbook")
