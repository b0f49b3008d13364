"""What a generated function computes, before it is text: named steps, then its outputs."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

from sympy import Expr, Symbol


@dataclass(frozen=True)
class Step:
    """symbol = expr, with a few words for the reader."""

    symbol: Symbol
    expr: Expr
    meaning: str


@dataclass(frozen=True)
class Program:
    """Steps in the order of evaluation, and one expression per output."""

    outputs: Mapping[str, Expr]
    steps: tuple[Step, ...] = ()

    def mapped(self, change: object) -> "Program":
        """The program with `change` applied to every expression."""
        return replace(
            self,
            outputs={name: change(expr) for name, expr in self.outputs.items()},  # type: ignore[operator]
            steps=tuple(replace(s, expr=change(s.expr)) for s in self.steps),  # type: ignore[operator]
        )

    def with_step(self, step: Step) -> "Program":
        """The program with one more step, which every equal subexpression then uses."""
        if any(s.symbol == step.symbol for s in self.steps):
            return self
        used = self.mapped(lambda expr: expr.subs(step.expr, step.symbol))
        return replace(used, steps=(*used.steps, step))

    def ordered(self) -> "Program":
        """Only the steps that some output needs, each after those it needs itself."""
        by_symbol = {s.symbol: s for s in self.steps}
        done: dict[Symbol, Step] = {}

        def visit(expr: Expr) -> None:
            for symbol in sorted(expr.free_symbols, key=str):
                if symbol in by_symbol and symbol not in done:
                    visit(by_symbol[symbol].expr)
                    done[symbol] = by_symbol[symbol]

        for expr in self.outputs.values():
            visit(expr)
        return replace(self, steps=tuple(done.values()))

    def flat(self) -> dict[str, Expr]:
        """The outputs with every step written in."""
        table = {s.symbol: s.expr for s in self.steps}

        def written_in(expr: Expr) -> Expr:
            while held := expr.free_symbols & table.keys():
                expr = expr.xreplace({symbol: table[symbol] for symbol in held})
            return expr

        return {name: written_in(expr) for name, expr in self.outputs.items()}
