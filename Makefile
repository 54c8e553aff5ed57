# `make help` lists the targets. Works with GNU make 4 and any POSIX sh.

PYTHON ?= python3
JOBS ?= auto
ARGS ?=

UV_VERSION := 0.13.9
STAMP := .venv/.installed
PIP := .venv/bin/python -m pip --disable-pip-version-check --quiet
# By file: tests of one file share the laws they compile, and two workers would each compile them on a cold cache.
PYTEST := .venv/bin/python -m pytest -n $(JOBS) --dist loadfile --durations 25 --durations-min 0.5

# An environment that was moved, copied or left half installed still runs, but not this working tree: make it anew.
INTACT := $(shell [ -x .venv/bin/python ] && [ ! -e .venv/.incomplete ] \
	&& grep -qsF "$$(pwd -P)/.venv/" .venv/bin/pip && echo yes)

.PHONY: help run test check slow bench mutants pages site lock clean FORCE
.DELETE_ON_ERROR:
.SUFFIXES:

help: ## list the targets (default)
	@echo 'armland: make TARGET [PYTHON=python3.12] [ARGS="..."]'
	@awk -F ': .*## ' '/^[a-z]+:.*## / { printf "  %-7s %s\n", $$1, $$2 }' Makefile

run: $(STAMP) ## land a UAV, with report and film; ARGS is passed to `armland land`
	@.venv/bin/armland land --film $(ARGS)

test: $(STAMP) ## run the checks: ruff, mypy, pytest without the slow tests; ARGS is passed to pytest
	.venv/bin/ruff check .
	.venv/bin/ruff format --check .
	.venv/bin/mypy --num-workers 2
	@# In two processes, before two workers of pytest compile the same.
	@.venv/bin/python -c 'from armland.cli.console import ready; ready()'
	$(PYTEST) -m 'not slow' $(ARGS)

check: test ## the same as test

slow: $(STAMP) ## run the slow tests; ARGS is passed to pytest
	$(PYTEST) -m slow $(ARGS)

bench: $(STAMP) ## run the benchmarks
	@for file in benchmarks/*.py; do \
		if [ -e "$$file" ]; then echo "== $$file"; .venv/bin/python "$$file" $(ARGS) || exit 1; fi; \
	done

mutants: $(STAMP) ## change what computes, one thing at a time, and list what no test notices; takes hours, ARGS="--count 100" minutes
	.venv/bin/python tools/mutants.py $(ARGS)

pages: $(STAMP) ## write the generated pages of docs/ anew; their trials fly for minutes
	PYTHONPATH=tools .venv/bin/python -m pages

site: $(STAMP) ## build the documentation site into build/site; ARGS="--open" shows it in a browser
	@PYTHONPATH=tools .venv/bin/python -m manual $(ARGS)

lock: ## pin the dependencies anew in requirements.lock; ARGS=--upgrade takes the newest
	@.venv/tools/bin/python -m pip --version >/dev/null 2>&1 || "$(PYTHON)" -m venv --clear .venv/tools
	@.venv/tools/bin/python -m pip --disable-pip-version-check --quiet install 'uv==$(UV_VERSION)'
	@.venv/tools/bin/uv pip compile --quiet --universal --python-version 3.11 --fork-strategy fewest \
		--only-binary :all: --generate-hashes --no-emit-index-url --no-emit-find-links \
		--custom-compile-command 'make lock' --extra dev --output-file requirements.lock $(ARGS) pyproject.toml

clean: ## remove the environment, caches and build products; results in out/ stay
	rm -rf .venv build .pytest_cache .mypy_cache .ruff_cache .hypothesis src/*.egg-info
	find src tests -name __pycache__ -type d -prune -exec rm -rf {} +

$(STAMP): requirements.lock pyproject.toml $(if $(INTACT),,FORCE)
	@[ -n '$(INTACT)' ] || { \
		version=$$("$(PYTHON)" -c 'import sys; print("%d.%d" % sys.version_info[:2])' 2>/dev/null) \
			|| version='not to be found'; \
		"$(PYTHON)" -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null || { \
			echo "armland needs Python 3.11 or newer; $(PYTHON) is $$version." \
				"Name another one: make PYTHON=python3.12 ..." >&2; exit 1; }; \
		"$(PYTHON)" -c 'import ensurepip, venv' 2>/dev/null || { \
			echo "$(PYTHON) ($$version) has no venv module." \
				"On Debian and Ubuntu: apt-get install python3-venv" >&2; exit 1; }; \
		echo 'Creating .venv'; "$(PYTHON)" -m venv --clear .venv; }
	@rm -f $@ && : > .venv/.incomplete
	@echo 'Installing what requirements.lock pins into .venv (2.5 GB; the first time takes some minutes)'
	@$(PIP) install --require-hashes --only-binary :all: -r requirements.lock
	@$(PIP) install --no-deps --no-build-isolation --editable .
	@rm .venv/.incomplete && : > $@
