# make        derives and proves every geometry, regenerates generated/, checks the paper
# make test   lint, types, tests: the drift check of generated/ included
# make quick  the tests that do not take long
# make thorough  all tests: more bodies, cases and points than make test takes
# make mutants  a hundred faults in each of four parts: which no test catches; hours, or an hour
#             for one part: make mutants GROUP=theory, check, proof or runtime
# make bench  speed, all figures of one run: docs/performance.md; some minutes, on two idle cores;
#             bench-monte-carlo: time and memory of the Monte Carlo of examples/, to 1e8 samples:
#             notebooks/monte_carlo.md
# make solver    what the independent solver finds: tests/reference/FINDINGS.md; ten minutes on
#             two cores
# make comparison  that solver, exact conditions and series, cycle by cycle: notebooks/comparison.md
# make series    errors of the series of the slip zones, order by order: notebooks/series.md
# make accuracy  worst relative error of every generated function, and which bounds are met:
#             docs/accuracy.md, some minutes
# make notebooks runs all notebooks in place, some two minutes; make lab opens them in Jupyter
# make picture   draws the README's picture
# make docs      the documentation, with the handbook of bodies: build/docs/index.html

PYTHON ?= python3
VENV   := .venv
BIN    := $(VENV)/bin
STAMP  := $(VENV)/.installed
PYTEST := OMP_NUM_THREADS=1 $(BIN)/python -m pytest -n auto --dist worksteal

.PHONY: all test quick thorough mutants bench bench-monte-carlo series solver comparison accuracy notebooks \
	lab picture docs clean

all: $(STAMP)
	$(BIN)/derive generate
	mkdir -p build
	$(BIN)/derive check --html build/paper.html

test: $(STAMP)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(PYTEST)

quick: $(STAMP)
	$(PYTEST) -m "not slow and not thorough"

thorough: $(STAMP)
	$(PYTEST) -m ''

mutants: $(STAMP)
	OMP_NUM_THREADS=1 $(BIN)/python -m tests.mutants $(or $(GROUP),all)

bench: $(STAMP)
	OMP_NUM_THREADS=1 $(BIN)/python -m tests.measure.benchmarks.speed

bench-monte-carlo: $(STAMP)
	OMP_NUM_THREADS=1 $(BIN)/python -m tests.measure.benchmarks.monte_carlo

series: $(STAMP)
	$(BIN)/python -m tests.measure.benchmarks.series

solver: $(STAMP)
	OMP_NUM_THREADS=1 $(BIN)/python -m tests.measure.solver

comparison: $(STAMP)
	OMP_NUM_THREADS=1 $(BIN)/python -m tests.measure.comparison

accuracy: $(STAMP)
	$(BIN)/python -m tests.measure.accuracy.report

notebooks: $(STAMP)
	$(BIN)/python -m notebooks

lab: $(STAMP)
	$(BIN)/pip install --quiet --disable-pip-version-check -c constraints.txt -e '.[notebooks]'
	$(BIN)/jupyter lab notebooks

picture: $(STAMP)
	$(BIN)/python -m notebooks.picture

docs: $(STAMP)
	$(BIN)/pip install --quiet --disable-pip-version-check -c constraints.txt -e '.[docs]'
	$(BIN)/python docs/site/pages.py build/site
	$(BIN)/python -m sphinx -W --keep-going -q -b html build/site build/docs

$(STAMP): pyproject.toml constraints.txt
	$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "Python 3.11 or later is needed; make PYTHON=python3.12, say")'
	$(PYTHON) -m venv $(VENV)
	$(BIN)/pip install --quiet --disable-pip-version-check -c constraints.txt -e '.[tests]'
	touch $@

clean:
	rm -rf $(VENV) build *.egg-info .pytest_cache .mypy_cache .ruff_cache .hypothesis
