"""Words for docstrings: the sections that all functions share, and examples of bound functions."""

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from inspect import Parameter as Argument
from inspect import cleandoc, signature
from textwrap import fill
from typing import Any, NamedTuple, TypeVar

Function = TypeVar("Function", bound=Callable[..., Any])

COMPILING = "compiling the solver of this call, once per installation: up to a minute ..."
"""What a user reads while kernels are compiled."""

SAID: list[str] = []
"""This line, once it has been written for the solver that is being loaded."""

NO_NUMBER = "an argument is not a real number or an array of real numbers"
NO_CONTACT = (
    "a contact is not a Contact, or another argument is not a real number or an array of them"
)
NO_SHAPE = "the shapes of the arguments do not broadcast"
"""The errors of a function whose docstring lists no others."""

SHAPES = "Arguments broadcast; results are float64 of the broadcast shape."
"""The notes of a function whose docstring has none."""


class Parameter(NamedTuple):
    """A parameter of a body: its name, its meaning, its unit."""

    name: str
    meaning: str
    unit: str


def documented(*own: Parameter, **others: str) -> Callable[[Function], Function]:
    """Complete the docstring of a function of a body that has these parameters.

    The section for the arguments comes before that for the results; those for errors and notes
    follow it, unless the docstring has them already.

    others: meanings of arguments, in place of those in MEANINGS.
    """
    meanings = MEANINGS | others | {p.name: f"{p.meaning} [{p.unit}]" for p in own}

    def complete(function: Function) -> Function:
        title, *sections = re.split(r"\n\n(?=\w+\n---)", cleandoc(function.__doc__ or ""))
        found = {section.split("\n", 1)[0]: section for section in sections}
        arguments = signature(function).parameters.values()
        entries = _entries(function.__name__, arguments, meanings)
        found["Parameters"] = _section("Parameters", *entries)
        found.setdefault("Raises", _section("Raises", *_errors({a.name for a in arguments})))
        found.setdefault("Notes", _section("Notes", SHAPES))
        order = ("Parameters", "Returns", "Raises", "Notes", "Examples")
        function.__doc__ = "\n\n".join([title, *(found[n] for n in order if n in found)])
        return function

    return complete


def _section(title: str, *lines: str) -> str:
    return "\n".join([title, "-" * len(title), *lines])


def _entries(
    function: str, arguments: Iterable[Argument], meanings: Mapping[str, str]
) -> Iterator[str]:
    """The lines about the arguments of a function."""
    meanings = {**meanings, **OTHERWISE.get(function, {})}
    for a in arguments:
        optional = "" if a.default is a.empty else ", optional"
        yield f"{a.name} : {TYPES.get(a.name, 'array_like')}{optional}"
        yield _indented(sentence(" ".join(meanings[a.name].split())))


def _errors(names: set[str]) -> Iterator[str]:
    """The lines about the errors of a function with arguments of these names."""
    wrong = NO_CONTACT if names & {"contact", "first"} else NO_NUMBER
    ordered = "order" in names
    yield "TypeError"
    yield _indented(f"If {wrong}{', or the order is not a whole number' * ordered}.")
    yield "ValueError"
    yield _indented(f"If {NO_SHAPE}{', or the order is not one that is allowed' * ordered}.")


def _indented(text: str) -> str:
    return fill(text, 100, initial_indent="    ", subsequent_indent="    ")


def sentence(words: str) -> str:
    """A phrase with a full stop, and a capital letter unless it begins with a name.

    >>> sentence("half-width"), sentence("dQ falls"), sentence("E*, say")
    ('Half-width.', 'dQ falls.', 'E*, say.')
    """
    first = words.split(maxsplit=1)[0].rstrip(",;").replace("-", "") if words.split() else ""
    capital = words[:1].upper() if first.isalpha() and first.islower() else words[:1]
    return f"{capital}{words[1:]}."


MEANINGS = {
    "P": "normal load per unit depth [N/m]",
    "M": "moment per unit depth, M = -int p x dx [N]",
    "Q": "shear load at every instant [N/m]",
    "a": "left edge of the contact at x = -a [m]",
    "alpha": "tilt, positive anticlockwise: the slope in contact is g'(x) + alpha [rad]",
    "c": "right edge of the contact at x = c [m]",
    "contact": "Contact under the constant normal loads",
    "dM": "change in the moment over the same half-cycle [N]",
    "dP": "change in the normal load over the same half-cycle [N/m]",
    "dQ": "change in the shear load over the half-cycle that raises it [N/m]",
    "da": "how much further out the left edge is than at the other end of the half-cycle [m]",
    "dc": "how much further out the right edge is than at the other end [m]",
    "dsigma": "change in the differential bulk tension over the same half-cycle [Pa]",
    "f": "coefficient of friction [-]",
    "first": "Contact at the start of the half-cycle that raises the shear load",
    "mixed": "whether to also solve cycles in which slip reverses, to 1e-7 of the contact width",
    "order": "order of the series: 1, 2 or 3",
    "second": "Contact at the end of that half-cycle; equal to first for constant normal loads",
    "sigma": "differential bulk tension at every instant [Pa]",
    "tol": "target error: m and n relative to a + c; in a history, also shear relative to "
    "f P/(a + c)",
    "x": "position along the interface, positive to the right [m]",
    "E_star": "composite modulus, 1/E* = 2 (1 - nu^2)/E for similar bodies in plane strain [Pa]",
}
"""Meaning of each argument."""

