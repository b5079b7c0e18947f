# What only the top-level project decides: build type, compiler cache, compile_commands.json.

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

if(NOT CMAKE_CXX_COMPILER_LAUNCHER)
  find_program(GYRE_CCACHE ccache)
  if(GYRE_CCACHE)
    set(CMAKE_CXX_COMPILER_LAUNCHER "${GYRE_CCACHE}")
  endif()
endif()
