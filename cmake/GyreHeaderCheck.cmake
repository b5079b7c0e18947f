# Each header must compile alone: one generated source per header that includes it and nothing else.
option(GYRE_CHECK_HEADERS "Compile each header alone" ON)
if(NOT GYRE_CHECK_HEADERS OR GYRE_SANITIZE OR GYRE_COVERAGE)
  return()
endif()

file(GLOB_RECURSE headers CONFIGURE_DEPENDS
  ${PROJECT_SOURCE_DIR}/include/gyre/*.h ${PROJECT_SOURCE_DIR}/src/*.h ${PROJECT_SOURCE_DIR}/scene/*.h ${PROJECT_SOURCE_DIR}/kit/*.h)
set(sources)
foreach(header IN LISTS headers)
  file(RELATIVE_PATH name ${PROJECT_SOURCE_DIR} ${header})
  string(MAKE_C_IDENTIFIER ${name} plain)
  set(source ${PROJECT_BINARY_DIR}/header_check/${plain}.cpp)
  file(CONFIGURE OUTPUT ${source} CONTENT "#include \"${header}\"\n")
  list(APPEND sources ${source})
endforeach()

add_library(header_check OBJECT ${sources})
gyre_target_defaults(header_check)
target_compile_options(header_check PRIVATE $<$<CXX_COMPILER_ID:GNU,Clang>:-O0>)
target_include_directories(header_check PRIVATE ${PROJECT_SOURCE_DIR}/src)
target_link_libraries(header_check PRIVATE gyre::gyre gyre_scene)
