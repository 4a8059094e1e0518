# Runs at the end of an installation: writes the list of its files, relative to the prefix.
set(list "")
foreach(file IN LISTS CMAKE_INSTALL_MANIFEST_FILES)
  file(RELATIVE_PATH relative "${CMAKE_INSTALL_PREFIX}" "${file}")
  string(APPEND list "${relative}\n")
endforeach()
string(APPEND list "${installed_list}\n")
file(WRITE "$ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}/${installed_list}" "${list}")
