# Flag for precompiled headers, required by ccache.
set(SPREKK_PRECOMPILED $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)

# sprekk_grouped(RESULT PREFIX sources... [ALONE paths...])
# Sets RESULT to files that include the sources of each folder in groups of eight. A group reads each header once and
# instantiates each template once. Names in unnamed namespaces must therefore be unique in a folder. Sources named by
# ALONE remain single files: those with large kernels or own options. Without SPREKK_GROUPS all sources are single
# files. PREFIX is the path of the folder in #include.
function(sprekk_grouped result prefix)
  cmake_parse_arguments(ARG "" "" "ALONE" ${ARGN})
  set(files)
  set(groups)
  foreach(path ${ARG_ALONE})
    if(NOT ${CMAKE_CURRENT_SOURCE_DIR}/${path} IN_LIST ARG_UNPARSED_ARGUMENTS)
      message(FATAL_ERROR "ALONE: ${path} is no source of ${CMAKE_CURRENT_SOURCE_DIR}")
    endif()
  endforeach()
  foreach(source ${ARG_UNPARSED_ARGUMENTS})
    cmake_path(RELATIVE_PATH source BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} OUTPUT_VARIABLE path)
    if(NOT SPREKK_GROUPS OR path IN_LIST ARG_ALONE)
      list(APPEND files ${source})
      continue()
    endif()
    get_filename_component(folder ${path} DIRECTORY)
    string(REPLACE "/" "_" folder "${folder}")
    math(EXPR group "0${n_${folder}} / 8")
    math(EXPR n_${folder} "0${n_${folder}} + 1")
    set(file ${CMAKE_CURRENT_BINARY_DIR}/group_${folder}${group}.cpp)
    list(APPEND groups ${file})
    string(APPEND ${file} "#include \"${prefix}${path}\"\n")
  endforeach()
  list(REMOVE_DUPLICATES groups)
  foreach(file ${groups})
    file(CONFIGURE OUTPUT ${file} CONTENT "${${file}}" @ONLY)
  endforeach()
  set(${result} ${files} ${groups} PARENT_SCOPE)
endfunction()

# sprekk_unroll(sources...): compiles kernels with -O3, since unrolling and vectorisation halve their time. A
# precompiled header would replace these options.
function(sprekk_unroll)
  set_source_files_properties(${ARGN} PROPERTIES COMPILE_OPTIONS $<$<CONFIG:Release>:-O3> SKIP_PRECOMPILE_HEADERS ON)
endfunction()

