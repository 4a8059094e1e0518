#!/usr/bin/env bash
# Builds what can be built here, in OUT: packages.sh OUT. What cannot be built is skipped with a sentence.
# The crate (cargo package), Debian's packages with lintian's opinion, the recipes of Spack and conda-forge with their linters.
set -u
cd "$(dirname "$0")/.."
mkdir -p "$1"
out=$(realpath "$1")
failed=0

step() {
    local what=$1
    shift
    echo "== $what"
    if "$@"; then echo "ok      $what"; else echo "FAILED  $what"; failed=1; fi
}

skip() {
    echo "skipped $1: $2"
}

debian() {
    local tree=$out/deb/stickslip
    rm -rf "$out/deb" && mkdir -p "$tree" || return
    # What is committed, and no more: as a packager gets it.
    git archive HEAD | tar -x -C "$tree" && cp -r "$out/debian" "$tree/debian" || return
    mkdir "$tree/vendor" || return
    # CARGO_HOME of debian/rules: its configuration sends cargo to the crates beside it.
    (cd "$tree" && cargo vendor --locked --quiet vendor/crates > /dev/null) || return
    printf '[source.crates-io]\nreplace-with = "vendored"\n[source.vendored]\ndirectory = "%s"\n' \
        "$tree/vendor/crates" > "$tree/vendor/config.toml"
    # -d: the Rust compiler may be one of rustup's, which it finds by RUSTUP_HOME: debhelper gives the build another HOME.
    (cd "$tree" && RUSTUP_HOME=${RUSTUP_HOME:-$HOME/.rustup} RUSTUP_TOOLCHAIN=${RUSTUP_TOOLCHAIN:-stable} \
        STICKSLIP_COMMIT=$(git -C "$OLDPWD" rev-parse HEAD) \
        dpkg-buildpackage -us -uc -b -d > "$out/deb/build.log" 2>&1) || { tail -20 "$out/deb/build.log"; return 1; }
    ls -l "$out"/deb/*.deb
}

# All it says goes to lintian.txt; its exit code is not 0 where it finds an error.
lint() {
    lintian --allow-root --tag-display-limit 0 "$out"/deb/*.changes > "$out/deb/lintian.txt"
    local found=$?
    grep '^[EWI]:' "$out/deb/lintian.txt"
    return $found
}

step "templates" python3 packaging/fill.py "$out"
step "crate" cargo package --locked --allow-dirty
# It was built a line above.
step "crates.io, without uploading" cargo publish --dry-run --no-verify --locked --allow-dirty
if command -v dpkg-buildpackage >/dev/null && command -v dh >/dev/null; then
    step "Debian" debian
    if ! command -v lintian >/dev/null; then
        skip lintian "not installed (Debian: lintian)"
    elif ls "$out"/deb/*.changes >/dev/null 2>&1; then
        step "lintian, no errors" lint
    fi
else
    skip Debian "dpkg-buildpackage or dh is not installed (Debian: debhelper, dpkg-dev)"
fi
step "Spack's recipe is Python" python3 -c 'import ast, sys; ast.parse(open(sys.argv[1]).read())' "$out/spack/package.py"
command -v spack >/dev/null || skip "Spack's audit" "spack is not installed"
linters=$out/lint/bin/python
test -x "$linters" || python3 -m venv "$out/lint"
if "$linters" -m pip install -q py-rattler-build flake8 cffconvert >/dev/null 2>&1; then
    step "recipes and CITATION.cff" "$linters" packaging/lint.py "$out"
else
    skip "linters of the recipes" "PyPI does not answer (py-rattler-build, flake8, cffconvert)"
fi
exit $failed
