PYTHON ?= python3.11
STAMP := .venv/.installed
export NUMBA_CACHE_DIR ?= $(CURDIR)/build/numba

.PHONY: install demo test quick lint

install: $(STAMP)

$(STAMP): pyproject.toml constraints.txt
	test -d .venv || $(PYTHON) -m venv .venv
	.venv/bin/python -m pip install --quiet --disable-pip-version-check -c constraints.txt uv
	.venv/bin/uv pip install --quiet --python .venv/bin/python -c constraints.txt -e '.[dev]'
	touch $@

demo: install
	.venv/bin/stand demo

test: install lint quick

quick: install
	.venv/bin/python -m pytest -n 2

lint: install
	.venv/bin/ruff check .
	.venv/bin/ruff format --check .
	.venv/bin/mypy
	.venv/bin/lint-imports
