# Two commands do everything: `make paper` sets up and runs the main job, `make test` sets up and passes the tests.

PYTHON ?= python3
VENV ?= .venv
BIN = $(VENV)/bin
PIP = $(BIN)/python -m pip --disable-pip-version-check --quiet

# Python keeps the bytecode of what it imports, even where the environment forbids that: to make it anew takes ten seconds for each
# process of the tests, and five for each command that they start.
export PYTHONDONTWRITEBYTECODE :=

# Of tests with many cases some are run: the first ones, or those that a seed draws (see `--draw` in `pytest --help`).
DRAW ?= first

.PHONY: paper test test-week test-all browser lint compiled collected bench site oldest newest lock clean

paper: compiled
	$(BIN)/stickslip paper --out paper

# The tests run in as many processes as there are cores; threads of linear algebra would only compete with them. Before, the machine
# code of the engine is made, while what only tests need is installed, a browser is looked for, the bytecode of the tests is written,
# and the source is checked: in this order, and three at a time, because installation and browser wait for the network.
test:
	$(MAKE) --jobs=3 compiled browser collected lint
	OPENBLAS_NUM_THREADS=1 $(BIN)/python -m pytest --draw=$(DRAW) --numprocesses auto --dist worksteal

# The tests of `make test` with other cases each week; the seed that pytest prints repeats them: make test DRAW=2026-W48
test-week:
	$(MAKE) test DRAW=$$(date -u +%G-W%V)

# All tests: those of `make test`, and the slow ones: studies of many runs, all cases of tests that are sampled, eight times as many
# drawn examples, and all blocks of the pages. It takes hours, and the workflow of each week runs it.
test-all:
	$(MAKE) --jobs=3 compiled browser collected lint
	STICKSLIP_TESTS=all OPENBLAS_NUM_THREADS=1 $(BIN)/python -m pytest -q -m "" --numprocesses auto --dist worksteal

# The explorer is tested in a real browser; where none can be had, this says so and those tests are skipped.
browser: $(VENV)/.installed-test
	tests/extensions/explorer/install_browser.sh $(BIN)/python

lint: $(VENV)/.installed-test
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

compiled: $(VENV)/.installed
	$(BIN)/python -m stickslip.engine.build

collected: $(VENV)/.installed-test
	$(BIN)/python -m pytest -q --collect-only > /dev/null

bench: $(VENV)/.installed-test
	$(PIP) install -e ".[bench]"
	$(BIN)/python -m benchmarks.speed

# Pages, gallery and reference as a site that can be read offline: docs/_build/html/index.html. Warnings are errors, and every link
# within the site is checked. docs/site/browse_site.py opens every page in a browser, too.
site: $(VENV)/.installed-site
	$(BIN)/python -m sphinx -b html -q --fail-on-warning --keep-going docs docs/_build/html
	$(BIN)/python docs/site/check_site.py docs/_build/html

# Pinned installs, checked against hashes; the package itself last, without looking for anything newer, and without its machine code,
# which `compiled` makes. Python makes bytecode of a module when it is first imported: to make it of all modules now would take longer
# than the rest of the installation.
$(VENV)/.installed: requirements/run.txt pyproject.toml | $(BIN)/python
	$(PIP) install --no-compile --requirement requirements/run.txt
	STICKSLIP_MACHINE_CODE=later $(PIP) install --no-deps --no-build-isolation --editable .
	touch $@

$(VENV)/.installed-test: requirements/test.txt $(VENV)/.installed
	$(PIP) install --no-compile --requirement requirements/test.txt
	touch $@

$(VENV)/.installed-site: requirements/site.txt $(VENV)/.installed
	$(PIP) install --no-compile --requirement requirements/site.txt
	touch $@

$(BIN)/python:
	$(PYTHON) -m venv $(VENV)

# The lowest and the newest versions of libraries that pyproject.toml allows, each in an environment of its own, with `doctor` and the
# tests that depend on libraries most. Needs uv; run both before a release and when a bound changes.
MATTER = tests/core/engine/test_verified_numbers.py tests/extensions/sweeps/batch/test_members.py tests/core/figures/test_figures.py tests/extensions/sweeps/test_store.py \
    tests/core/solution/exports tests/core/solution/files tests/core/problem/scenarios tests/core/foundation/test_quantities.py tests/core/cli/test_commands.py tests/extensions/explorer/test_page_views.py
oldest: RESOLUTION = lowest-direct
oldest: OLD_WARNINGS = -W ignore::DeprecationWarning
newest: RESOLUTION = highest
oldest newest:
	uv venv --quiet --clear --python 3.11 .venv-$@
	VIRTUAL_ENV=.venv-$@ uv pip install --quiet --resolution $(RESOLUTION) --editable ".[test,explorer]"
	.venv-$@/bin/stickslip doctor
	OPENBLAS_NUM_THREADS=1 .venv-$@/bin/python -m pytest -q --numprocesses auto $(OLD_WARNINGS) $(MATTER)

# Needs uv; writes versions and hashes, no host.
lock:
	for extra in run test site; do \
	    uv pip compile --universal --python-version 3.11 --generate-hashes --no-header --no-annotate \
	        $$([ $$extra = run ] || echo --extra $$extra) pyproject.toml requirements/build.in --output-file requirements/$$extra.txt --quiet; \
	done

clean:
	rm -rf $(VENV) .venv-oldest .venv-newest src/stickslip/machine_code paper build dist docs/_build docs/gallery
