# The library: cargo builds it; the targets here are what the build tree links to.

find_program(CARGO_EXECUTABLE cargo HINTS "$ENV{HOME}/.cargo/bin" REQUIRED)
if(STICKSLIP_DEBUG)
  set(cargo_profile dev)
  set(cargo_dir "${STICKSLIP_CARGO_TARGET_DIR}/debug")
else()
  set(cargo_profile release)
  set(cargo_dir "${STICKSLIP_CARGO_TARGET_DIR}/release")
endif()

# The shared library goes by its soname, libstickslip.so.0.MINOR before 1.0, libstickslip.so.MAJOR after (docs/abi.md);
# build.rs puts the same into the file.
if(PROJECT_VERSION_MAJOR EQUAL 0)
  set(STICKSLIP_SOVERSION "0.${PROJECT_VERSION_MINOR}")
else()
  set(STICKSLIP_SOVERSION "${PROJECT_VERSION_MAJOR}")
endif()

# What `rustc --print native-static-libs` lists, without gcc_s: every compiler driver adds that by itself, in the shared or
# static kind that fits the link. A test compares the two.
set(STICKSLIP_STATIC_LIBRARIES util rt pthread m dl c)

# Staged as they are installed: the versioned file, its two links, the archive without what only debuggers read.
set(STICKSLIP_STAGE "${PROJECT_BINARY_DIR}/lib")
set(STICKSLIP_SHARED "${STICKSLIP_STAGE}/libstickslip.so.${PROJECT_VERSION}")
set(STICKSLIP_STATIC "${STICKSLIP_STAGE}/libstickslip.a")
set(STICKSLIP_LINKS "${STICKSLIP_STAGE}/libstickslip.so.${STICKSLIP_SOVERSION}" "${STICKSLIP_STAGE}/libstickslip.so")

# Panics name the file they stand in: those of other crates by a path of this machine, if nothing is put in its place.
# RUSTFLAGS in the environment go before this, so who sets them says the same there (docs/abi.md).
if(DEFINED ENV{CARGO_HOME})
  set(cargo_home "$ENV{CARGO_HOME}")
else()
  set(cargo_home "$ENV{HOME}/.cargo")
endif()
set(remapped "build.rustflags=['--remap-path-prefix=${cargo_home}=/cargo', '--remap-path-prefix=${PROJECT_SOURCE_DIR}=/stickslip']")

# What the library is compiled with so that it is small. Kernels are marked to be inlined and written with four lanes: they stay as they
# are, to the last bit, and so does everything else. A debug build inlines next to nothing anyhow.
# - What is not marked is inlined where its body is small, at 26: a tenth less, for two to three per cent more instructions.
# - What is marked `#[inline]`, as much of the standard library is, and what is called in loops is inlined up to 112 and 95 instead of 325 and
#   525 of the compiler's measure. What stands between two blocks of a tangent would be slower so: it is marked `#[inline(always)]`.
# - Loops whose length is known at run time alone are neither unrolled nor turned into lanes: outside of kernels they are short.
set(small_library
  -C llvm-args=-inline-threshold=26 -C llvm-args=-inlinehint-threshold=112 -C llvm-args=-locally-hot-callsite-threshold=95
  -C llvm-args=-unroll-runtime=false -C no-vectorize-loops)
# Functions with the same code, as interfaces of one and of three multipliers a node often have, are kept once where the linker of rustc
# can do so (lld, gold, mold).
file(WRITE "${PROJECT_BINARY_DIR}/fold.rs" "")
execute_process(COMMAND rustc --crate-type cdylib -C link-arg=-Wl,--icf=all --out-dir "${PROJECT_BINARY_DIR}" "${PROJECT_BINARY_DIR}/fold.rs"
  RESULT_VARIABLE cannot_fold OUTPUT_QUIET ERROR_QUIET)
if(NOT cannot_fold)
  list(APPEND small_library -C link-arg=-Wl,--icf=all)
endif()

