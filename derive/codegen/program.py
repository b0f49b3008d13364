"""What a generated function computes, before it is text: named steps, then its outputs."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace

from sympy import Expr, Symbol, UnevaluatedExpr


class Kept(UnevaluatedExpr):
    """An expression that SymPy neither opens nor reorders; as real and as positive as it is."""

    def _eval_is_extended_real(self) -> bool | None:
        return self.args[0].is_extended_real

    def _eval_is_extended_positive(self) -> bool | None:
        return self.args[0].is_extended_positive


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

    def mapped(self, change: Callable[[Expr], Expr]) -> "Program":
        """The program with `change` applied to every expression."""
        return replace(
            self,
            outputs={name: change(expr) for name, expr in self.outputs.items()},
            steps=tuple(replace(s, expr=change(s.expr)) for s in self.steps),
        )

    def with_steps(self, *steps: Step) -> "Program":
        """The program with more steps; every expression equal to one of them refers to it."""
        program = self
        for step in steps:
            program = program.mapped(lambda expr, s=step: expr.xreplace({s.expr: s.symbol}))  # type: ignore[misc]
            program = replace(program, steps=(*program.steps, step))
        return program

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

    def renamed(self, taken: Iterable[str]) -> "Program":
        """The program without a step that bears one of the names `taken`."""
        names = set(taken)
        table = {
            s.symbol: Symbol(f"{s.symbol}_", **s.symbol.assumptions0)
            for s in self.steps
            if str(s.symbol) in names
        }
        program = self.mapped(lambda expr: expr.xreplace(table))
        steps = (replace(s, symbol=table.get(s.symbol, s.symbol)) for s in program.steps)
        return replace(program, steps=tuple(steps))

    def flat(self) -> dict[str, Expr]:
        """The outputs with every step written in."""
        table = {s.symbol: s.expr for s in self.steps}

        def written_in(expr: Expr) -> Expr:
            while held := expr.free_symbols & table.keys():
                expr = expr.xreplace({symbol: table[symbol] for symbol in held})
            return expr

        return {name: written_in(expr) for name, expr in self.outputs.items()}
