# Installs Sprekk to a temporary prefix. Configures, builds and runs hosts that use only this installation.
function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY OUTPUT_VARIABLE output)
endfunction()
file(REMOVE_RECURSE ${scratch})
run(${CMAKE_COMMAND} --install ${build} --prefix ${scratch}/prefix)
run(${scratch}/prefix/bin/sprekk check ${source}/xml/seed/push_2d.xml)
file(GLOB package ${scratch}/prefix/lib/python*/dist-packages)  # Python package, if it was built
if(package)
  run(${CMAKE_COMMAND} -E env PYTHONPATH=${package} ${python} -c
    "import sprekk; model = sprekk.Model(sprekk.Scene('${source}/xml/seed/push_2d.xml')); model.run()")
endif()
set(hosts ${source}/apps/hosts)
file(COPY ${source}/tests/embedding/outside/CMakeLists.txt ${source}/tests/embedding/outside/main.cpp
  ${hosts}/own_unknown.cpp ${hosts}/grout.hpp ${hosts}/coupled.cpp ${hosts}/coupled.hpp ${hosts}/own_flow.hpp
  ${hosts}/reservoir.hpp ${source}/apps/multigrid/elasticity.cpp DESTINATION ${scratch}/host)
run(${CMAKE_COMMAND} -S ${scratch}/host -B ${scratch}/build -G ${generator} -D CMAKE_PREFIX_PATH=${scratch}/prefix
  -D CMAKE_BUILD_TYPE=Release -D CMAKE_CXX_COMPILER_LAUNCHER=${launcher})
run(${CMAKE_COMMAND} --build ${scratch}/build)
run(${scratch}/build/my_host ${source}/xml/seed/push_2d.xml)
run(${scratch}/build/own_unknown ${hosts}/column.xml)
run(${scratch}/build/coupled)
run(${scratch}/build/elasticity)
