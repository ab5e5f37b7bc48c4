# Debian packages: sprekk, the program with the package for Python, and libsprekk-dev, the libraries. `./sprekk package`
# runs cpack and adds the lists of packages that the launcher has: what the Python programs and hosts require.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "The Sprekk authors")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)

# The module is for one version of Python. Its files are compiled when the package is installed, as by dh_python3.
set(minor ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR})
math(EXPR next "${Python_VERSION_MINOR} + 1")
set(CPACK_DEBIAN_SPREKK_PACKAGE_NAME sprekk)
set(CPACK_DEBIAN_SPREKK_DESCRIPTION "mechanics, flow and heat in fractured rock")
set(CPACK_DEBIAN_SPREKK_PACKAGE_SHLIBDEPS ON)
string(JOIN ", " CPACK_DEBIAN_SPREKK_PACKAGE_DEPENDS openmpi-bin "libopenblas0-serial | libopenblas0"
  "python3 (>= ${minor})" "python3 (<< ${Python_VERSION_MAJOR}.${next})"
  python3-mpi4py python3-numpy python3-pandas python3-scipy)
set(CPACK_DEBIAN_SPREKK_PACKAGE_CONTROL_EXTRA ${CMAKE_SOURCE_DIR}/packaging/debian/postinst
  ${CMAKE_SOURCE_DIR}/packaging/debian/prerm)
set(CPACK_DEBIAN_SPREKK_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libsprekk-dev)
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION "libraries and headers of Sprekk for host programs")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)

include(CPack)
cpack_add_component_group(sprekk)
cpack_add_component(program GROUP sprekk)
cpack_add_component(python GROUP sprekk)
cpack_add_component_group(development)
cpack_add_component(development GROUP development)
