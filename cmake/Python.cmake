# Python for tests and for the module sprekk. Debian's packages belong to its own interpreter, which may not be the
# first one found.
if(NOT Python_EXECUTABLE)
  find_program(SPREKK_PYTHON python3 PATHS /usr/bin NO_DEFAULT_PATH)
  find_program(SPREKK_PYTHON python3)
  set(Python_EXECUTABLE ${SPREKK_PYTHON})
endif()
set(SPREKK_PYTHON ${Python_EXECUTABLE})

# The module is built if pybind11 exists. The libraries it links are then position-independent code.
set(PYBIND11_FINDPYTHON ON)
find_package(Python QUIET COMPONENTS Interpreter Development.Module)
find_package(pybind11 2.10 QUIET)
if(pybind11_VERSION VERSION_GREATER_EQUAL 3)  # rejects call guards of properties
  message(STATUS "pybind11 ${pybind11_VERSION}: the Python module requires a version below 3")
  set(pybind11_FOUND FALSE)
endif()
set(SPREKK_PYTHON_MODULE ${pybind11_FOUND})
