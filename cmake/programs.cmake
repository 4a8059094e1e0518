# What the examples and the program need: how they are linked with the library, and the packages that several of them want.

# A program in C from the sources, linked to the static library and what else it needs.
function(add_c_program name sources)
  add_executable(${name} ${sources})
  target_compile_options(${name} PRIVATE -Wall -Wextra)
  target_link_libraries(${name} PRIVATE stickslip::static ${ARGN} m)
  set_target_properties(${name} PROPERTIES C_STANDARD 11 C_STANDARD_REQUIRED ON C_EXTENSIONS OFF)
endfunction()

function(skip_program name missing packages)
  stickslip_skip("${name}: skipped, not found: ${missing} (Debian: ${packages})")
endfunction()

find_package(LAPACK QUIET)
find_package(PkgConfig QUIET)
find_package(MPI QUIET COMPONENTS C)
if(PKG_CONFIG_FOUND)
  pkg_check_modules(petsc QUIET IMPORTED_TARGET PETSc>=3.18)
  pkg_check_modules(cjson QUIET IMPORTED_TARGET libcjson)
  pkg_check_modules(yaml QUIET IMPORTED_TARGET yaml-0.1)
endif()
