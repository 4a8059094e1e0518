# What `cmake --install` puts where. Every file finds the others relative to itself: the tree may be moved.

include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
file(STRINGS Cargo.toml description REGEX "^description *=" LIMIT_COUNT 1)
string(REGEX REPLACE "^[^\"]*\"(.*)\"$" "\\1" description "${description}")
foreach(dir CMAKE_INSTALL_LIBDIR CMAKE_INSTALL_INCLUDEDIR CMAKE_INSTALL_DATADIR CMAKE_INSTALL_DOCDIR)
  if(IS_ABSOLUTE "${${dir}}")
    message(FATAL_ERROR "${dir} is ${${dir}}; it must be relative to the prefix: the installed tree can be moved.")
  endif()
endforeach()
set(package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/stickslip")

# Paths from the folder of the pkg-config files and from that of the CMake package to the prefix.
file(RELATIVE_PATH pc_to_prefix "/${CMAKE_INSTALL_LIBDIR}/pkgconfig" "/")
string(REGEX REPLACE "/$" "" pc_to_prefix "${pc_to_prefix}")
list(TRANSFORM STICKSLIP_STATIC_LIBRARIES PREPEND "-l" OUTPUT_VARIABLE static_flags)
list(JOIN static_flags " " static_flags)
configure_file(cmake/stickslip.pc.in stickslip.pc @ONLY)
configure_file(cmake/stickslip-static.pc.in stickslip-static.pc @ONLY)

configure_package_config_file(cmake/stickslip-config.cmake.in stickslip-config.cmake
  INSTALL_DESTINATION "${package_dir}" PATH_VARS CMAKE_INSTALL_INCLUDEDIR CMAKE_INSTALL_LIBDIR)
if(PROJECT_VERSION_MAJOR EQUAL 0)
  set(compatibility SameMinorVersion)
else()
  set(compatibility SameMajorVersion)
endif()
write_basic_package_version_file(stickslip-config-version.cmake COMPATIBILITY ${compatibility})

if(TARGET stickslip_mpi)
  configure_file(cmake/stickslip_mpi.pc.in stickslip_mpi.pc @ONLY)
endif()

# Where a project around this one has installed files before, the list begins after them.
install(CODE "list(LENGTH CMAKE_INSTALL_MANIFEST_FILES stickslip_first)")
install(FILES include/stickslip.h include/stickslip.hpp include/stickslip.f90 DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}")
install(FILES "${STICKSLIP_SHARED}" DESTINATION "${CMAKE_INSTALL_LIBDIR}"
  PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
install(FILES ${STICKSLIP_LINKS} "${STICKSLIP_STATIC}" DESTINATION "${CMAKE_INSTALL_LIBDIR}")
install(FILES "${PROJECT_BINARY_DIR}/stickslip.pc" "${PROJECT_BINARY_DIR}/stickslip-static.pc"
  DESTINATION "${CMAKE_INSTALL_LIBDIR}/pkgconfig")
install(FILES "${PROJECT_BINARY_DIR}/stickslip-config.cmake" "${PROJECT_BINARY_DIR}/stickslip-config-version.cmake"
  DESTINATION "${package_dir}")
if(TARGET stickslip_mpi)
  install(TARGETS stickslip_mpi ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}")
  install(FILES mpi/stickslip_mpi.h DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}")
  install(FILES "${PROJECT_BINARY_DIR}/stickslip_mpi.pc" DESTINATION "${CMAKE_INSTALL_LIBDIR}/pkgconfig")
endif()
install(FILES README.md CHANGELOG.md CITATION.cff CONTRIBUTING.md SUPPORT.md LICENSE-MIT LICENSE-APACHE DESTINATION "${CMAKE_INSTALL_DOCDIR}")
file(GLOB host_pages docs/host_*.md)
install(FILES ${host_pages} docs/first_program.md docs/plug_in.md docs/abi.md docs/compose.md docs/gradients.md docs/general_contact.md docs/accuracy.md docs/exact.md docs/cells.md docs/other_programs.md docs/border.md docs/points.md docs/stability.md docs/glossary.md
  docs/scaling.md docs/other_hosts.md docs/feap.md docs/energy_norm.md docs/method.md docs/dynamics.md docs/without_pivoting.md
  DESTINATION "${CMAKE_INSTALL_DOCDIR}/docs")
install(FILES ARCHITECTURE.md DESTINATION "${CMAKE_INSTALL_DOCDIR}")
install(FILES c_examples/block_host.c c_examples/petsc_block.c c_examples/mpi_block.c c_examples/pair_demo.c
  c_examples/profile_host.c
  DESTINATION "${CMAKE_INSTALL_DOCDIR}/c_examples")
install(DIRECTORY c_examples/fortran DESTINATION "${CMAKE_INSTALL_DOCDIR}/c_examples" FILES_MATCHING PATTERN "*.f90")
# The program as something to read, scenes and their meshes: the guides name them.
install(DIRECTORY program DESTINATION "${CMAKE_INSTALL_DOCDIR}"
  FILES_MATCHING PATTERN "*.c" PATTERN "*.h" PATTERN "*.md" PATTERN tests EXCLUDE)
install(DIRECTORY c_examples/scenes c_examples/meshes DESTINATION "${CMAKE_INSTALL_DOCDIR}/c_examples"
  FILES_MATCHING PATTERN "*.yaml" PATTERN "*.msh" PATTERN "*.geo" PATTERN "*.py" PATTERN "*.sh" PATTERN "*.md")
install(DIRECTORY docs/formulation DESTINATION "${CMAKE_INSTALL_DOCDIR}/docs")
install(DIRECTORY docs/figures/ DESTINATION "${CMAKE_INSTALL_DOCDIR}/docs/figures")

# It has the library within it.
if(TARGET stickslip_program)
  install(PROGRAMS "$<TARGET_FILE:stickslip_program>" DESTINATION "${CMAKE_INSTALL_BINDIR}")
endif()

# The list for uninstalling, relative to the prefix, so that it is right wherever the tree is:
#   cd PREFIX && xargs -d '\n' rm -f < share/stickslip/installed.txt
set(installed_list "${CMAKE_INSTALL_DATADIR}/stickslip/installed.txt")
install(CODE "set(installed_list \"${installed_list}\")")
install(SCRIPT cmake/installed.cmake)
