"""Prints the functions of a body that the runtime solves: from contacts to steady cycles.

In:  a proven FormulaSheet.
Out: the text of each function, by its name, from the template solved.txt.  Each passes the body,
     its parameters and its arguments on to the runtime.
"""

import math
from collections.abc import Mapping
from pathlib import Path
from string import Template

from derive.codegen.contract import CONTRACT, Function
from derive.codegen.example import example_of
from derive.codegen.function import constants_lines, demands_of, inside_quotes, meaning_of
from derive.proof.points import Point, numeric
from derive.sheet.formulas import FormulaSheet
from derive.symbols import E_star, a, c

TEMPLATE = Path(__file__).with_name("solved.txt")


def solved_functions(sheet: FormulaSheet) -> dict[str, str]:
    """The text of every function of the template, whose first text serves both contacts."""
    contact, *texts = TEMPLATE.read_text(encoding="utf-8").split("\n\n\n")
    values = {**_words(sheet), **_numbers(sheet)}
    contacts = (_of_contact(f, values) for f in CONTRACT if f.kind == "Contact")
    filled = [Template(contact).substitute(each) for each in contacts]
    filled += [Template(text).substitute(values) for text in texts]
    return {text.removeprefix("def ").partition("(")[0]: text for text in filled}


def _of_contact(function: Function, values: Mapping[str, str]) -> Mapping[str, str]:
    """What the template says of a contact under a load and a moment, or under a load at a tilt."""
    second = str(function.optional)
    by_moment = second == "M"
    names = ["load", "moment"] if by_moment else ["load"]
    return {
        **values,
        **{"name": function.name, "summary": function.summary, "second": second},
        "second_meaning": meaning_of(second),
        "given": values["moment" if by_moment else "alpha"],
        "equations": f"P = load(a, c), {'M = moment(a, c), ' * by_moment}alpha = tilt(a, c)",
        "carried_by": f'f"{", ".join(f"{{{name}(a, c, **law):.6g}}" for name in names)}"',
        "carries": repr(", ".join(values[name] for name in names)),
    }


def _words(sheet: FormulaSheet) -> Mapping[str, str]:
    """What the template says of arguments: types, meanings, how the body's own are passed on."""
    own = [q.symbol for q in sheet.geometry.parameters]
    names = ["E_star", *map(str, own)]
    typed = ", ".join(f"{symbol}: Values" for symbol in own)
    material = f"f: Values, E_star: Values, {typed}"
    contacts = "first: Contact, second: Contact, dQ: Values, dsigma: Values"
    words = {
        "typed": typed,
        "material": material,
        "half_cycle": f"{contacts}, *, {material}",
        "cycle": f"P: Values, M: Values, Q: Values, sigma: Values, *, {material}",
        "own": ", ".join(map(str, own)),
        "names": ", ".join(["f", *names]),
        "constants": inside_quotes("\n    ".join(constants_lines(sheet, ["f", *names]))),
        "elastic": inside_quotes("\n    ".join(constants_lines(sheet, names))),
        "demands": repr(demands_of(sheet)),
    }
    return words | {f"{name}_meaning": meaning_of(name) for name in ("P", "x", "dQ", "dsigma")}


def _numbers(sheet: FormulaSheet) -> Mapping[str, str]:
    """The numbers of the examples: a contact of simple numbers and what follows from it by hand.

    With f = 1/2, dQ/(2 f) is dQ.
    """
    point: Point = example_of(sheet, sheet["load"].conditions)
    names = ("load", "moment", "tilt", "K_N_left", "K_N_right")
    load, moment, alpha, *K_N = (float(numeric(sheet.flat(name))(point)) for name in names)
    edges = float(point[a]), float(point[c])
    dQ, h = float(f"{load / 8:.2g}"), sum(edges)
    constants = [E_star, *(q.symbol for q in sheet.geometry.parameters)]
    slip = [f"{2 * dQ / (math.pi * math.sqrt(h) * K):.6g}" for K in K_N]
    values = dict(load=load, moment=moment, alpha=alpha, reduced=load - dQ)
    values |= dict(threshold=8 * dQ / (math.pi * h), carried=float(f"{load:.6g}") - dQ)
    law = ", ".join(f"{s}={float(point[s])!r}" for s in constants)
    contact = ", ".join(map(repr, edges))
    examples = f"Examples\n    --------\n    >>> law = dict({law})"
    return {
        **{name: f"{value:.6g}" for name, value in values.items()},
        "examples": examples,
        "here": f"{examples}\n    >>> here = Contact({contact}, 0.0)",
        "edges": contact,
        "shear": repr(dQ),
        "slip": str(slip),
    }
