# External libraries, also used by an installed Sprekk. Trilinos 13.4 and later has complete imported targets. In 13.2
# targets have no include directories or are missing, hence the wrappers.
find_package(MPI REQUIRED COMPONENTS C CXX)
find_package(Trilinos REQUIRED COMPONENTS
  Tpetra Thyra ThyraTpetraAdapters Belos Ifpack2 MueLu NOX Sacado Kokkos Teuchos)
add_library(sprekk_trilinos INTERFACE IMPORTED)
target_link_libraries(sprekk_trilinos INTERFACE MPI::MPI_CXX)
# The C++ bindings of Open MPI are unused. Without this definition each object file contains them.
target_compile_definitions(sprekk_trilinos INTERFACE OMPI_SKIP_MPICXX)
if(TARGET Trilinos::all_selected_libs)
  target_link_libraries(sprekk_trilinos INTERFACE Trilinos::all_selected_libs)
else()
  target_include_directories(sprekk_trilinos SYSTEM INTERFACE ${Trilinos_INCLUDE_DIRS})
  target_link_libraries(sprekk_trilinos INTERFACE ${Trilinos_LIBRARIES})
endif()

function(sprekk_external target header library)
  find_path(${target}_INCLUDE ${header} REQUIRED)
  find_library(${target}_LIBRARY ${library} REQUIRED)
  add_library(${target} INTERFACE IMPORTED)
  target_include_directories(${target} SYSTEM INTERFACE ${${target}_INCLUDE})
  target_link_libraries(${target} INTERFACE ${${target}_LIBRARY})
endfunction()
sprekk_external(sprekk_metis metis.h metis)
sprekk_external(sprekk_mumps dmumps_c.h dmumps)
sprekk_external(sprekk_muparser muParser.h muparser)

find_package(fmt REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(CLI11 REQUIRED)
find_package(ZLIB REQUIRED)
set(HDF5_PREFER_PARALLEL ON)  # the variant of Trilinos
find_package(HDF5 REQUIRED COMPONENTS C HL)
find_package(VTK 9.1 REQUIRED COMPONENTS CommonCore CommonDataModel IOXML)
