# `make demo` and `make test` are all that a new user needs; `make help` lists the rest.
PYTHON ?= python3.11
STAMP := .venv/.installed
BIN := .venv/bin
SEED ?= 1
SEEDS ?= 50
MINUTES ?= 10
COUNT ?= 20
OUT ?= build/blind
RUNS ?= 6
export NUMBA_CACHE_DIR ?= $(CURDIR)/build/numba

.PHONY: help install kernels demo test quick lint browser dask slow soak kills trips align bench blind

help: ## this list
	@grep -E '^[a-z]+:.*## ' $(MAKEFILE_LIST) | sed -E 's/^([a-z]+):.*## /  make \1 \t/' | expand -t 18

install: $(STAMP) ## the environment in .venv, versions as in constraints.txt

$(STAMP): pyproject.toml constraints.txt
	test -d .venv || $(PYTHON) -m venv .venv
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt uv
	$(BIN)/uv pip install --quiet --python $(BIN)/python -c constraints.txt --compile-bytecode -e '.[dev]'
	touch $@

demo: install ## one experiment on a simulated stand that hides an effect, compared and diagnosed
	$(BIN)/stand demo

test: install lint quick ## lint, types, import contracts and the quick tests

# what moves on wires in real time goes after the rest and alone: two at once would measure each other
WIRES := tests/loop tests/stand/test_profiles.py tests/api/test_server.py tests/api/test_access.py tests/api/test_next.py

# compiled once, half by half: the tests' two processes would each compile them all for themselves
KERNELS_1 := composed composed_sense composed_latent force force_batch running
KERNELS_2 := fibre_chain fibre_ancf fibre_segment fibre_ritz

kernels: install
	$(BIN)/python -c "$(KERNELS_1:%=import twin.kernels.%;)" & $(BIN)/python -c "$(KERNELS_2:%=import twin.kernels.%;)" && wait

quick: kernels
	$(BIN)/python -m pytest -n 2 $(WIRES:%=--ignore=%)
	$(BIN)/python -m pytest $(WIRES)

lint: install
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports

browser: install ## the page in a real browser (needs Chromium)
	$(BIN)/python -m pytest -m browser tests/api

dask: install ## a diagnosis on a Dask cluster of real processes
	$(BIN)/python -m pytest -m slow tests/api/test_dask.py

slow: install ## the long checks of models and time base
	$(BIN)/python -m pytest -m slow -n 2 --timeout 1200

soak: install ## MINUTES=10 of 2 kHz under load: no sample lost, latency of live R
	$(BIN)/python -m tests.loop.soak --minutes $(MINUTES)

kills: install ## COUNT=20 acquisitions killed at random moments
	$(BIN)/python -m tests.loop.kills --count $(COUNT)

trips: install ## from the sample that shows a fault to the stop on the wire
	$(BIN)/python -m tests.loop.trips

align: install ## SEEDS=50 alignments with known truth
	$(BIN)/python -m tests.stand.alignment --seeds $(SEEDS)

bench: install ## speed against other codes, into build/bench.json
	$(BIN)/uv pip install --quiet --python $(BIN)/python -c constraints.txt -e '.[bench]'
	$(BIN)/python -m bench

blind: install ## SEED=1: the battery of hidden effects; RUNS=1: from one run of each campaign
	$(BIN)/python -m tests.blind --seed $(SEED) --out $(OUT) --runs $(RUNS)
