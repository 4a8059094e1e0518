#!/bin/sh
# Compiles and runs what measures as a caller: stages.c, lines.c, quadratic.c, quadratic_handle.c, skin.c and handle.c against the library in a folder, with the C++ baseline
# where its headers are. Usage: caller.sh FOLDER [sizes of handle.c]
set -eu
here=$(dirname "$0")
folder=$1
shift
headers=$here/../../shared/baseline
with=
if [ -d "$headers" ]; then
  c++ -std=c++17 -O3 -march=native -I "$headers" -c "$here/baseline.cpp" -o "$folder/baseline.o"
  with="-DBASELINE $folder/baseline.o"
fi
for program in ${with:+stages} lines quadratic quadratic_handle skin handle; do
  # shellcheck disable=SC2086 # $with is two words
  cc -O2 -I "$here/../include" "$here/$program.c" $with -o "$folder/$program" -L "$folder" -l:libstickslip.a \
    -lm -lpthread -ldl -lstdc++
done
if [ -n "$with" ]; then "$folder/stages"; fi
"$folder/lines"
"$folder/quadratic"
"$folder/quadratic_handle"
"$folder/skin"
"$folder/handle" "$@"
