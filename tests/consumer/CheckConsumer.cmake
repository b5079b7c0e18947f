# Builds and runs the consumer in this folder. Run with cmake -P and
#   -DWAY=install | find_package | fetch_content | pkg_config
#   -DGYRE_SOURCE=, -DGYRE_BUILD=, -DWORK= (a scratch folder), -DCXX=, -DGENERATOR=, -DLAUNCHER=, -DWERROR=

set(prefix ${WORK}/prefix)
set(folder ${WORK}/${WAY})
file(REMOVE_RECURSE ${folder})
file(MAKE_DIRECTORY ${folder})

function(must)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_VARIABLE output)
  message("${output}")
  if(NOT code EQUAL 0)
    string(REPLACE ";" " " command "${ARGN}")
    message(FATAL_ERROR "This failed (${code}): ${command}")
  endif()
endfunction()

if(WAY STREQUAL "install")
  file(REMOVE_RECURSE ${prefix} ${WORK}/moved)
  must(${CMAKE_COMMAND} --install ${GYRE_BUILD} --prefix ${prefix})
  # An installed tree must not know where it was built or first put.
  file(RENAME ${prefix} ${WORK}/moved)
elseif(WAY STREQUAL "pkg_config")
  file(GLOB_RECURSE pc ${WORK}/moved/gyre.pc)
  get_filename_component(pc_folder "${pc}" DIRECTORY)
  set(ENV{PKG_CONFIG_PATH} ${pc_folder})
  execute_process(COMMAND pkg-config --cflags --libs gyre OUTPUT_VARIABLE flags COMMAND_ERROR_IS_FATAL ANY)
  separate_arguments(flags UNIX_COMMAND "${flags}")
  must(${CXX} -std=c++20 -O1 ${CMAKE_CURRENT_LIST_DIR}/main.cpp -o ${folder}/consumer ${flags})
  must(${folder}/consumer)
  # The C interface, if it was built.
  execute_process(COMMAND pkg-config --cflags --libs gyre-c OUTPUT_VARIABLE flags RESULT_VARIABLE missing ERROR_QUIET)
  if(missing EQUAL 0)
    separate_arguments(flags UNIX_COMMAND "${flags}")
    get_filename_component(lib_folder "${pc_folder}" DIRECTORY)
    must(cc -std=c11 -Wall -Wextra -Werror ${GYRE_SOURCE}/examples/c/falling_box.c -o ${folder}/c_consumer ${flags})
    must(${CMAKE_COMMAND} -E env LD_LIBRARY_PATH=${lib_folder} ${folder}/c_consumer)
  endif()
  # The Python package finds library and scenes in the tree that it lies in.
  set(packages ${WORK}/moved/lib/python3/dist-packages)
  execute_process(COMMAND /usr/bin/python3 -c "import numpy" RESULT_VARIABLE missing OUTPUT_QUIET ERROR_QUIET)
  if(missing EQUAL 0 AND EXISTS ${packages}/gyre)
    must(${CMAKE_COMMAND} -E env PYTHONPATH=${packages} PYTHONDONTWRITEBYTECODE=1
      /usr/bin/python3 -c "import gyre; gyre.load_scene('newtons_cradle').run(0.1)")
  endif()
else()
  # The core folder by folder, as a user may ask for, and not optimised, since the question here is if it builds.
  must(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${folder} -G ${GENERATOR} -DWAY=${WAY}
    -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER} -DCMAKE_UNITY_BUILD=ON
    "-DCMAKE_CXX_FLAGS_RELEASE=-O0 -DNDEBUG"
    -DCMAKE_PREFIX_PATH=${WORK}/moved -DGYRE_SOURCE=${GYRE_SOURCE} -DGYRE_WERROR=${WERROR})
  must(${CMAKE_COMMAND} --build ${folder} --parallel)
  must(${folder}/consumer)
endif()
