# Installs the library, its headers and a package for find_package(carom). The build tree is such a package too:
# CMAKE_PREFIX_PATH may be the build directory.
include(CMakePackageConfigHelpers)

if(CAROM_NATIVE)
  install(CODE "message(FATAL_ERROR \"a build with CAROM_NATIVE=ON runs only here and is not installed\")")
endif()

set(carom_package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/carom")
set(carom_built_package "${PROJECT_BINARY_DIR}/lib/cmake/carom")

install(
  TARGETS carom
  EXPORT carom-targets
  RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR}
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
  FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
if(carom_programs)
  # They find the library beside themselves, wherever the copy is moved.
  file(RELATIVE_PATH carom_library_from_programs "${CMAKE_INSTALL_FULL_BINDIR}" "${CMAKE_INSTALL_FULL_LIBDIR}")
  set_target_properties(${carom_programs} PROPERTIES INSTALL_RPATH "$ORIGIN/${carom_library_from_programs}")
  install(TARGETS ${carom_programs} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
install(
  EXPORT carom-targets
  NAMESPACE carom::
  DESTINATION ${carom_package_dir})
export(
  EXPORT carom-targets
  NAMESPACE carom::
  FILE "${carom_built_package}/carom-targets.cmake")

if(TARGET carom_testing)
  # An export of its own: only who asks for COMPONENTS testing needs GoogleTest.
  install(
    TARGETS carom_testing
    EXPORT carom-testing-targets
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
    FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  install(
    EXPORT carom-testing-targets
    NAMESPACE carom::
    DESTINATION ${carom_package_dir})
  export(
    EXPORT carom-testing-targets
    NAMESPACE carom::
    FILE "${carom_built_package}/carom-testing-targets.cmake")
endif()

set(carom_static_dependencies "")
if(carom_type STREQUAL "STATIC_LIBRARY")
  set(carom_static_dependencies "${carom_private_packages}")
endif()
configure_package_config_file(
  "${CMAKE_CURRENT_LIST_DIR}/carom-config.cmake.in" "${carom_built_package}/carom-config.cmake"
  INSTALL_DESTINATION ${carom_package_dir}
  NO_SET_AND_CHECK_MACRO)
# Until 1.0 a minor version may break its users.
write_basic_package_version_file(
  "${carom_built_package}/carom-config-version.cmake"
  COMPATIBILITY SameMinorVersion)
install(
  FILES "${carom_built_package}/carom-config.cmake" "${carom_built_package}/carom-config-version.cmake"
  DESTINATION ${carom_package_dir})
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" DESTINATION ${CMAKE_INSTALL_DATADIR}/licenses/carom)
