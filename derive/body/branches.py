"""Resolve the branches of g(x): the points where its formula changes, and the pieces between them.

In:  a SymPy expression of x and positive parameters, with any nesting of Abs, sign, Max, Min,
     Heaviside and Piecewise.
Out: its pieces, without these functions.

Each of these functions is read as cases, a value and a condition each, like those of a Piecewise.
"""

from itertools import pairwise

from sympy import (
    Abs,
    And,
    Dummy,
    Expr,
    Heaviside,
    Integer,
    Max,
    Min,
    Mul,
    Not,
    Or,
    Piecewise,
    Poly,
    Pow,
    S,
    diff,
    expand,
    expand_power_base,
    factor,
    fraction,
    oo,
    roots,
    sign,
    simplify,
    sqf,
    together,
)
from sympy.core.relational import Relational
from sympy.logic.boolalg import Boolean

from derive.body.piece import Piece
from derive.body.steep import gently
from derive.command.errors import BadProfile
from derive.symbols import x

BRANCHING = (Abs, sign, Max, Min, Heaviside, Piecewise)


def resolved(name: str, g: Expr, lower: Expr, upper: Expr) -> list[Piece]:
    """Split (lower, upper) where the innermost branch of g switches, and repeat for each part."""
    g = _with_moduli(g)
    inner = _innermost(g)
    if inner is None:
        g = expand(g)
        inner = _innermost(g)  # (x**2 cosh(x/b))**k becomes Abs(x)**(2 k) cosh(x/b)**k
    if inner is None:
        return [Piece(lower, upper, g)]
    cases = _cases(inner)
    points = [lower, *_between(name, _switching_points(name, cases), lower, upper), upper]
    pieces = []
    for left, right in pairwise(points):
        value = _value(name, cases, left, right)
        pieces += resolved(name, g.xreplace({inner: value}), left, right)
    return pieces


def _with_moduli(g: Expr) -> Expr:
    """Write roots of squares, which hide kinks, as moduli: sqrt(x**2 - 2*b*x + b**2) is Abs(x - b).

    SymPy does so when the square stands alone.
    """
    powers = [p for p in g.atoms(Pow) if not p.exp.is_Integer and p.base.is_rational_function(x)]
    found: dict[Expr, Expr] = {}
    for power in powers:
        if power.base.has(x) and not power.exp.has(x):
            over, under = (sqf(side, x) for side in fraction(together(power.base)))
            if any(part.is_Pow and part.has(x) for part in Mul.make_args(over * under)):
                found[power] = expand_power_base((over / under) ** power.exp)
    return g.xreplace(found)


def _innermost(g: Expr) -> Expr | None:
    found = [node for node in g.atoms(*BRANCHING) if node.has(x)]
    simple = [n for n in found if not any(n is not other and n.has(other) for other in found)]
    return min(simple, key=str, default=None)


def _cases(node: Expr) -> list[tuple[Expr, Boolean]]:
    """The values of a branching function, each with its condition; the first that holds counts."""
    if isinstance(node, Piecewise):
        return [*node.args]
    given = {Dummy(real=True): arg for arg in node.args}
    cases = node.func(*given).rewrite(Piecewise).args
    return [(value.xreplace(given), condition.xreplace(given)) for value, condition in cases]


def _switching_points(name: str, cases: list[tuple[Expr, Boolean]]) -> list[Expr]:
    """Points where a condition may begin or cease to hold."""
    points: list[Expr] = []
    relations = [sorted(condition.atoms(Relational), key=str) for _, condition in cases]
    for relation in dict.fromkeys(each for found in relations for each in found):
        argument = relation.lhs - relation.rhs
        if not argument.has(x):
            continue
        if not argument.is_polynomial(x):
            raise BadProfile(
                name,
                f"switches branches with {argument}, which is not a polynomial in x",
                "in conditions and in Abs, Max, Min, sign, Heaviside, use only polynomials in x, "
                "such as x - b",
            )
        points += _roots(name, Poly(argument, x))
    return list(dict.fromkeys(points))


def _roots(name: str, poly: Poly) -> list[Expr]:
    """All real roots; raises an error if any of them is not known."""
    found = roots(poly)
    remedy = "write each branch with Abs(x - b), Max(0, x - b) or a condition such as x < b"
    at_origin = sum(times for root, times in found.items() if root == 0)
    lowest = min(power for (power,), _ in poly.terms())
    if sum(found.values()) < poly.degree() or at_origin != lowest:  # roots near 1e-30 are not zero
        why = (
            f"switches branches where {poly.as_expr()} changes sign, but the x at which it does so "
            "cannot be found"
        )
        raise BadProfile(name, why, remedy)
    for root in found:
        if root.is_real is None:
            numerator, denominator = fraction(simplify(root))
            if numerator.is_real and denominator.is_real and not denominator.is_nonzero:
                why = f"the sign of {denominator} depends on the parameters"
                raise BadProfile(
                    name, f"has a kink at x = {simplify(root)}, but {why}", _order(denominator)
                )
            why = f"has a kink at x = {simplify(root)}, which is real only for some parameters"
            raise BadProfile(name, why, remedy)
    return [simplify(root) for root in found if root.is_real]


