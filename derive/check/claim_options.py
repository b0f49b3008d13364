"""Read the entries of a claim beside its equation.

In:   the entries of a claim, its context, and the meanings of its symbols.
Out:  typed values for the data class Claim: its limit, conditions, ranges, points and the like.
"""

from collections.abc import Mapping

from sympy import Expr, Limit, Rational, Symbol, false, true
from sympy.logic.boolalg import Boolean

from derive.check.claim import Range, Rounded, Verdict
from derive.check.context import Context, Meant, Put, calls_in, integrals
from derive.check.entries import Entries
from derive.check.meanings import names_of
from derive.check.variables import is_bound
from derive.command.errors import BadFormula
from derive.reading.formula import Names, approach, condition, equation, rounded_in
from derive.reading.improper import IMPROPER


def expected(claim: Entries) -> Verdict | None:
    """Return the verdict that a person has reviewed, if there is one."""
    if "expected" not in claim.data:
        return None
    given = claim.data["expected"]
    try:
        return Verdict(given)
    except ValueError:
        why = f"expected = {given!r} is not a verdict"
        raise claim.place.bad(why, f"write one of {', '.join(Verdict)}") from None


def toward(claim: Entries, context: Context, meant: Meant) -> tuple[Expr, Expr] | None:
    """Return the expression that tends to an end, and this end, in our variables."""
    if "as" not in claim.data:
        return None
    names = names_of(claim.place.inside("as"), context, [s.name for s in meant.ours])
    first, end = approach(claim.text("as"), names)
    return context.put_in(first.xreplace(meant.ours)), context.put_in(end.xreplace(meant.ours))


def order(claim: Entries) -> float | None:
    """Return the order of the difference of the two sides, if it is given."""
    given = claim.data.get("order")
    if given is not None and (type(given) not in (int, float) or "as" not in claim.data):
        why = f"`order` = {given!r} is not a number, or `as` is missing"
        raise claim.place.bad(why, "give `order` as a number, together with `as`")
    return None if given is None else float(given)


def conditions(
    claim: Entries,
    sides: tuple[Expr, Expr],
    context: Context,
    meant: Meant,
    held: set[Symbol],
) -> tuple[Boolean, ...]:
    """Return the conditions of the formulas that are called, and those of the claim."""
    found, bound = set[Boolean](), set[Symbol]()
    for side in sides:
        written = side.xreplace(meant.written)
        found |= set(context.conditions(written))
        bound |= {over.limits[-1][0] for over in integrals(written)}
        bound |= {each.args[1] for each in written.atoms(Limit)}
    one = isinstance(claim.data.get("require"), str)
    listed = (claim.text("require"),) if one else claim.texts("require")
    names = names_of(claim.place.inside("require"), context, [s.name for s in meant.ours])
    for text in listed:
        found.add(condition(text, names).xreplace(meant.ours))
    inside = bound - held
    kept = [each for each in found if each != true and not each.free_symbols & inside]
    if false in found:
        remedy = "correct `require`, or the arguments of the formulas that are called"
        raise claim.place.bad("its conditions are never satisfied", remedy)
    return tuple(sorted(kept, key=str))


def ranges(claim: Entries, context: Context) -> dict[Symbol, Range]:
    """Return the ranges of variables in one claim."""
    found = dict[Symbol, Range]()
    place = claim.place.inside("ranges")
    for name, ends in claim.table("ranges").items():
        symbol = context.variables.get(name)
        if not isinstance(symbol, Symbol):
            raise place.bad(f"{name!r} is not a variable", "declare it")
        if not (isinstance(ends, list) and len(ends) == 2 and all(map(is_bound, ends))):
            why = f"{name} does not have two ends"
            raise place.bad(why, "write two numbers, such as [0.1, 0.9]")
        if ends[0] >= ends[1] or (symbol.is_positive and ends[0] < 0):
            remedy = "write the lower end first, and none below zero for a positive variable"
            raise place.bad(f"{ends} is not a range of {name}", remedy)
        found[symbol] = Range(float(ends[0]), float(ends[1]))
    return found


def cases(claim: Entries, context: Context) -> tuple[Mapping[Symbol, str], ...]:
    """Return the points that a claim prescribes."""
    made = []
    for each in claim.tables("cases", "[{ l = 1 }]"):
        for name, value in each.items():
            if not isinstance(context.variables.get(name), Symbol) or not is_bound(value):
                why = f"cases: {name} = {value!r} does not give a number to a variable of the claim"
                raise claim.place.bad(why, "give numbers to variables, such as [{ l = 1 }]")
        made.append({context.variables[name]: str(value) for name, value in each.items()})
    return tuple(made)


def swaps(claim: Entries, named: set[Symbol], context: Context, meant: Meant) -> tuple[Symbol, ...]:
    """Return the names that may have been confused, by default all names in the equation."""
    if "swaps" not in claim.data:
        defined = [s for s in meant.ours if s in named]
        return (*defined, *sorted(named - set(defined), key=str))
    chosen = claim.texts("swaps")
    symbols = {**context.variables, **{s.name: s for s in meant.ours}}
    for name in chosen:
        if not isinstance(symbols.get(name), Symbol):
            raise claim.place.bad(f"swaps: {name!r} is not a symbol", "declare it")
    return tuple(symbols[name] for name in chosen)


def names_in(*sides: Expr) -> set[Symbol]:
    """Return the names in an equation, except the variables of integrals and limits."""
    along = {over.limits[-1][0] for over in integrals(*sides)}
    along |= {each.args[1] for side in sides for each in side.atoms(Limit, *IMPROPER)}
    return set().union(*(side.atoms(Symbol) for side in sides)) - along


def reading(names: Names, put: Put, text: str) -> tuple[Expr, Expr] | None:
    """Read an equation with the same calls as the printed one; None if it has others."""
    try:
        left, _, right = equation(text, names, rough=True)
    except BadFormula:
        return None
    left, right = put.without_calls(left), put.without_calls(right)
    return None if calls_in(left, right) else (left, right)


def rounded(text: str, names: Names) -> Rounded | None:
    """Return the rounded constant that is a factor of a side, if there is exactly one."""
    found = rounded_in(text)
    if len(found) != 1:
        return None
    (one,) = found
    constant = Symbol("constant", positive=True)
    replaced = f"{text[: one.start()]}constant{text[one.end() :]}"
    known = Names(names.where, {**names.symbols, "constant": constant}, names.calls)
    left, _, right = equation(replaced, known, rough=True)
    power = (right / left).as_independent(constant)[1].as_base_exp()
    if power[0] != constant or power[1] not in (1, -1):
        return None
    half = Rational(5, 10 ** (len(one[0].partition(".")[2]) + 1))
    return Rounded(Rational(one[0]), half, int(power[1]))
