# Three components: the program with its Python programs, the package for Python (apps/python), and the libraries with
# their headers and find_package(Sprekk). PREFIX/lib/sprekk has the folders of the source tree that the launcher uses;
# PREFIX/bin/sprekk is a link to the launcher.
include(CMakePackageConfigHelpers)
set(home lib/sprekk)
install(TARGETS sprekk_app DESTINATION ${home}/apps/sprekk COMPONENT program)
install(PROGRAMS sprekk DESTINATION ${home} COMPONENT program)
install(DIRECTORY apps/export apps/fit apps/mesh apps/network apps/plot apps/report DESTINATION ${home}/apps COMPONENT program
  FILES_MATCHING PATTERN "*.py" PATTERN "*.css" PATTERN __pycache__ EXCLUDE)
install(FILES docs/use/reference.md DESTINATION ${home}/docs/use COMPONENT program)
install(DIRECTORY xml/ DESTINATION ${home}/xml COMPONENT program)
install(FILES docs/read_results.py docs/shear_test.xml docs/two_rocks.xml docs/disc_pressure.xml ${CMAKE_BINARY_DIR}/sprekk.rng
  DESTINATION ${home}/docs COMPONENT program)
install(FILES ${CMAKE_BINARY_DIR}/report/viewer.js.bundle DESTINATION ${home}/report COMPONENT program OPTIONAL)
install(FILES ${CMAKE_BINARY_DIR}/report/viewer.licenses DESTINATION share/doc/sprekk COMPONENT program OPTIONAL)
file(CREATE_LINK ../${home}/sprekk ${CMAKE_BINARY_DIR}/sprekk SYMBOLIC)
install(FILES ${CMAKE_BINARY_DIR}/sprekk DESTINATION bin COMPONENT program)
install(FILES LICENSE DESTINATION share/doc/sprekk RENAME copyright COMPONENT program)
install(FILES LICENSE DESTINATION share/doc/libsprekk-dev RENAME copyright COMPONENT development)

set(config ${CMAKE_INSTALL_LIBDIR}/cmake/Sprekk)
install(DIRECTORY packages/ DESTINATION include/sprekk COMPONENT development
  FILES_MATCHING PATTERN "*.hpp" PATTERN precompiled.hpp EXCLUDE)
install(EXPORT Sprekk NAMESPACE Sprekk:: DESTINATION ${config} COMPONENT development)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/SprekkConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES cmake/SprekkConfig.cmake cmake/Dependencies.cmake ${CMAKE_BINARY_DIR}/SprekkConfigVersion.cmake
  DESTINATION ${config} COMPONENT development)
include(Debian)  # Debian packages of these components
