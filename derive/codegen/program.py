"""The steps and outputs of a generated function, before they are printed as text."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace

from sympy import Expr, Symbol

from derive.theory.parts import Definition

LEAST, MOST = Symbol("LEAST", positive=True), Symbol("MOST", positive=True)
"""The shortest and the longest length whose products stay well inside float64."""


@dataclass(frozen=True)
class Common:
    """What the functions of a body have in common, and state once in its module.

    arguments  of the function that computes the steps
    steps      that all functions need
    checks     the conditions of all functions, as code
    defined    what several functions print
    """

    arguments: tuple[str, ...] = ()
    steps: tuple[Definition, ...] = ()
    checks: tuple[str, ...] = ()
    defined: Mapping[Expr, Expr] = field(default_factory=dict)

    @property
    def names(self) -> list[str]:
        """The names of the results of that function."""
        return ["exists", *(str(step.symbol) for step in self.steps)]


@dataclass(frozen=True)
class Program:
    """The steps in the order of evaluation, and one expression for each output."""

    outputs: Mapping[str, Expr]
    steps: tuple[Definition, ...] = ()

    def mapped(self, change: Callable[[Expr], Expr]) -> "Program":
        """The program with `change` applied to every expression."""
        steps = tuple(replace(s, expr=change(s.expr)) for s in self.steps)
        return replace(self.with_outputs(change), steps=steps)

    def with_outputs(self, change: Callable[[Expr], Expr]) -> "Program":
        """The program with `change` applied to its outputs alone."""
        return replace(self, outputs={name: change(expr) for name, expr in self.outputs.items()})

    def with_steps(self, *steps: Definition) -> "Program":
        """The program with more steps, which replace their expressions wherever these occur."""
        program = self
        for step in steps:
            program = program.mapped(lambda expr, s=step: expr.xreplace({s.expr: s.symbol}))  # type: ignore[misc]
            program = replace(program, steps=(*program.steps, step))
        return program

    def ordered(self) -> "Program":
        """The program with only the steps that its outputs need, each after those it depends on."""
        by_symbol = {s.symbol: s for s in self.steps}
        done: dict[Symbol, Definition] = {}

        def visit(expr: Expr) -> None:
            for symbol in sorted(expr.free_symbols, key=str):
                if symbol in by_symbol and symbol not in done:
                    visit(by_symbol[symbol].expr)
                    done[symbol] = by_symbol[symbol]

        for expr in self.outputs.values():
            visit(expr)
        return replace(self, steps=tuple(done.values()))

    def renamed(self, taken: Iterable[str], read: Callable[[str], str] = str) -> "Program":
        """The program with a unique name for every step, none of them among `taken`.

        read: names that it gives alike are the same name
        """
        steps = {s.symbol for s in self.steps}
        symbols = set().union(*(expr.free_symbols for expr in self.exprs))
        used = {read(name) for name in (*taken, *(symbol.name for symbol in symbols - steps))}
        table = {}
        for step in self.steps:
            name = step.symbol.name
            while read(name) in used:
                name += "_"
            used.add(read(name))
            table[step.symbol] = Symbol(name, **step.symbol.assumptions0)
        program = self.mapped(lambda expr: expr.xreplace(table))
        return replace(
            program, steps=tuple(replace(s, symbol=table[s.symbol]) for s in program.steps)
        )

    @property
    def exprs(self) -> list[Expr]:
        """All expressions: the outputs, then the steps."""
        return [*self.outputs.values(), *(step.expr for step in self.steps)]
