# Install rules: headers, library, CMake package, pkg-config file, the gyre program and the scenes.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

install(TARGETS gyre gyre_kit EXPORT gyreTargets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
  RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR}
  INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/gyre
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
  FILES_MATCHING PATTERN "*.h")

if(TARGET gyre_c)
  install(TARGETS gyre_c gyre_c_formats EXPORT gyreTargets
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
    RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  install(FILES ${PROJECT_BINARY_DIR}/capi/include/gyre/c/gyre.h ${PROJECT_BINARY_DIR}/capi/include/gyre/c/load.h
    DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/gyre/c)
endif()
if(TARGET gyre_c AND GYRE_BUILD_PYTHON)
  # The package finds the library, the gyre program and the scenes of the same prefix.
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/python/gyre
    DESTINATION lib/python3/dist-packages
    FILES_MATCHING PATTERN "*.py" PATTERN "py.typed" PATTERN "__pycache__" EXCLUDE)
  install(FILES ${PROJECT_BINARY_DIR}/python/gyre/_api.py ${PROJECT_BINARY_DIR}/python/gyre/__init__.pyi
    DESTINATION lib/python3/dist-packages/gyre)
endif()

set(gyre_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/gyre)
install(EXPORT gyreTargets NAMESPACE gyre:: DESTINATION ${gyre_package_dir})
configure_package_config_file(
  ${PROJECT_SOURCE_DIR}/cmake/gyreConfig.cmake.in
  ${PROJECT_BINARY_DIR}/package/gyreConfig.cmake
  INSTALL_DESTINATION ${gyre_package_dir})
write_basic_package_version_file(
  ${PROJECT_BINARY_DIR}/package/gyreConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES
  ${PROJECT_BINARY_DIR}/package/gyreConfig.cmake
  ${PROJECT_BINARY_DIR}/package/gyreConfigVersion.cmake
  DESTINATION ${gyre_package_dir})

# The prefix is found from the place of the file, so that an installed tree can be moved.
file(RELATIVE_PATH gyre_prefix_from_pc
  /prefix/${CMAKE_INSTALL_LIBDIR}/pkgconfig /prefix)
string(REGEX REPLACE "/$" "" gyre_prefix_from_pc "${gyre_prefix_from_pc}")
string(REPLACE ";" " " gyre_pc_float_options "${gyre_float_options}")
# The shared library beside the static one has the C interface alone, so programs in C++ name the static one.
set(gyre_pc_library -lgyre)
if(TARGET gyre_c AND NOT BUILD_SHARED_LIBS AND UNIX AND NOT APPLE)
  set(gyre_pc_library -l:libgyre.a)
endif()
configure_file(${PROJECT_SOURCE_DIR}/cmake/gyre.pc.in ${PROJECT_BINARY_DIR}/package/gyre.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/package/gyre.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
if(TARGET gyre_c)
  get_target_property(gyre_c_name gyre_c OUTPUT_NAME)
  if(NOT gyre_c_name)
    set(gyre_c_name gyre_c)
  endif()
  configure_file(${PROJECT_SOURCE_DIR}/cmake/gyre-c.pc.in ${PROJECT_BINARY_DIR}/package/gyre-c.pc @ONLY)
  configure_file(${PROJECT_SOURCE_DIR}/cmake/gyre-formats.pc.in ${PROJECT_BINARY_DIR}/package/gyre-formats.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/package/gyre-c.pc ${PROJECT_BINARY_DIR}/package/gyre-formats.pc
    DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endif()

if(TARGET gyre_mpi)
  install(TARGETS gyre_mpi RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} OPTIONAL)
endif()
if(TARGET gyre_cli)
  install(TARGETS gyre_cli RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  # The program writes its own completion scripts and manual page (apps/CMakeLists.txt).
  if(NOT CMAKE_CROSSCOMPILING)
    set(gyre_shell ${PROJECT_BINARY_DIR}/shell)
    install(FILES ${gyre_shell}/gyre.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME gyre)
    install(FILES ${gyre_shell}/_gyre DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
    install(FILES ${gyre_shell}/gyre.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
    install(FILES ${gyre_shell}/gyre.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
  endif()
endif()
if(EXISTS ${PROJECT_SOURCE_DIR}/scenes)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/gyre)
endif()
# The viewer, if it was built (tools/build_viewer.sh): gyre view finds it beside the program.
install(DIRECTORY ${PROJECT_SOURCE_DIR}/web/viewer/dist/ DESTINATION ${CMAKE_INSTALL_DATADIR}/gyre/viewer OPTIONAL)
