# cmake -D SOURCE=... -D BINARY=... -D CONFIG=... -D SCRATCH=... -D COMPONENTS=... -P package_test.cmake
# Installs the build BINARY below SCRATCH, moves what was installed (a package must not know where it was
# put), and builds and runs an outside project against it.
cmake_minimum_required(VERSION 3.25)

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE "${SCRATCH}")
run(${CMAKE_COMMAND} --install "${BINARY}" --config "${CONFIG}" --prefix "${SCRATCH}/first")
file(RENAME "${SCRATCH}/first" "${SCRATCH}/installed")

run(${CMAKE_COMMAND} -G Ninja -S "${SOURCE}/tests/package" -B "${SCRATCH}/build"
  -D CMAKE_BUILD_TYPE=Release -D CMAKE_PREFIX_PATH=${SCRATCH}/installed
  -D README=${SOURCE}/README.md "-D COMPONENTS=${COMPONENTS}")
run(${CMAKE_COMMAND} --build "${SCRATCH}/build")
run("${SCRATCH}/build/consumer")

execute_process(COMMAND "${SCRATCH}/build/readme" OUTPUT_VARIABLE printed COMMAND_ERROR_IS_FATAL ANY)
file(READ "${SCRATCH}/build/readme.txt" promised)
if(NOT printed STREQUAL promised)
  message(FATAL_ERROR "the README's example prints\n${printed}where the README says\n${promised}")
endif()
