# cmake -D SOURCE=... -D BINARY=... -D CONFIG=... -D SCRATCH=... -D COMPONENTS=... [-D SHARED=ON -D LAUNCHER=...] -P package_test.cmake
# Installs the build BINARY below SCRATCH, moves the installation (a package must not depend on
# where it was put), and builds and runs an outside project against it. With SHARED, core and
# devices are first built as shared libraries in BINARY.
cmake_minimum_required(VERSION 3.25)

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE "${SCRATCH}")
if(SHARED)
  run(${CMAKE_COMMAND} -G Ninja -S "${SOURCE}" -B "${BINARY}"
    -D CMAKE_BUILD_TYPE=${CONFIG} -D CMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}
    -D BUILD_SHARED_LIBS=ON -D PALPATE_VDB=OFF -D PALPATE_TESTS=OFF)
  run(${CMAKE_COMMAND} --build "${BINARY}" --parallel 2)
endif()
run(${CMAKE_COMMAND} --install "${BINARY}" --config "${CONFIG}" --prefix "${SCRATCH}/first")
file(RENAME "${SCRATCH}/first" "${SCRATCH}/installed")

# The public headers, and nothing else.
file(GLOB_RECURSE installed RELATIVE "${SCRATCH}/installed/include" "${SCRATCH}/installed/include/*")
list(LENGTH installed count)
message(STATUS "${count} headers were installed")
foreach(header IN LISTS installed)
  file(GLOB public "${SOURCE}/*/include/${header}" "${BINARY}/include/${header}")
  if(NOT public)
    message(FATAL_ERROR "${header} is not a public header, and was installed")
  endif()
endforeach()

# The files that come with them: license, history, scenes beside the schema that they name, and the
# files of the command.
set(promised share/doc/palpate/LICENSE share/doc/palpate/CHANGELOG.md share/palpate/scenes/container.yaml
  share/palpate/scenes/contrast.nrrd share/palpate/schema/scene-1.json)
if(EXISTS "${SCRATCH}/installed/bin/palpate")
  list(APPEND promised share/man/man1/palpate.1 share/bash-completion/completions/palpate
    share/zsh/site-functions/_palpate share/fish/vendor_completions.d/palpate.fish)
endif()
foreach(file IN LISTS promised)
  if(NOT EXISTS "${SCRATCH}/installed/${file}")
    message(FATAL_ERROR "${file} was not installed")
  endif()
endforeach()
file(STRINGS "${SCRATCH}/installed/share/palpate/scenes/container.yaml" schema REGEX "schema=" LIMIT_COUNT 1)
string(REGEX REPLACE ".*[$]schema=" "" schema "${schema}")
if(NOT EXISTS "${SCRATCH}/installed/share/palpate/scenes/${schema}")
  message(FATAL_ERROR "the installed scenes name the schema ${schema}, which is not there")
endif()
if(EXISTS "${SCRATCH}/installed/bin/palpate")
  run("${SCRATCH}/installed/bin/palpate" touch "${SCRATCH}/installed/share/palpate/scenes/contrast.yaml"
    --press 0,0,0 --quiet)
endif()

# A shared library exports its public interface only.
file(GLOB_RECURSE shared "${SCRATCH}/installed/libpalpate_core.so")
if(shared)
  execute_process(COMMAND nm --dynamic --defined-only --demangle "${shared}"
    OUTPUT_VARIABLE symbols COMMAND_ERROR_IS_FATAL ANY)
  if(NOT symbols MATCHES "palpate::makeRenderer" OR symbols MATCHES "palpate::(ProxySolver|NearCells|sweep)[:(]")
    message(FATAL_ERROR "what ${shared} shows is not its face")
  endif()
endif()

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

# The same outside project by pkg-config, without CMake.
file(GLOB_RECURSE found "${SCRATCH}/installed/*/palpate-core.pc")
cmake_path(GET found PARENT_PATH pkgconfig)
list(TRANSFORM COMPONENTS PREPEND palpate- OUTPUT_VARIABLE packages)
list(TRANSFORM COMPONENTS REPLACE "(.+)" "-DWITH_\\1" OUTPUT_VARIABLE definitions)
list(JOIN packages " " packages)
list(JOIN definitions " " definitions)
cmake_path(GET pkgconfig PARENT_PATH libraries)
run(${CMAKE_COMMAND} -E env "PKG_CONFIG_PATH=${pkgconfig}" "LD_LIBRARY_PATH=${libraries}" sh -c
  "set -e; c++ -std=c++20 ${definitions} '${SOURCE}/tests/package/main.cpp' -o '${SCRATCH}/by_pkg_config' \
    $(pkg-config --cflags --libs ${packages}); '${SCRATCH}/by_pkg_config'")
