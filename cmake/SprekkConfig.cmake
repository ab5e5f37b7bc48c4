# find_package(Sprekk): link Sprekk::model, include "model/model.hpp". The project must have enabled C and C++.
include(${CMAKE_CURRENT_LIST_DIR}/Dependencies.cmake)
include(${CMAKE_CURRENT_LIST_DIR}/Sprekk.cmake)
