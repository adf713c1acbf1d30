# cmake -D ROOT=... -P check_arrows.cmake
# Fails on an include that the design's arrows do not allow:
#   tools -> devices, vdb, lib;  devices -> lib;  vdb -> lib;  lib -> nobody
#   inside lib: render -> scene -> {contact, interior} -> materials -> fields -> core
# vdb and devices may include public headers of each other (<module>/include), and the private ones
# of lib's core, whose symbols are exported; tools also all private headers that do not belong to
# one source folder (<module>/private). Target visibility does not check this: /usr/include is
# always on the path, and so are a static library's own headers. Tests may include everything.
cmake_minimum_required(VERSION 3.25)

# The modules that each module may include, besides itself.
set(modules_lib "")
set(modules_vdb lib)
set(modules_devices lib)
set(modules_tools lib vdb devices)

# The layers of lib that each layer of lib may include, besides itself.
set(layers_core "")
set(layers_fields core)
set(layers_materials fields ${layers_fields})
set(layers_contact materials ${layers_materials})
set(layers_interior materials ${layers_materials})
set(layers_scene contact interior ${layers_contact})
set(layers_render scene ${layers_scene})

# Headers that every file may include: they are outside the layers, or made when the build is
# configured.
set(common palpate/export.h palpate/version.h own_vocabulary.h)

# Libraries that only one place may include: regular expression of the include, then the allowed
# place.
set(confined_names openvdb tbb imath assimp nifti gdcm boost yaml eigen libusb evdev)
set(confined_openvdb "^openvdb/" "^vdb/")
set(confined_tbb "^(tbb|oneapi)/" "^vdb/")
set(confined_imath "^(Imath|OpenEXR)/" "^vdb/")
set(confined_assimp "^assimp/" "^vdb/src/")
set(confined_nifti "^(nifti/.*|nifti[12]?(_io)?|nifticdf|znzlib)[.]h$|^nifti/" "^vdb/src/")
set(confined_gdcm "^gdcm" "^vdb/src/image/")
set(confined_boost "^boost/" "^(vdb/|devices/src/inverse3/|tools/src/view/)")
set(confined_libusb "^libusb(-1[.]0/libusb)?[.]h$" "^devices/src/usb/")
set(confined_evdev "^linux/input" "^devices/src/evdev/")
set(confined_yaml "^yaml-cpp/" "^lib/src/scene/")
set(confined_eigen "^(unsupported/)?Eigen/" "^devices/src/")

set(wrong 0)
macro(complain file what)
  message(STATUS "${file}: ${what}")
  math(EXPR wrong "${wrong} + 1")
endmacro()

# The module and, within lib, the layer that a file of ours belongs to.
function(place file module_out layer_out)
  string(REGEX MATCH "^[^/]+" module "${file}")
  set(layer "")
  if(module STREQUAL "lib" AND file MATCHES "^lib/(include/palpate|private/palpate|src)/([^/]+)/")
    set(layer "${CMAKE_MATCH_2}")
  endif()
  set(${module_out} "${module}" PARENT_SCOPE)
  set(${layer_out} "${layer}" PARENT_SCOPE)
endfunction()

# The file of ours that `included` means in `file`, relative to ROOT; empty if it is not one of
# ours.
function(resolve file included out)
  cmake_path(GET file PARENT_PATH folder)
  string(REGEX MATCH "^[^/]+" module "${file}")
  foreach(base "${folder}" "${module}/src" lib/include vdb/include devices/include lib/private vdb/private devices/private)
    set(candidate "${base}/${included}")
    cmake_path(NORMAL_PATH candidate)
    # Or a file that CMake makes from a template beside it.
    if(EXISTS "${ROOT}/${candidate}" OR EXISTS "${ROOT}/${candidate}.in")
      set(${out} "${candidate}" PARENT_SCOPE)
      return()
    endif()
  endforeach()
  set(${out} "" PARENT_SCOPE)
endfunction()

file(GLOB_RECURSE files RELATIVE "${ROOT}"
  "${ROOT}/lib/*.h" "${ROOT}/vdb/*.h" "${ROOT}/devices/*.h" "${ROOT}/tools/*.h"
  "${ROOT}/lib/*.cpp" "${ROOT}/vdb/*.cpp" "${ROOT}/devices/*.cpp" "${ROOT}/tools/*.cpp")
list(LENGTH files count)
if(count EQUAL 0)
  message(FATAL_ERROR "no sources below '${ROOT}'")
endif()

foreach(file IN LISTS files)
  place("${file}" module layer)
  if(module STREQUAL "lib" AND NOT file MATCHES "^lib/include/palpate/export.h$" AND NOT DEFINED "layers_${layer}")
    complain("${file}" "'${layer}' is not a layer of lib that this check knows")
    continue()
  endif()

  file(READ "${ROOT}/${file}" text)
  # Only the include itself is kept: brackets and semicolons behind it would break a CMake list.
  string(REGEX MATCHALL "\n[ \t]*#[ \t]*include[ \t]*[<\"][^>\"\n]+" lines "\n${text}")
  foreach(line IN LISTS lines)
    string(REGEX REPLACE ".*[<\"]" "" included "${line}")

    foreach(name IN LISTS confined_names)
      list(GET confined_${name} 0 what)
      list(GET confined_${name} 1 where)
      if(included MATCHES "${what}" AND NOT file MATCHES "${where}")
        complain("${file}" "includes ${included}: only ${where} may know it")
      endif()
    endforeach()

    if(included IN_LIST common)
      continue()
    endif()
    resolve("${file}" "${included}" target)
    if(target)
      place("${target}" target_module target_layer)
      if(NOT target_module STREQUAL module)
        if(NOT target_module IN_LIST modules_${module})
          complain("${file}" "includes ${included}: ${module} must not know ${target_module}")
        elseif(NOT (target MATCHES "/include/" OR (target MATCHES "^lib/private/palpate/core/" AND file MATCHES "/src/")
                    OR (module STREQUAL "tools" AND target MATCHES "^[^/]+/private/")))
          complain("${file}" "includes ${included}: it is private to ${target_module}")
        endif()
      elseif(module STREQUAL "lib" AND NOT target_layer STREQUAL layer
             AND NOT target_layer IN_LIST layers_${layer})
        complain("${file}" "includes ${included}: within lib, ${layer} must not know ${target_layer}")
      elseif(file MATCHES "^[^/]+/include/" AND NOT target MATCHES "^[^/]+/include/")
        complain("${file}" "includes ${included}: a public header must not need a private one")
      endif()
    elseif(included MATCHES "^palpate/")
      complain("${file}" "includes ${included}: there is no such header")
    elseif(module STREQUAL "lib" AND NOT included MATCHES "^(glm|yaml-cpp)/" AND included MATCHES "[./]")
      # The rest is the standard library, whose headers have neither a folder nor a suffix.
      complain("${file}" "includes ${included}: lib knows the C++ standard library and GLM only")
    endif()
  endforeach()
endforeach()

if(wrong GREATER 0)
  message(FATAL_ERROR "${wrong} of the includes in ${count} files run against the arrows")
endif()
message(STATUS "${count} files keep to the arrows")
