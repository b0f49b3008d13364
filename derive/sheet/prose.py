"""Typesets the formulas in plain text as HTML: powers, roots, indices, Greek letters."""

import re
from html import escape

_GREEK = {
    **{"alpha": "α", "beta": "β", "chi": "χ", "gamma": "γ", "kappa": "κ", "nu": "ν", "phi": "φ"},
    **{"pi": "π", "sigma": "σ", "theta": "θ", "xi": "ξ", "Delta": "Δ"},
}

_SET = (
    (r"\*\*\(([^()]+)\)", r"<sup>\1</sup>"),
    (r"(?:\*\*|\^)(\w+)", r"<sup>\1</sup>"),
    (r"\bE_star\b", "E*"),
    (r"sqrt\((\w+)\)", r"√\1"),
    (r"sqrt(?=\()", "√"),
    (r"\bdsigma\b", "Δσ"),
    (r"\bdQ\b", "ΔQ"),
    (rf"\b(d?)({'|'.join(_GREEK)})(?=\b|_)", lambda m: m[1] + _GREEK[m[2]]),
    (r"\bint\b", "∫"),
    (r"\bum\b", "µm"),
    (r"\b(\w)_(\w+)", lambda m: f"{m[1]}<sub>{m[2].replace('_', ', ')}</sub>"),
    (r"\b(\w)''", r"\1″"),
    (r"\b(\w)'(?=\()", r"\1′"),
    (r"(?<=[ =(\[])-(?=[\w∫(√ ])", "−"),
    (r"Δ (?=\w\b|\w<sub>)", "Δ"),
    ("&lt;=", "≤"),
    ("&gt;=", "≥"),
)


def prose(text: str) -> str:
    """Plain text as HTML, with its formulas typeset.

    >>> print(prose("coefficient of s**(3/2) in [-a, c]; M = -int p x dx, alpha <= K_N_left"))
    coefficient of s<sup>3/2</sup> in [−a, c]; M = −∫ p x dx, α ≤ K<sub>N, left</sub>
    >>> print(prose("Delta K_T at Delta Q = 0"))
    ΔK<sub>T</sub> at ΔQ = 0
    >>> print(prose("P'(c), the contact law's slope; 1/E_star = 2 (1 - nu^2)/E"))
    P′(c), the contact law's slope; 1/E* = 2 (1 − ν<sup>2</sup>)/E
    """
    words = escape(text, quote=False)
    for written, shown in _SET:
        words = re.sub(written, shown, words)
    return words


def unit(text: str) -> str:
    """A unit as HTML.

    >>> print(unit("Pa/m**(3/2)"), unit("Pa*sqrt(m)"))
    Pa/m<sup>3/2</sup> Pa √m
    """
    return prose(text).replace("*", " ")
