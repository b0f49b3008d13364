"""The command `derive`, which `python -m derive` runs, too."""

import signal


def main() -> None:
    """Run the command.  While its modules are loaded, Ctrl-C ends the process without a word."""
    before = signal.getsignal(signal.SIGINT)
    if before is signal.default_int_handler:  # else Ctrl-C is ignored, as in the background
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    from derive.cli import main as command

    signal.signal(signal.SIGINT, before)
    command()


if __name__ == "__main__":
    main()
