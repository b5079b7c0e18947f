# Test programs.
#
#   gyre_add_gtest(name source...)  one GoogleTest program; every test in it becomes a ctest test
#   gyre_add_folder_tests(folder prefix)  one program for each sub-folder that holds *_test.cpp
#     (tests of kernels may add files named <unit>_test_kernels_<target>.cpp, compiled for that target)
#
# A suite whose name begins with Long carries the label `long`: `ctest -LE long` leaves it out.

find_package(GTest REQUIRED)
include(GoogleTest)

set(GYRE_TEST_TIMEOUT 120 CACHE STRING "Seconds that a quick test may take")
set(GYRE_LONG_TEST_TIMEOUT 1800 CACHE STRING "Seconds that a long test may take")

function(gyre_add_gtest name)
  add_executable(${name} ${ARGN})
  gyre_target_defaults(${name})
  gyre_quick_to_compile(${name})
  foreach(source IN LISTS ARGN)
    # Kernels must be inlined; and a test of the compiler's rounding wants the optimiser that the library gets.
    if(gyre_gnu_like AND source MATCHES "(_kernels_[a-z0-9]+|/math/.*_test)\\.cpp$")
      set_property(SOURCE ${source} APPEND PROPERTY COMPILE_OPTIONS $<$<CONFIG:Release>:-O3>)
    endif()
  endforeach()
  # Eight files are one unit: GoogleTest's headers, most of the work, are read once. Each file has a namespace of its own.
  set_target_properties(${name} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 8)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # GCC takes every file but the first of a unit for a header.
    target_compile_options(${name} PRIVATE -Wno-subobject-linkage)
  endif()
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/src ${PROJECT_SOURCE_DIR}/tests)
  target_compile_definitions(${name} PRIVATE
    GYRE_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
    GYRE_BINARY_DIR="${PROJECT_BINARY_DIR}")
  if(gyre_gnu_like)
    # Tests fill in the fields they are about, also of internal structs.
    target_compile_options(${name} PRIVATE -Wno-missing-field-initializers)
  endif()
  if(CMAKE_CXX_COMPILER_ID MATCHES "Clang")
    # GoogleTest's own macros end in an empty variadic argument.
    target_compile_options(${name} PRIVATE -Wno-gnu-zero-variadic-macro-arguments)
  endif()
  target_link_libraries(${name} PRIVATE gyre::gyre gyre_scene GTest::gtest GTest::gtest_main)
  # Tests of the command line start the program; they find it here. Only they wait for it to be built.
  target_compile_definitions(${name} PRIVATE GYRE_CLI="${PROJECT_BINARY_DIR}/bin/gyre")
  if(TARGET gyre_cli)
    foreach(source IN LISTS ARGN)
      file(STRINGS ${source} uses_cli REGEX "GYRE_CLI" LIMIT_COUNT 1)
      if(uses_cli)
        add_dependencies(${name} gyre_cli)
        break()
      endif()
    endforeach()
  endif()
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin/tests)
  # Tests are listed as folder.Suite.Test, so that `ctest -R '^geometry'` picks a folder and no two share a name.
  string(REGEX REPLACE "^tests?_" "" folder ${name})
  gtest_discover_tests(${name}
    DISCOVERY_MODE PRE_TEST
    DISCOVERY_TIMEOUT 60
    WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}
    TEST_PREFIX ${folder}.
    TEST_FILTER "-Long*:*/Long*"
    PROPERTIES TIMEOUT ${GYRE_TEST_TIMEOUT})
  gtest_discover_tests(${name}
    DISCOVERY_MODE PRE_TEST
    DISCOVERY_TIMEOUT 60
    WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}
    TEST_PREFIX ${folder}.
    TEST_FILTER "Long*:*/Long*"
    PROPERTIES TIMEOUT ${GYRE_LONG_TEST_TIMEOUT} LABELS long)
endfunction()

function(gyre_add_folder_tests folder prefix)
  file(GLOB_RECURSE files CONFIGURE_DEPENDS ${folder}/*_test.cpp ${folder}/*_test_kernels_*.cpp)
  gyre_kernel_flags(files)
  set(names)
  foreach(file IN LISTS files)
    file(RELATIVE_PATH relative ${folder} ${file})
    # Tests right inside the folder belong to a program named after the prefix alone.
    set(name ${prefix})
    if(relative MATCHES "^([^/]+)/")
      set(name ${prefix}_${CMAKE_MATCH_1})
    endif()
    list(APPEND names ${name})
    list(APPEND sources_${name} ${file})
  endforeach()
  list(REMOVE_DUPLICATES names)
  foreach(name IN LISTS names)
    gyre_add_gtest(${name} ${sources_${name}})
  endforeach()
endfunction()