# All of cargo's features, or a list of those that are wanted: docs/abi.md says what each adds.
set(known_features analytic condensed heat laws lines offsets points quadratic rigid sensitivity skin)
set(STICKSLIP_FEATURES "all" CACHE STRING "What is built of what can be left out: all, none, or a list of ${known_features}")
if(NOT STICKSLIP_FEATURES STREQUAL "all")
  if(STICKSLIP_TESTS)
    message(FATAL_ERROR "The tests are those of the whole library: STICKSLIP_FEATURES=${STICKSLIP_FEATURES} needs -DSTICKSLIP_TESTS=OFF.")
  endif()
  set(features ${STICKSLIP_FEATURES})
  list(REMOVE_ITEM features none)
  foreach(feature ${features})
    if(NOT feature IN_LIST known_features)
      list(JOIN known_features " " known_features)
      message(FATAL_ERROR "STICKSLIP_FEATURES: there is no feature ${feature}; all, none, or a list of ${known_features}.")
    endif()
  endforeach()
  list(JOIN features "," features)
  set(cargo_features --no-default-features "--features=${features}")
endif()

# cargo alone knows whether something changed, so it is asked each time; what depends on it relinks only if the files
# are newer. The library for Rust is left out: what is public in Rust alone is then nobody's, and can be inlined where it is called once.
add_custom_target(stickslip_cargo ALL
  COMMAND "${CARGO_EXECUTABLE}" --config "${remapped}" rustc --profile ${cargo_profile} --locked --lib --crate-type cdylib,staticlib ${cargo_features} --target-dir "${STICKSLIP_CARGO_TARGET_DIR}"
          -- ${small_library} --print "native-static-libs=${cargo_dir}/native-static-libs.txt"
  COMMAND "${CMAKE_COMMAND}" "-Dfrom=${cargo_dir}" "-Dshared=${STICKSLIP_SHARED}" "-Dstatic=${STICKSLIP_STATIC}"
          "-Dsoversion=${STICKSLIP_SOVERSION}" "-Dobjcopy=$<$<NOT:$<BOOL:${STICKSLIP_DEBUG}>>:${CMAKE_OBJCOPY}>" -P "${PROJECT_SOURCE_DIR}/cmake/stage.cmake"
  WORKING_DIRECTORY "${PROJECT_SOURCE_DIR}"
  BYPRODUCTS "${STICKSLIP_SHARED}" "${STICKSLIP_STATIC}"
  COMMENT "Building the library with cargo"
  USES_TERMINAL
  VERBATIM)

add_library(stickslip::stickslip SHARED IMPORTED GLOBAL)
set_target_properties(stickslip::stickslip PROPERTIES
  IMPORTED_LOCATION "${STICKSLIP_SHARED}"
  IMPORTED_SONAME "libstickslip.so.${STICKSLIP_SOVERSION}"
  INTERFACE_INCLUDE_DIRECTORIES "${PROJECT_SOURCE_DIR}/include")
add_library(stickslip::static STATIC IMPORTED GLOBAL)
set_target_properties(stickslip::static PROPERTIES
  IMPORTED_LOCATION "${STICKSLIP_STATIC}"
  INTERFACE_INCLUDE_DIRECTORIES "${PROJECT_SOURCE_DIR}/include"
  INTERFACE_LINK_LIBRARIES "${STICKSLIP_STATIC_LIBRARIES}")
add_dependencies(stickslip::stickslip stickslip_cargo)
add_dependencies(stickslip::static stickslip_cargo)

# The module file belongs to one compiler, so it is never shipped: the source is, and is compiled here.
if(CMAKE_Fortran_COMPILER AND EXISTS "${PROJECT_SOURCE_DIR}/include/stickslip.f90")
  add_library(stickslip_fortran STATIC "${PROJECT_SOURCE_DIR}/include/stickslip.f90")
  set_target_properties(stickslip_fortran PROPERTIES
    Fortran_MODULE_DIRECTORY "${PROJECT_BINARY_DIR}/fortran"
    INTERFACE_INCLUDE_DIRECTORIES "${PROJECT_BINARY_DIR}/fortran")
  add_library(stickslip::fortran ALIAS stickslip_fortran)
endif()
