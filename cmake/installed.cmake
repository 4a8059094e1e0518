# Runs at the end of an installation: writes the list of this project's files, relative to the prefix.
cmake_path(ABSOLUTE_PATH CMAKE_INSTALL_PREFIX NORMALIZE OUTPUT_VARIABLE prefix)
string(REGEX REPLACE "/$" "" prefix "${prefix}") # of the root nothing is left
string(APPEND prefix "/")
string(LENGTH "${prefix}" length)
list(SUBLIST CMAKE_INSTALL_MANIFEST_FILES ${stickslip_first} -1 files)
set(list "")
foreach(file IN LISTS files)
  cmake_path(ABSOLUTE_PATH file NORMALIZE)
  string(SUBSTRING "${file}" ${length} -1 relative)
  string(APPEND list "${relative}\n")
endforeach()
string(APPEND list "${installed_list}\n")
file(WRITE "$ENV{DESTDIR}${prefix}${installed_list}" "${list}")
