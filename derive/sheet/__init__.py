"""The formula sheet of a body: all formulas, each with its unit, source and proof.

module       contents
----------   ------------------------------------------------------------
notation     formulas as text and LaTeX
mathml       LaTeX as MathML
prose        formulas in plain text as HTML
picture      curves as SVG
page         the templates of HTML pages, with one base
formulas     FormulaSheet, which holds the formulas
derivation   a body's sheet, derived from g(x) stage by stage
built        the finished body as plain data
"""
