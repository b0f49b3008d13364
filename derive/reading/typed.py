r"""Turn each rule of latex.lark into typed text, or refuse it.

A rule has a template here, or a method of the transformer.  A method refuses what is ambiguous.
"""

import re
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

from lark import Transformer, v_args

from derive.reading.lexer import Token, Unclear
from derive.reading.words import COMMANDS, FUNCTIONS

_TYPED = {
    **{"=": "=", "<": "<", ">": ">", r"\le": "<=", r"\ge": ">=", r"\sim": "~"},
    **{r"\pi": "pi", r"\infty": "oo", r"\lambda": "lam", r"\cdot": "*"},
    **{r"\int": "integral", r"\pvint": "pv"},
    **COMMANDS,
}
"""The typed text of relations, signs, constants and functions."""


_SINGLE = ("without braces, TeX takes only one character here", "use braces")
_LEVELS = {"": 0, "product": 1, "power": 2, "atom": 3}
_TEMPLATES = {
    "modulus": ("atom", "abs({1})"),
    "fraction": ("product", "{1:product}/{2:power}"),
    "over": ("product", "{1:product}/{3:power}"),
    "root": ("atom", "sqrt({1})"),
    "nth_root": ("power", "{2:atom}**(1/{1:power})"),
    "euler": ("atom", "exp(1)"),
    "exponential": ("atom", "exp({2})"),
    "equation": ("", "{0} {1} {2}"),
    "approach": ("", "{0} -> {2}"),
    "integral": ("atom", "{0}({2}, {4}, {1[0]}, {1[1]})"),
    "series": ("atom", "sum({7}, {2}, {4}, {6})"),
    "limit": ("atom", "limit({5}, {2}, {4})"),
}
"""The precedence and the typed text of rules, with the parts of the rule by their numbers."""
_TWO_RELATIONS = {"NE": "({0} < {2} or {0} > {2})", "EQUAL": "({0} <= {2} and {0} >= {2})"}
"""Conditions that are typed as two others."""
_FUNCTIONS = frozenset(("FUNC", "CIRCULAR"))
_AFTER_BRACKETS = _FUNCTIONS | {"OPERATOR", "FRAC", "SQRT"}
"""What may follow an argument whose end is shown by brackets or bars."""


@dataclass(frozen=True)
class _Code:
    """A piece of typed text.

    level    its precedence
    type     the terminal with which its last factor begins
    at       the place of this factor
    size     the number of tokens of a number or a symbol
    is_one   whether it is one factor
    slashed  whether a slash stands before its last factor
    follow   the terminals that may follow; None if any may
    unclear  two readings with anything else that follows, which stands for {}
    is_open  whether it ends with a sum or a limit, to which a further term may belong
    """

    text: str
    level: str
    type: str
    at: int
    size: int = 1
    is_one: bool = True
    slashed: bool = False
    follow: frozenset[str] | None = None
    unclear: tuple[str, str] = ("", "")
    is_open: bool = False

    def __format__(self, level: str) -> str:
        """Return the text for use at a level, in parentheses if they are needed."""
        return self.text if _LEVELS[self.level] >= _LEVELS[level] else f"({self.text})"

    def demand_end(self, at: int, kind: str, following: str) -> None:
        """Refuse what follows a function if it may belong to its argument."""
        if self.follow is not None and kind not in self.follow:
            raise _unclear_argument(at, *(each.format(following) for each in self.unclear))


Argument = tuple[str, str, str, int]
"""An argument of a function: how its end is shown, the first factor, the others, their place."""