# sprekk_package(NAME [USES packages...] [LINKS external targets...] [ALONE sources...])
# Adds a library of all .cpp files in the folder and its subfolders, or a header-only library. Includes have the form
# "package/header.hpp". For ALONE see sprekk_grouped.
function(sprekk_package name)
  cmake_parse_arguments(ARG "" "" "USES;LINKS;ALONE" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
  set(uses ${ARG_USES})
  list(TRANSFORM uses PREPEND sprekk_)
  if(sources)
    sprekk_grouped(sources ${name}/ ${sources} ALONE ${ARG_ALONE})
    add_library(sprekk_${name} STATIC ${sources})
    set(scope PUBLIC)
    if(SPREKK_PYTHON_MODULE)
      set_target_properties(sprekk_${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
      target_compile_options(sprekk_${name} PRIVATE -fno-semantic-interposition)
    endif()
    if(name STREQUAL base)
      target_precompile_headers(sprekk_base PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/precompiled.hpp)
    else()
      target_precompile_headers(sprekk_${name} REUSE_FROM sprekk_base)
    endif()
    target_compile_options(sprekk_${name} PRIVATE ${SPREKK_PRECOMPILED})
  else()
    add_library(sprekk_${name} INTERFACE)
    set(scope INTERFACE)
  endif()
  target_include_directories(sprekk_${name} ${scope}
    $<BUILD_INTERFACE:${CMAKE_SOURCE_DIR}/packages> $<INSTALL_INTERFACE:include/sprekk>)
  target_link_libraries(sprekk_${name} ${scope} sprekk_trilinos fmt::fmt ${uses} ${ARG_LINKS})
  target_compile_features(sprekk_${name} ${scope} cxx_std_20)
  set_target_properties(sprekk_${name} PROPERTIES EXPORT_NAME ${name})
  install(TARGETS sprekk_${name} EXPORT Sprekk COMPONENT development)
endfunction()

# Environment of tests. Open MPI may run as root, and uses shared memory directly, without a search for networks. A
# single rank starts without a daemon. mpirun counts one processor, so that waiting ranks yield it to others. A single
# rank does not wait, but MUMPS polls for messages.
set(SPREKK_TEST_ENVIRONMENT OMP_NUM_THREADS=1 OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
  OMPI_MCA_pml=ob1 OMPI_MCA_btl=self,vader OMPI_MCA_orte_set_default_slots=1 OMPI_MCA_ess_singleton_isolated=1)
if(CMAKE_SYSTEM_NAME STREQUAL Linux AND NOT SPREKK_SANITIZE)
  list(APPEND SPREKK_TEST_ENVIRONMENT LD_PRELOAD=$<TARGET_FILE:sprekk_patience>)  # tests of several ranks share processors
endif()

# sprekk_test(NAME COMMAND words... [CONFIGURATIONS of ctest -C] [PROPERTIES name value...])
# Its label, for ctest -L, is SPREKK_TEST_LABEL of the folder: fast, slow, report, perf, or packages.
# The time limit is for tests that hang. The longest test takes a tenth of it on two cores.
function(sprekk_test name)
  cmake_parse_arguments(ARG "" "" "COMMAND;CONFIGURATIONS;PROPERTIES" ${ARGN})
  if(NOT SPREKK_TEST_LABEL)
    message(FATAL_ERROR "${name}: set SPREKK_TEST_LABEL to fast, slow, report, perf or packages in this folder or above")
  endif()
  add_test(NAME ${name} COMMAND ${ARG_COMMAND} CONFIGURATIONS ${ARG_CONFIGURATIONS})
  set_tests_properties(${name} PROPERTIES LABELS ${SPREKK_TEST_LABEL} TIMEOUT 1500
    ENVIRONMENT "${SPREKK_TEST_ENVIRONMENT}" ${ARG_PROPERTIES})
endfunction()

# sprekk_tests(NAME [RANKS 1 2 3] [LINKS targets...])
# Adds one GoogleTest program of all .cpp files in the current folder, run on each number of ranks. Tests of whole
# scenes, which link sprekk_model, share a precompiled header.
function(sprekk_tests name)
  cmake_parse_arguments(ARG "" "" "RANKS;LINKS" ${ARGN})
  if(NOT ARG_RANKS)
    set(ARG_RANKS 1 2 3)
  endif()
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
  if(NOT sources)
    return()
  endif()
  cmake_path(RELATIVE_PATH CMAKE_CURRENT_SOURCE_DIR BASE_DIRECTORY ${CMAKE_SOURCE_DIR}/tests OUTPUT_VARIABLE folder)
  sprekk_grouped(sources ${folder}/ ${sources})
  add_executable(test_${name} ${sources})
  target_link_libraries(test_${name} PRIVATE sprekk_test_main ${ARG_LINKS})
  if("sprekk_model" IN_LIST ARG_LINKS)
    target_precompile_headers(test_${name} REUSE_FROM sprekk_test_scenes)
    target_compile_options(test_${name} PRIVATE ${SPREKK_PRECOMPILED})
  endif()
  foreach(ranks ${ARG_RANKS})
    sprekk_test(${name}.${ranks}
      COMMAND ${MPIEXEC_EXECUTABLE} --oversubscribe --bind-to none -np ${ranks} $<TARGET_FILE:test_${name}>
      PROPERTIES PROCESSORS ${ranks})
  endforeach()
endfunction()
