# How fast fields and meshes become bands, beside OpenVDB's own tools in the same run.
find_package(benchmark QUIET)
if(benchmark_FOUND)
  add_executable(palpate_bake_bench
    ${CMAKE_CURRENT_LIST_DIR}/bake_field_bench.cpp ${CMAKE_CURRENT_LIST_DIR}/bake_mesh_bench.cpp
    ${CMAKE_CURRENT_LIST_DIR}/bake_labels_bench.cpp
    ${PROJECT_SOURCE_DIR}/tests/vdb/shapes.cpp)
  set_target_properties(palpate_bake_bench PROPERTIES
    RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin CXX_EXTENSIONS OFF)
  target_include_directories(palpate_bake_bench PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  target_link_libraries(palpate_bake_bench PRIVATE
    palpate_flags palpate::core palpate::vdb benchmark::benchmark_main)
endif()