@v_args(inline=True)
class _Typed(Transformer[Any, Any]):
    """The typed text of each rule of the grammar."""

    def __getattr__(self, rule: str) -> Callable[[list[Any]], _Code]:
        """Return what makes the typed text of a rule that has no method."""
        if rule in _TEMPLATES:
            return lambda parts: _from_template(rule, *parts)
        raise AttributeError(rule)

    def conditions(self, *parts: Any) -> str:
        joints = {each.type for each in parts if isinstance(each, Token)}
        texts = [each for each in parts if isinstance(each, str)]
        if "OR" in joints and len(joints) > 1:
            why = "some of these conditions are joined by `or`, and others by `and` or a comma"
            raise Unclear(parts[1].at, why, "write the condition as text")
        return (" or " if "OR" in joints else " and ").join(texts)

    def comparison(self, *parts: Any) -> str:
        relations = [each.type for each in parts[1::2]]
        if not relations or (len(relations) > 1 and {"NE", "EQUAL"} & {*relations}):
            raise Unclear(parts[0].at, "this is not a condition", "write a relation, such as x < a")
        if relations[0] in _TWO_RELATIONS:
            return _TWO_RELATIONS[relations[0]].format(*parts)
        return " ".join(typed(each) if isinstance(each, Token) else each.text for each in parts)

    # sums, products and powers

    def signed(self, sign: Token, term: _Code) -> _Code:
        if sign.text == "+":
            return term
        return replace(term, text=f"-{term:product}", level="", is_one=False)

    def added(self, left: _Code, sign: Token, term: _Code) -> _Code:
        if left.is_open:
            why = "it is unclear whether this belongs to the sum or limit before it"
            raise Unclear(sign.at, why, "use parentheses")
        text = f"{left} {sign.text} {term:product}"
        return replace(term, text=text, level="", is_one=False)

    def multiplied(self, left: _Code, operator: Token | None, right: _Code) -> _Code:
        at, kind = (operator.at, operator.type) if operator else (right.at, right.type)
        sign = typed(operator) if operator else "*"
        factor = f"{right:power}" if sign == "/" else f"{right:product}"
        left.demand_end(at, kind, f"{sign}{factor}")
        if left.slashed and not operator:
            why = "it is unclear whether this belongs to the denominator"
            raise Unclear(at, why, "write \\frac, or use parentheses")
        is_number = re.fullmatch(r"[\d./]+", right.text) and not operator
        if is_number and re.search(r"(?<![\w.])[\d.]+$", left.text):
            why = "two numbers stand side by side, which may mean a sum, as in 3 1/2"
            raise Unclear(at, why, "put \\cdot or + between them")
        slashed, text = left.slashed or sign == "/", f"{left:product}{sign}{factor}"
        return replace(right, text=text, level="product", is_one=False, slashed=slashed)

    def raised(self, base: _Code, power: Token, exponent: _Code) -> _Code:
        base.demand_end(power.at, "POWER", f"**{exponent:atom}")
        if base.text == "e" and not exponent.text.isdigit():
            why = "it is unclear whether e is a symbol here"
            remedy = "write \\exp(...) or \\mathrm{e}^{...}, or rename the symbol"
            raise Unclear(base.at, why, remedy)
        if base.type == "SYMBOL" and exponent.type == "(" and exponent.is_one:
            why = "it is unclear whether the parentheses hold an exponent or an index"
            raise Unclear(exponent.at, why, "write the exponent without them, or rename the symbol")
        return replace(base, text=f"{base:atom}**{exponent:atom}", level="power")

    # factors

    def mark(self, token: Token) -> _Code:
        return _Code(typed(token), "atom", token.type, token.at, token.size)

    def held(self, _: Token, code: _Code) -> _Code:
        return replace(code, size=1)

    def short(self, code: _Code) -> _Code:
        if code.size > 1:
            raise Unclear(code.at, *_SINGLE)
        return code

    def group(self, opening: Token, inner: _Code, _: Token) -> _Code:
        return _Code(inner.text, inner.level, "(", opening.at)

    def braces(self, brace: Token, inner: _Code) -> _Code:
        if not inner.is_one:
            why = "these braces group terms but are not printed"
            raise Unclear(brace.at, why, "use parentheses")
        return inner

    def integral_over(self, *parts: Any) -> _Code:
        sign, limits, before, bar, _, over, differential, along, under = parts
        over = over or _Code("1", "atom", "", bar.at)
        inside = _from_template("fraction", bar, over, under)
        if before:
            inside = self.multiplied(before, None, inside)
        return _from_template("integral", sign, limits, inside, differential, along)

    def limits(self, low: _Code, _: Token, high: _Code) -> tuple[_Code, _Code]:
        return low, high

    def cases(self, *parts: Any) -> _Code:
        rows = ", ".join(each for each in parts if isinstance(each, str))
        return _Code(f"Piecewise({rows})", "atom", "BEGIN", parts[0].at)

    def row(self, value: _Code, *rest: Any) -> str:
        return f"({value}, {rest[-1] if isinstance(rest[-1], str) else 'True'})"

    # functions

    def multiple(self, first: Token, *parts: Any) -> Argument:
        r"""Read 2x, \frac12 x or \frac{1}{2}(x + y) as one argument; a quotient may also end it."""
        kind = "group" if isinstance(parts[-1], _Code) else "multiple"
        factor, rest = typed(first), list(parts)
        if first.type == "FRAC":
            over, under, *rest = rest
            factor = f"{over:product}/{under:power}"
            kind = "group" if f"{over.text}{under.text}".isdigit() else "quotient"
        texts = (f"*{typed(e) if isinstance(e, Token) else f'{e:product}'}" for e in rest)
        return kind, factor, "".join(texts), rest[0].at

    def bare(self, code: _Code) -> Argument:
        kind = "nested" if code.type in _FUNCTIONS else "shown" if code.type == "LBAR" else "bare"
        return kind, code.text, "", code.at

    def bracketed(self, *parts: Any) -> Argument:
        return "shown", ", ".join(each.text for each in parts[::2]), "", parts[-1].at

    def braced(self, brace: Token, *parts: Any) -> Argument:
        if any(each.level == "" for each in parts[::2]):
            why = "braces are not printed, so the end of the argument is unclear"
            raise Unclear(brace.at, why, "use parentheses")
        return "bare", ", ".join(each.text for each in parts[::2]), "", parts[-1].at

    def function(self, command: Token, *parts: Any) -> _Code:
        base, power, exponent, (kind, inside, others, second) = parts
        name, digits = typed(command), exponent.text if exponent else ""
        if digits == "-1" and f"a{name}" in FUNCTIONS:
            name, power = f"a{name}", None
        is_power = not power or (digits.isdigit() and int(digits) > 1)
        if not is_power or (base and (power or command.text != r"\log")):
            why = f"this index or power of {command.text} is unclear"
            raise Unclear(command.at, why, "write \\arcsin, or a fraction, or use parentheses")
        if FUNCTIONS[name].most > 1 and ", " not in inside:
            why = f"it is unclear over what {command.text} of one quantity is taken"
            raise Unclear(command.at, why, "give it a symbol of its own, as in p_{\\max}")
        circular = command.type == "CIRCULAR"
        after = (f"**{digits}" if power else "") + (f"/log({base})" if base else "")
        may_end = kind == "quotient" or (kind == "group" and name.startswith("a")) or not circular
        if others and may_end:
            both = f"{name}({inside}{others}){after}", f"{name}({inside}){after}{others}"
            raise _unclear_argument(second, *both)
        inside += others
        level = "product" if base else "power" if power else "atom"
        follow = _FUNCTIONS if circular and kind != "nested" else frozenset[str]()
        follow = _AFTER_BRACKETS if kind == "shown" else follow
        within = f"({inside})" if kind == "shown" else inside
        unclear = f"{name}({within}{{}}){after}", f"{name}({inside}){after}{{}}"
        text = unclear[1].format("")
        return _Code(text, level, command.type, command.at, follow=follow, unclear=unclear)


def _unclear_argument(at: int, one: str, other: str) -> Unclear:
    why = f"the end of the function's argument is unclear: it may mean {one} or {other}"
    return Unclear(at, why, "put the function and its argument in parentheses, as in (\\sin(a)) b")


def _from_template(rule: str, *parts: Any) -> _Code:
    texts = [typed(each) if isinstance(each, Token) else each or "1" for each in parts]
    level, template = _TEMPLATES[rule]
    text, is_open = template.format(*texts), rule in ("series", "limit")
    return _Code(text, level, parts[0].type, parts[0].at, is_open=is_open)


def typed(token: Token) -> str:
    """Return the typed text of a token."""
    return _TYPED.get(token.text, token.text.removeprefix("\\"))


TYPED: Transformer[Any, Any] = _Typed()
"""What the parser calls for each rule."""
