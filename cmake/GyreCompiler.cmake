# Compiler flags, each in one function.
#
#   gyre_target_defaults(target)  language level, warnings, floating point: everything of ours
#   gyre_core_flags(target)       the core library alone: no exceptions, no RTTI
#   gyre_quick_to_compile(target)  for programs whose time passes in the libraries
#   gyre_kernel_flags()           per-file instruction sets of the SIMD kernels
#   gyre_unity_rooms(target sources)  what CMAKE_UNITY_BUILD compiles at once
#   gyre_room_of(source result)  the room of a source, as one word

set(gyre_gnu_like OFF)
if(CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang")
  set(gyre_gnu_like ON)
endif()
set(gyre_x86 OFF)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64|amd64|x64)$" AND NOT EMSCRIPTEN)
  set(gyre_x86 ON)
endif()
set(gyre_arm64 OFF)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(aarch64|arm64|ARM64)$" AND NOT EMSCRIPTEN)
  set(gyre_arm64 ON)
endif()

# What keeps results the same everywhere. Public: the inline functions of <gyre/math.h> are compiled into the user's objects too,
# and the linker may keep the user's copy for the library.
#
# - No contraction: a fused multiply-add rounds once where two operations round twice.
# - GCC 12 drops the rounding of neighbouring doubles to float and back when it vectorises straight-line code on x86, at -O2
#   already and at strict settings: {float(a), float(b)} stored as doubles are a and b. A test in src/math watches for it.
set(gyre_float_options)
if(gyre_gnu_like)
  set(gyre_float_options -ffp-contract=off)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    list(APPEND gyre_float_options -fno-tree-slp-vectorize)
  endif()
elseif(MSVC)
  set(gyre_float_options /fp:precise)
endif()

function(gyre_target_defaults target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF UNITY_BUILD OFF)
  if(NOT EMSCRIPTEN)  # a WebAssembly module is not shared, and indirect addresses cost time there
    set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  endif()
  target_compile_options(${target} PRIVATE ${gyre_float_options})
  if(gyre_gnu_like)
    target_compile_options(${target} PRIVATE -fno-math-errno -Wall -Wextra -Wpedantic -Wshadow -Wconversion)
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
      # GCC 12 sees overlapping copies inside std::string that are not there (GCC bug 105329).
      target_compile_options(${target} PRIVATE -Wno-restrict)
    endif()
    if(GYRE_WERROR)
      target_compile_options(${target} PRIVATE -Werror)
    endif()
  elseif(MSVC)
    target_compile_options(${target} PRIVATE /W4 /utf-8)
    if(GYRE_WERROR)
      target_compile_options(${target} PRIVATE /WX)
    endif()
  endif()
  gyre_instrument(${target})
endfunction()

# Sanitizers and coverage. `vptr` needs RTTI, which the core does without.
function(gyre_instrument target)
  if(GYRE_SANITIZE)
    string(REPLACE ";" "," sanitizers "${GYRE_SANITIZE}")
    set(flags -fsanitize=${sanitizers} -fno-omit-frame-pointer)
    if(sanitizers MATCHES "undefined")
      list(APPEND flags -fno-sanitize=vptr -fno-sanitize-recover=all)
    endif()
    target_compile_options(${target} PRIVATE ${flags})
    target_link_options(${target} PUBLIC -fsanitize=${sanitizers})
  endif()
  if(GYRE_COVERAGE)
    target_compile_options(${target} PRIVATE --coverage -fprofile-update=atomic)
    target_link_options(${target} PUBLIC --coverage)
  endif()
  if(GYRE_BUILD_FUZZ)
    target_compile_options(${target} PRIVATE -fsanitize=fuzzer-no-link)
  endif()
endfunction()

function(gyre_core_flags target)
  if(gyre_gnu_like)
    target_compile_options(${target} INTERFACE
      $<$<COMPILE_LANG_AND_ID:CXX,GNU,Clang,AppleClang>:-ffp-contract=off>
      $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-fno-tree-slp-vectorize>)
    target_compile_options(${target} PRIVATE -fno-exceptions -fno-rtti)
    # Position-independent code keeps every function that can be seen from outside replaceable at load time, so none of them is
    # inlined or called directly, not even within its file: 0.99 of the time without that (docs/performance.md).
    get_target_property(kind ${target} TYPE)
    if(kind STREQUAL "SHARED_LIBRARY")
      target_compile_options(${target} PRIVATE $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-fno-semantic-interposition>)
    else()
      target_compile_options(${target} PRIVATE -fvisibility=hidden)
    endif()
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND gyre_x86)
      # GCC clears and copies structures of a few hundred bytes by `rep stos` and `rep movs`, whose start alone takes longer
      # than the unrolled stores: 0.97 of the time over five scenes (docs/performance.md).
      set(small "unrolled_loop:1024:noalign,libcall:-1:noalign")
      target_compile_options(${target} PRIVATE -mmemset-strategy=${small} -mmemcpy-strategy=${small})
    endif()
  elseif(MSVC)
    target_compile_options(${target} PRIVATE /GR- /EHs-c- /D_HAS_EXCEPTIONS=0)
  endif()
