"""Run the notebooks in place: `python -m notebooks [--check] [WORD ...]`."""

import sys

from notebooks.running import main

sys.exit(main())
