"""Formulas as text and LaTeX, always rendered from expressions and never typed by hand."""

import re
from functools import cache

from sympy import Add, Basic, Expr, Integral, Mul, Pow, Rel, S, Symbol, sstr
from sympy.printing.conventions import split_super_sub
from sympy.printing.latex import LatexPrinter, translate
from sympy.printing.precedence import PRECEDENCE

from derive.symbols import QUANTITIES

_FUNCTIONS = ("sin", "cos", "tan", "cot")
"""Names such as sin_1 are functions of half the angle of a point."""

_DERIVATIVE = re.compile(r"d(\d*)([A-Za-z]+(?:_\w+)?)_d([A-Za-z]+(?:_\w+?)?)\1")
"""Name of a derivative such as dP_dQ, dP_prime_db or d2g_dx2."""


def text_of(expr: Basic) -> str:
    """`expr` as one line of text."""
    return str(sstr(gathered(expr)))


def latex_of(expr: Basic) -> str:
    """`expr` in LaTeX, in the notation of the theory."""
    symbols = {s: latex_name(s.name) for s in expr.atoms(Symbol)}
    has_words = any(name.startswith(r"\mathrm") for name in symbols.values())
    settings = {
        "symbol_names": symbols,
        "mul_symbol": r"\," if has_words else None,
        "ln_notation": True,
        "diff_operator": "rd",
    }
    return str(_Printer(settings).doprint(gathered(expr)))


class _Printer(LatexPrinter):
    """Writes the integrals of a product beside its fraction, and begins a sum without a minus."""

    def _as_ordered_terms(self, expr: Add, order: str | None = None) -> list[Expr]:
        terms = list(super()._as_ordered_terms(expr, order=order))
        return sorted(terms, key=lambda term: term is not _first_with_plus(terms))

    def _print_Mul(self, expr: Expr) -> str:
        factors = Mul.make_args(expr)  # SymPy prints 1/x by this method, too
        last = [f for f in factors if isinstance(f, Integral) or hasattr(f, "integrates")]
        rest = Mul(*(f for f in factors if f not in last), evaluate=False)
        if not last or rest == 1:
            return str(super()._print_Mul(expr))
        before = "-" if rest == -1 else self.parenthesize(rest, PRECEDENCE["Mul"], strict=True)
        return " ".join([before, *map(self._print, last)])


def _first_with_plus(terms: list[Expr]) -> Expr:
    """The first term without a minus sign, or the first one."""
    return next((term for term in terms if not term.could_extract_minus_sign()), terms[0])


@cache
def latex_name(name: str) -> str:
    r"""The name of a symbol in LaTeX: letters are italic, words upright, indices after commas.

    A name that is LaTeX already is kept.

    >>> print(latex_name("L_T_left"), latex_name("Delta_sigma_th"), latex_name("a_prime"))
    L_{T,\mathrm{left}} \Delta \sigma_{\mathrm{th}} a'
    >>> print(latex_name("dQ"), latex_name("K_N1"), latex_name("dP_dQ"))
    \Delta Q K_{N1} \frac{\mathrm{d}P}{\mathrm{d}Q}
    """
    if "\\" in name or "{" in name:
        return name
    if own := _theory_names().get(name):
        return own
    if (found := _DERIVATIVE.fullmatch(name)) and all(map(_begins_with_letter, found.groups()[1:])):
        times = f"^{{{found[1]}}}" if found[1] else ""
        over, under = latex_name(found[2]), latex_name(found[3])
        return rf"\frac{{\mathrm{{d}}{times}{over}}}{{\mathrm{{d}}{under}{times}}}"
    stem, raised, lowered = split_super_sub(name)
    base = _theory_names().get(stem) or _letter(stem)
    if stem in _FUNCTIONS:
        base = rf"\{stem}"
    elif stem == "Delta" and _is_letter(lowered[0] if lowered else ""):
        letter, *lowered = lowered
        base = rf"\Delta {_letter(letter)}"
    if lowered[:1] == ["prime"]:
        base, lowered = f"{base}'", lowered[1:]
    below, above = (",".join(map(_letter, parts)) for parts in (lowered, raised))
    return base + (f"_{{{below}}}" if below else "") + (f"^{{{above}}}" if above else "")


def _begins_with_letter(name: str) -> bool:
    return _is_letter(name.partition("_")[0])


def _is_letter(part: str) -> bool:
    """Whether a part of a name is one letter, Latin or Greek."""
    return part.isalpha() and not _letter(part).startswith(r"\mathrm")


def _letter(part: str) -> str:
    """A part of a name: a letter, Greek or Latin, with digits, or a word, which is upright."""
    if re.fullmatch(r"[A-Za-z]?\d*", part):
        return part
    spelled = translate(part)
    word = part.replace("_", r"\_")
    return spelled if spelled.startswith("\\") else rf"\mathrm{{{word}}}"


@cache
def _theory_names() -> dict[str, str]:
    return {"dq": r"\Delta q"} | {q.name: q.latex for q in QUANTITIES.values() if q.latex}


def gathered(expr: Basic) -> Basic:
    """`expr` with the half powers of every product under one root, e.g. sqrt(P R/E*).

    Powers of one base get one exponent, e.g. L**(1 - k).
    """
    if not expr.args:
        return expr
    args = [gathered(arg) for arg in expr.args]
    if isinstance(expr, Mul):
        return gathered_product(_with_one_exponent(args))
    if isinstance(expr, Add | Pow | Rel):  # otherwise P > 0 becomes True for a positive P
        return expr.func(*args, evaluate=False)
    return expr.func(*args)


def _with_one_exponent(factors: list[Expr]) -> list[Expr]:
    """The factors of a product; a base with a symbolic exponent occurs once."""
    powers: dict[Expr, list[Expr]] = {}
    for factor in factors:
        powers.setdefault(factor.as_base_exp()[0], []).append(factor)
    made: list[Expr] = []
    for base, same in powers.items():
        exponent = Add(*(factor.as_base_exp()[1] for factor in same))
        made += [base**exponent] if len(same) > 1 and exponent.free_symbols else same
    return made


def gathered_product(factors: list[Expr]) -> Expr:
    """A product with its half powers under one root."""
    halves = [f for f in factors if is_half_power(f)]
    if len(halves) < 2:
        return Mul(*factors, evaluate=False)
    rest = [f for f in factors if not is_half_power(f)]
    inside = Mul(*(f.base ** (2 * f.exp) for f in halves))
    return Mul(*rest, Pow(inside, S.Half, evaluate=False), evaluate=False)


def is_half_power(factor: Expr) -> bool:
    """Whether a factor is a root or one over a root."""
    return bool(factor.is_Pow and factor.exp.is_Rational and abs(factor.exp) == S.Half)