def _between(name: str, points: list[Expr], lower: Expr, upper: Expr) -> list[Expr]:
    inside: list[Expr] = []
    for point in points:
        left = lower == -oo or is_positive(name, point - lower)
        right = upper == oo or is_positive(name, upper - point)
        if left and right:
            place = next(
                (i for i, other in enumerate(inside) if is_positive(name, other - point)),
                len(inside),
            )
            inside.insert(place, point)
    return inside


def is_positive(name: str, difference: Expr) -> bool:
    """Whether a difference is positive; refused if this depends on the parameters."""
    found = is_known_positive(difference)
    if found is None:
        difference = simplify(difference)
        raise BadProfile(
            name,
            f"has kinks in an unknown order, as the sign of {difference} depends on the parameters",
            _order(difference),
        )
    return found


def is_known_positive(difference: Expr) -> bool | None:
    """Whether a difference is positive; None if this depends on the parameters."""
    difference = simplify(difference)
    if difference.is_extended_positive:
        return True
    if difference.is_extended_nonpositive:
        return False
    squares = _squares(difference)
    if squares is not None and squares.is_extended_nonzero:
        return bool(squares.is_extended_positive)
    return None


def _squares(difference: Expr) -> Expr | None:
    """+-(p^2 - q^2 r), which has the sign of p + q sqrt(r), if exactly one of the two terms is
    negative.

    None if there are several roots of sums, or if signs are not known.
    """
    roots = [p for p in difference.atoms(Pow) if p.exp == S.Half and p.base.is_Add]
    if len(roots) != 1:
        return None
    inner = Dummy("r", positive=True)
    numerator, denominator = fraction(together(difference).xreplace({roots[0]: inner}))
    if denominator.has(inner) or not numerator.is_polynomial(inner):
        return None
    poly = Poly(numerator, inner)
    if poly.degree() != 1:
        return None
    outer, beside = poly.nth(1), poly.nth(0)
    if not denominator.is_positive or not (outer * beside).is_negative:
        return None
    return factor((beside**2 - outer**2 * roots[0].base) * (1 if beside.is_positive else -1))


def _order(difference: Expr) -> str:
    """The advice to a user who must fix the sign of a difference."""
    held = {symbol.name for symbol in difference.free_symbols}
    gap = next(word for word in ("gap", "excess", "further") if word not in held)
    for symbol in sorted(difference.free_symbols, key=str, reverse=True):
        rate = diff(difference, symbol)
        if rate.is_number:
            other = expand(symbol - difference / rate)
            return (
                f"fix this sign with a new positive parameter {gap}, for example by writing "
                f"{symbol} = {other} + {gap}"
            )
    return f"fix this sign by writing one term as another plus a new positive parameter {gap}"


def _in_between(expr: Expr, lower: Expr, upper: Expr) -> Expr:
    """A number with the sign that a polynomial without roots between two points has there.

    This is the leading coefficient if an end is infinite, otherwise the value in the middle.  No
    length is compared with 1 m.
    """
    if not expr.has(x) or (lower == -oo and upper == oo):
        return simplify(expr.subs(x, 0))
    if lower.is_finite and upper.is_finite:
        return simplify(expr.subs(x, (lower + upper) / 2))
    return simplify(Poly(expr if upper == oo else expr.subs(x, -x), x).LC())


def _value(name: str, cases: list[tuple[Expr, Boolean]], lower: Expr, upper: Expr) -> Expr:
    """The value of a branching function between two points where no condition changes."""
    for value, condition in cases:
        if _holds(name, condition, lower, upper):
            return value
    middle = (lower + upper) / 2 if lower.is_finite and upper.is_finite else None
    if middle is None:
        middle = lower + 1 if lower.is_finite else upper - 1 if upper.is_finite else Integer(0)
    why, remedy = f"is not defined near x = {middle}", "end the Piecewise with (expression, True)"
    raise BadProfile(name, why, remedy)


def _holds(name: str, condition: Boolean, lower: Expr, upper: Expr) -> bool:
    if condition in (S.true, S.false):
        return bool(condition)
    match condition:
        case Not():
            return not _holds(name, condition.args[0], lower, upper)
        case And():
            return all(_holds(name, part, lower, upper) for part in condition.args)
        case Or():
            return any(_holds(name, part, lower, upper) for part in condition.args)
        case Relational():
            value = _in_between(condition.lhs - condition.rhs, lower, upper)
            known = 0 if value == 0 else 1 if is_positive(name, value) else -1
            return bool(condition.func(known, 0))
    why = f"uses the condition {condition}, which is not supported"
    raise BadProfile(name, why, "use <, <=, > or >=, combined with and, or, not")


def merged(pieces: list[Piece]) -> list[Piece]:
    """The pieces, with neighbours joined that have the same formula."""
    found = pieces[:1]
    for piece in pieces[1:]:
        last = found[-1]
        if gently(simplify, piece.profile - last.profile) == 0:
            found[-1] = Piece(last.lower, piece.upper, last.profile)
        else:
            found.append(piece)
    return found
