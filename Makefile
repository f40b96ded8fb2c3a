# One command surface for people, hooks and CI. `make help` lists the targets.
#
# Needed: Python 3.11+, a Rust toolchain (cargo), a C compiler. Everything else is locked in requirements.lock and
# Cargo.lock and lands in .venv and target.

SHELL := /bin/bash
.SHELLFLAGS := -eu -o pipefail -c
.DEFAULT_GOAL := help
.DELETE_ON_ERROR:

PYTHON ?= python3
CARGO ?= cargo
DEMO_DIR ?= demo
VENV := .venv
BIN := $(CURDIR)/$(VENV)/bin
# Every crate but the Python module, which cannot be linked as a program; the Python tests are its tests.
CRATES := --workspace --exclude sunpeak-python
RUST_FILES := Cargo.toml Cargo.lock $(shell find crates -type f)

# PyO3 asks this interpreter, so that cargo and maturin build the same thing.
export PYO3_PYTHON := $(BIN)/python
export VIRTUAL_ENV := $(CURDIR)/$(VENV)
# pip finds maturin here.
export PATH := $(BIN):$(PATH)
unexport PYTHONHOME PYTHONPATH

.PHONY: help build wheel demo test test-rust test-python lint fmt bench bench-transport fuzz docs lock clean

help: ## Say what can be made
	@grep -hE '^[a-z-]+:.*## ' $(MAKEFILE_LIST) | sed -E 's/^([a-z-]+):.*## (.*)/  make \1\t\2/' | expand -t 20

build: $(VENV)/.built ## Build the core and install it into .venv

wheel: $(VENV)/.installed ## A wheel in dist/, laid out by a profile of its use; faster, 8 minutes (needs `rustup component add llvm-tools`)
	$(BIN)/maturin build --release --locked --pgo --interpreter $(BIN)/python --out dist

demo: build ## The main job: the same room without and with peak extraction, into demo/
	$(BIN)/sunpeak demo -o $(DEMO_DIR)

test: test-rust test-python ## All tests

test-rust: $(VENV)/.installed
	$(CARGO) test --locked $(CRATES)

test-python: build
	$(BIN)/python -m pytest

lint: $(VENV)/.installed ## Formatting, clippy, ruff, mypy
	$(CARGO) fmt --all --check
	$(CARGO) clippy --locked --workspace --all-targets -- -D warnings
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

fmt: $(VENV)/.installed ## Format everything
	$(CARGO) fmt --all
	$(BIN)/ruff check --fix-only .
	$(BIN)/ruff format .

bench: build ## Benchmarks: name, ours, theirs, ratio for rays, sampling, through, large files, glare
	$(CARGO) bench --locked $(CRATES) --bench '*'
	$(BIN)/python benches/demo_room.py
	$(BIN)/python benches/large_files.py
	$(BIN)/python benches/large_scene.py
	$(BIN)/python benches/glare_picture.py

bench-transport: build ## CPU time of rpict and of ours to the same error in ten rooms (hours), kept in benches/runs
	cd benches && $(BIN)/python -m transport --out runs/$$(date +%F)-$$(uname -m)-$$(nproc)-cores

fuzz: ## Readers against hostile input, a minute each (needs a nightly compiler and cargo-fuzz)
	for target in scene expression view picture bsdf; do \
		mkdir -p fuzz/corpus/$$target; \
		$(CARGO) +nightly fuzz run $$target fuzz/corpus/$$target fuzz/seeds/$$target -- \
			-max_total_time=60 -timeout=20 -rss_limit_mb=4096 -max_len=4096; \
	done

docs: ## The crates' documentation, into target/doc
	$(CARGO) doc --locked $(CRATES) --no-deps

lock: ## Choose new versions of the Python dependencies (needs uv)
	uv pip compile --universal --generate-hashes --no-emit-find-links --no-header --python-version 3.11 \
		--upgrade --group dev pyproject.toml -o requirements.lock

clean: ## Remove what was built
	rm -rf $(VENV) target $(DEMO_DIR) python/sunpeak/*.so
	find . -name __pycache__ -not -path './.venv/*' -prune -exec rm -rf {} +

$(VENV)/.installed: requirements.lock tools/make_venv.py
	$(PYTHON) tools/make_venv.py $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --require-hashes -r requirements.lock
	touch $@

$(VENV)/.built: $(VENV)/.installed pyproject.toml $(RUST_FILES)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-deps --no-build-isolation --editable .
	touch $@
