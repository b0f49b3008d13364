"""The command `derive`, which `python -m derive` runs, too."""

import os
import signal


def main() -> None:
    """Run the command, with the solvers as plain Python.

    While its modules are loaded, Ctrl-C ends the process without a word."""
    # Its commands call each solver only a few times, and compiling one takes longer than that.
    os.environ["NUMBA_DISABLE_JIT"] = "1"
    before = signal.getsignal(signal.SIGINT)
    if before is signal.default_int_handler:  # else Ctrl-C is ignored, as in the background
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    from derive.command.cli import main as command

    signal.signal(signal.SIGINT, before)
    command()


if __name__ == "__main__":
    main()
