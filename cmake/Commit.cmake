# Writes OUTPUT, a source file that defines the commit of the tree SOURCE, if it has changed. -dirty: with changes that are
# not committed. In a source archive git has replaced the placeholder in commit.txt.
cmake_minimum_required(VERSION 3.25)
if(EXISTS ${SOURCE}/.git)
  execute_process(COMMAND ${CMAKE_COMMAND} -E env GIT_OPTIONAL_LOCKS=0 git -C ${SOURCE} describe --always --dirty --abbrev=9 --exclude=*
    OUTPUT_VARIABLE commit ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
else()
  file(STRINGS ${SOURCE}/cmake/commit.txt commit)
endif()
if(NOT commit MATCHES "^[0-9a-f]+(-dirty)?$")
  set(commit unknown)
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "extern const char* const sprekk_commit;\nconst char* const sprekk_commit = \"@commit@\";\n" @ONLY)
