"""Runs every notebook in place: `python -m notebooks [WORD ...]`."""

import sys

from notebooks.running import main

sys.exit(main(sys.argv[1:]))
