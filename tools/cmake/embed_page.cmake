# cmake -D PAGE=folder -D OUT=file.cpp -P embed_page.cmake
# Writes a source file that contains the files of the page: pageFiles() of
# tools/src/view/page_files.h. If the folder holds no page (index.html, made by
# tools/page/build.sh), the source contains none. Written only if something is new.
cmake_minimum_required(VERSION 3.25)

set(types ".html" text/html ".js" text/javascript ".css" text/css ".svg" image/svg+xml ".txt" text/plain)

set(files "")
if(EXISTS "${PAGE}/index.html")
  file(GLOB_RECURSE files RELATIVE "${PAGE}" "${PAGE}/*")
  list(SORT files)
endif()

set(blocks "")
set(entries "")
set(number 0)
foreach(file IN LISTS files)
  get_filename_component(suffix "${file}" LAST_EXT)
  list(FIND types "${suffix}" at)
  if(at EQUAL -1)
    message(FATAL_ERROR "the page has a file of a kind that is not known: ${file}")
  endif()
  math(EXPR at "${at} + 1")
  list(GET types ${at} type)
  file(SHA256 "${PAGE}/${file}" hash)
  file(SIZE "${PAGE}/${file}" size)
  set(name palpate_page_${number})
  # The hash makes the compiler run again when the file has changed.
  string(APPEND blocks "// ${file} ${hash}\n"
    "asm(\".section .rodata\\n.global ${name}\\n${name}:\\n.incbin \\\"${PAGE}/${file}\\\"\\n.byte 0\\n.previous\\n\");\n"
    "extern \"C\" const char ${name}[];\n")
  string(APPEND entries "    {\"${file}\", \"${type};charset=utf-8\", {${name}, ${size}}},\n")
  math(EXPR number "${number} + 1")
endforeach()

set(table "  return {};\n")
if(number GREATER 0)
  set(table "  static const std::array<PageFile, ${number}> files = {{\n${entries}  }};\n  return files;\n")
endif()
string(CONCAT text "// Made by tools/cmake/embed_page.cmake.\n#include \"view/page_files.h\"\n\n#include <array>\n\n" "${blocks}"
  "\nnamespace palpate::tools {\n\nstd::span<const PageFile> pageFiles() noexcept {\n" "${table}"
  "}\n\n}  // namespace palpate::tools\n")
set(before "")
if(EXISTS "${OUT}")
  file(READ "${OUT}" before)
endif()
if(NOT before STREQUAL text)
  file(WRITE "${OUT}" "${text}")
endif()
