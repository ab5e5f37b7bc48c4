# The install tree: the program, the packages as libraries with their headers, and what find_package(Sprekk) reads.
include(CMakePackageConfigHelpers)
set(config ${CMAKE_INSTALL_LIBDIR}/cmake/Sprekk)
install(TARGETS sprekk_app)
install(DIRECTORY packages/ DESTINATION include/sprekk
  FILES_MATCHING PATTERN "*.hpp" PATTERN precompiled.hpp EXCLUDE)
install(EXPORT Sprekk NAMESPACE Sprekk:: DESTINATION ${config})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/SprekkConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES cmake/SprekkConfig.cmake cmake/Dependencies.cmake ${CMAKE_BINARY_DIR}/SprekkConfigVersion.cmake
  DESTINATION ${config})
