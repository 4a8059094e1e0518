#!/usr/bin/env bash
# fuzz/run.sh SECONDS|kept [TARGET...]: builds the fuzz targets and runs each for so long, or on the kept inputs alone.
#
# The compiler's flags are those of cargo-fuzz without a sanitizer, which a stable toolchain takes. SANITIZER=address
# adds the address sanitizer (RUSTC_BOOTSTRAP). What is found lies in fuzz/artifacts/TARGET; the inputs that led to new
# code in fuzz/corpus/TARGET, beside the seeds of fuzz/seeds/TARGET. See fuzz/README.md.
set -eu
cd "$(dirname "$0")"

seconds=${1:?usage: fuzz/run.sh SECONDS|kept [TARGET...]}
shift
targets=("${@:-pair interface effects skin abi}")
read -ra targets <<<"${targets[*]}"
triple=$(rustc -vV | sed -n 's/^host: //p')
build=${CARGO_TARGET_DIR:-$PWD/target}/fuzz
flags="--cfg fuzzing -Cpasses=sancov-module -Cllvm-args=-sanitizer-coverage-level=4
    -Cllvm-args=-sanitizer-coverage-inline-8bit-counters -Cllvm-args=-sanitizer-coverage-pc-table
    -Cllvm-args=-sanitizer-coverage-trace-compares"
if [ -n "${SANITIZER:-}" ]; then
    export RUSTC_BOOTSTRAP=1
    flags="$flags -Zsanitizer=$SANITIZER"
    build=$build-$SANITIZER
fi
# With a target triple the flags are for the targets and what they use, not for build scripts.
RUSTFLAGS=$(echo $flags) cargo build --locked --release --target "$triple" --target-dir "$build"

for target in "${targets[@]}"; do
    if [ "$seconds" = kept ]; then
        printf '\n== The kept inputs of %s\n' "$target"
        "$build/$triple/release/$target" -timeout=0 "seeds/$target"/*
        continue
    fi
    printf '\n== Fuzzing %s for %s s\n' "$target" "$seconds"
    mkdir -p "corpus/$target" "artifacts/$target" "seeds/$target"
    "$build/$triple/release/$target" -max_total_time="$seconds" -artifact_prefix="artifacts/$target/" \
        -timeout=10 -rss_limit_mb=2048 -print_final_stats=1 -max_len=1024 -verbosity=0 "corpus/$target" "seeds/$target"
done