endfunction()

# Optimised only as far as it is cheap. Results are the same bits at any level.
function(gyre_quick_to_compile target)
  if(gyre_gnu_like)
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
  endif()
endfunction()

# Kernel files are named <unit>_kernels_<target>.cpp. The caller passes all sources; those for another processor are
# removed, and the rest get their instruction set. Never -mfma: contraction stays off, and so do the fused operations.
# -Wno-psabi silences GCC's note about passing wide vectors, which never cross a library boundary here.
function(gyre_kernel_flags sources_variable)
  set(sources ${${sources_variable}})
  set(kept)
  foreach(source IN LISTS sources)
    if(NOT source MATCHES "_kernels_([a-z0-9]+)\\.cpp$")
      list(APPEND kept "${source}")
      continue()
    endif()
    set(width "${CMAKE_MATCH_1}")
    set(flags)
    set(usable ON)
    # sse2 is what every x86-64 has, so it needs no flag. Written with the compilers' vector types, it is also the kernel of
    # four lanes on other processors.
    if(width STREQUAL "avx2")
      set(usable ${gyre_x86})
      set(flags -mavx2)
    elseif(width MATCHES "^avx512(vl)?$")
      set(usable ${gyre_x86})
      set(flags -mavx512f -mavx512vl -mavx512dq -mavx512bw)
    elseif(width STREQUAL "neon")
      set(usable ${gyre_arm64})
    elseif(width STREQUAL "wasm")
      set(usable OFF)
      if(EMSCRIPTEN)
        set(usable ON)
        set(flags -msimd128)
      endif()
    elseif(NOT width MATCHES "^(w1|sse2)$")
      message(FATAL_ERROR "${source}: '${width}' is not a kernel target (w1, sse2, avx2, avx512, avx512vl, neon, wasm)")
    endif()
    if(NOT usable)
      continue()
    endif()
    list(APPEND kept "${source}")
    if(gyre_gnu_like)
      if(GYRE_SANITIZE MATCHES "undefined")
        # Doubles what clang takes for a kernel (two minutes for 16 lanes), and what it finds is out of bounds too.
        list(APPEND flags -fno-sanitize=pointer-overflow)
      endif()
      set_source_files_properties("${source}" PROPERTIES COMPILE_OPTIONS "${flags};-Wno-psabi")
    elseif(MSVC AND width STREQUAL "avx2")
      set_source_files_properties("${source}" PROPERTIES COMPILE_OPTIONS "/arch:AVX2")
    elseif(MSVC AND width MATCHES "^avx512")
      set_source_files_properties("${source}" PROPERTIES COMPILE_OPTIONS "/arch:AVX512")
    endif()
  endforeach()
  set(${sources_variable} ${kept} PARENT_SCOPE)
endfunction()

# src/geometry/query/cast.cpp stands in the room geometry_query, scene/schema.cpp in scene.
function(gyre_room_of source result)
  file(RELATIVE_PATH room ${PROJECT_SOURCE_DIR} "${source}")
  get_filename_component(room "${room}" DIRECTORY)
  string(REGEX REPLACE "^src/" "" room "${room}")
  string(REPLACE "/" "_" room "${room}")
  set(${result} "${room}" PARENT_SCOPE)
endfunction()

# With CMAKE_UNITY_BUILD a room (a folder without its sub-folders) is one unit: its headers, most of the work, are read once. So names
# without linkage are unique within their room. Kernels stay apart, each with its flags.
#
# IN_RELEASE asks for it in every release build: for programs of ours, whose files nobody else compiles.
function(gyre_unity_rooms target sources)
  set(unity OFF)
  if(CMAKE_UNITY_BUILD OR ("IN_RELEASE" IN_LIST ARGN AND CMAKE_BUILD_TYPE STREQUAL "Release"))
    set(unity ON)
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${unity} UNITY_BUILD_MODE GROUP)
  foreach(source IN LISTS sources)
    if(NOT source MATCHES "_kernels_[a-z0-9]+\\.cpp$")
      gyre_room_of("${source}" room)
      set_source_files_properties("${source}" PROPERTIES UNITY_GROUP ${room})
    endif()
  endforeach()
  if(unity AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # GCC takes every file but the first of a unit for a header.
    target_compile_options(${target} PRIVATE -Wno-subobject-linkage)
    if(GYRE_SANITIZE)  # what the address sanitizer watches looks as if nobody had written it
      target_compile_options(${target} PRIVATE -Wno-maybe-uninitialized)
    endif()
  endif()
endfunction()
