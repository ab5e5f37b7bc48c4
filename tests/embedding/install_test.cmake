# Installs into a scratch prefix, and configures, builds and runs a host there that knows of nothing else.
function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY OUTPUT_VARIABLE output)
endfunction()
file(REMOVE_RECURSE ${scratch})
run(${CMAKE_COMMAND} --install ${build} --prefix ${scratch}/prefix)
run(${scratch}/prefix/bin/sprekk check ${source}/xml/seed/push_2d.xml)
file(COPY ${source}/tests/embedding/outside/CMakeLists.txt DESTINATION ${scratch}/host)
configure_file(${source}/apps/hosts/time_loop.cpp ${scratch}/host/main.cpp COPYONLY)
run(${CMAKE_COMMAND} -S ${scratch}/host -B ${scratch}/build -G ${generator} -D CMAKE_PREFIX_PATH=${scratch}/prefix
  -D CMAKE_BUILD_TYPE=Release -D CMAKE_CXX_COMPILER_LAUNCHER=${launcher})
run(${CMAKE_COMMAND} --build ${scratch}/build)
run(${scratch}/build/my_host)
