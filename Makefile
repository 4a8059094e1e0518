# Front door of the project; `make help` lists the targets. Each one sets up what it needs by itself (.ci/setup).
# The work is done by cargo (library), CMake (examples) and Python (pictures and checks).

BUILD  ?= build
PYTHON ?= /usr/bin/python3
GMSH   ?= gmsh
JOBS   ?= $(shell nproc)

export PYTHON
export PATH := $(PATH):$(HOME)/.cargo/bin

# Two makes at once would disturb each other's build tree: the second one waits here.
LOCKED = mkdir -p $(BUILD) && flock $(BUILD)/.lock
SAY    = @printf '\n== %s\n'

.PHONY: help demo test build header meshes clean cmake-build rust-tests

help:
	@echo "make demo    solve the example scenes, compare with the references, draw the figures (FIGURES=1: renew the README's)"
	@echo "make test    run every test and check"
	@echo "make build   build the library and the examples into $(BUILD)/"
	@echo "make header  make include/stickslip.h again from src/capi"
	@echo "make meshes  make the example meshes again with Gmsh"
	@echo "make clean   remove $(BUILD)/ and target/"

demo:
	@.ci/setup demo
	@$(MAKE) --no-print-directory cmake-build
	$(SAY) "Solving the demonstration scenes"
	@$(PYTHON) c_examples/report/demo.py --build $(BUILD) $(if $(FIGURES),--renew-figures)

test:
	@.ci/setup test
	@$(MAKE) --no-print-directory rust-tests
	@$(MAKE) --no-print-directory cmake-build
	$(SAY) "Examples and acceptance checks (ctest)"
	@cd $(BUILD) && ctest --output-on-failure --no-tests=error --parallel $(JOBS)
	$(SAY) "All tests passed"

build:
	@.ci/setup build
	@$(MAKE) --no-print-directory cmake-build

rust-tests:
	$(SAY) "Format and lints"
	cargo fmt --all --check
	cargo clippy --locked --all-targets -- -D warnings
	$(SAY) "Rust and C ABI tests"
	cargo test --locked
	$(SAY) "Documentation"
	RUSTDOCFLAGS="-D warnings" cargo doc --locked --no-deps

cmake-build:
	$(SAY) "Library and examples"
	@$(LOCKED) cmake -S . -B $(BUILD) -DSTICKSLIP_REQUIRE_EXAMPLES=ON -DPython3_EXECUTABLE=$(PYTHON)
	@$(LOCKED) cmake --build $(BUILD) --parallel $(JOBS)

header:
	STICKSLIP_WRITE_HEADER=1 cargo test --locked --test header header_is_up_to_date

meshes:
	@.ci/setup meshes
	c_examples/meshes/generate.sh $(GMSH)

clean:
	rm -rf $(BUILD) target