TYPES = {
    **dict.fromkeys(("contact", "first", "second"), "Contact"),
    **{"back": "bool", "mixed": "bool", "order": "int", "tol": "float"},
}
"""Types of the arguments that are not arrays of numbers."""

OTHERWISE = {
    "shear": {
        "Q": "shear load reached in the first loading [N/m]",
        "sigma": "differential bulk tension reached together with Q [Pa]",
        "dQ": "decrease in the shear load since then [N/m]",
        "dsigma": "decrease in the tension since then [Pa]",
    },
    "history": {"x": "positions at which to return shear and slip; none unless given [m]"},
    "steady_cycle": {"x": "positions at which to return shear and slip; none unless given [m]"},
    "march": {"order": "order of the series; 0 for the exact conditions"},
    "slip_error": {"order": "order of the series: 1 or 2"},
}
"""Meanings that apply to a single function only."""

_HERE = """\
>>> law = dict({law})
>>> here = Contact({edges}, 0.0)
"""

_LAW = """\
>>> law = dict({law})
"""

EXAMPLES = {
    "contact": f"""\
{_LAW}>>> a, c, alpha = contact({{load}}, {{moment}}, **law)
>>> f"{{{{load(a, c, **law):.6g}}}}, {{{{moment(a, c, **law):.6g}}}}"
'{{load}}, {{moment}}'""",
    "contact_at_tilt": f"""\
{_LAW}>>> a, c, alpha = contact_at_tilt({{load}}, {{alpha}}, **law)
>>> f"{{{{load(a, c, **law):.6g}}}}"
'{{load}}'""",
    "stick_zone": f"""\
{_HERE}>>> zone = stick_zone(here, here, {{dQ}}, 0.0, f=0.5, **law)
>>> Regime(zone.regime).name
'MODERATE'
>>> f"{{{{load(zone.m, zone.n, **law):.6g}}}}"  # P - dQ/(2 f)
'{{reduced}}'""",
    "why": f"""\
{_HERE}>>> why(here, here, -1.0, 0.0, f=0.5, **law)
'dQ = -1 is negative: pass the half-cycle that raises the shear load'""",
    "tension_threshold": f"""\
{_HERE}>>> lower, upper = tension_threshold(here, here, {{dQ}}, f=0.5, **law)
>>> f"{{{{upper:.6g}}}}"  # 8 dQ/(pi (a + c))
'{{threshold}}'""",
    "closing_tension": f"""\
{_HERE}>>> lower, upper = closing_tension(here, here, {{dQ}}, f=0.5, **law)
>>> bool(lower < 0 < upper)
True""",
    "slip_zones": f"""\
{_LAW}>>> d = slip_zones({{edges}}, {{dQ}}, 0.0, f=0.5, **law)
>>> [f"{{{{v:.6g}}}}" for v in d]  # dQ/(pi f sqrt(a + c) K_N)
{{slip}}""",
    "slip_error": f"""\
{_LAW}>>> error = slip_error({{edges}}, {{dQ}}, 0.0, f=0.5, **law)
>>> bool(error.left > 0)
True""",
    "shear_change": f"""\
{_HERE}>>> float(shear_change(here.c + 1.0, here, here, {{dQ}}, 0.0, f=0.5, **law))
0.0""",
    "shear": f"""\
{_HERE}>>> law |= dict(f=0.5)
>>> upper, lower = (shear(0.1, here, {{dQ}}, 0.0, dQ=fall, **law) for fall in (0.0, 2 * {{dQ}}))
>>> bool(abs(upper + lower) < 1e-12 * abs(upper))  # a cycle between Q and -Q
True""",
    "slip_range": f"""\
{_HERE}>>> zone = stick_zone(here, here, {{dQ}}, 0.0, f=0.5, **law)
>>> float(slip_range(zone.n, here, here, {{dQ}}, 0.0, f=0.5, **law))
0.0""",
    "history": f"""\
{_LAW}>>> P, M = (of({{edges}}, **law) for of in (load, moment))
>>> states = history(P, M, np.array([0.0, 1.0, -1.0]) * {{dQ}} / 2, 0.0, f=0.5, **law)
>>> [Regime(code).name for code in states.regime]
['FULL_STICK', 'MODERATE', 'MODERATE']""",
    "steady_cycle": f"""\
{_LAW}>>> P, M = (of({{edges}}, **law) for of in (load, moment))
>>> steady = steady_cycle(P, M, np.array([0.0, 1.0, 0.0, -1.0]) * {{dQ}} / 2, 0.0, f=0.5, **law)
>>> f"{{{{load(steady.m, steady.n, **law):.6g}}}}"  # P - dQ/(2 f)
'{{reduced}}'""",
    "march": f"""\
{_LAW}>>> P, M = (of({{edges}}, **law) for of in (load, moment))
>>> Q = np.array([0.0, 1.0, 0.0, -1.0]) * {{dQ}} / 2
>>> cycle = march(P, M, Q, 0.0, f=0.5, **law)
>>> cycle.left.tolist()
[1, 1, -1, -1]""",
}
"""An example of each function; each body fills in its numbers."""
