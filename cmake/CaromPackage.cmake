# `cpack -G DEB` in a build directory makes a Debian package of what is installed, libcarom-dev.
set(CPACK_PACKAGE_NAME libcarom-dev)
set(CPACK_PACKAGE_VERSION "${PROJECT_VERSION}")
set(CPACK_PACKAGE_CONTACT "The carom authors")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGE_DESCRIPTION "C++20 library, headers, CMake package and carom-solve-contact.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_DIRECTORY "${PROJECT_BINARY_DIR}/packages")
set(CPACK_GENERATOR DEB)

set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION libdevel)
# Libraries that the library is linked with are found by dpkg-shlibdeps; users compile with Eigen.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS "libeigen3-dev (>= 3.4)")
if(carom_type STREQUAL "STATIC_LIBRARY")
  string(APPEND CPACK_DEBIAN_PACKAGE_DEPENDS ", libspdlog-dev, libsundials-dev")
  if(carom_has_TBB)
    string(APPEND CPACK_DEBIAN_PACKAGE_DEPENDS ", libtbb-dev")
  endif()
endif()
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "libgmock-dev") # for COMPONENTS testing

# The licence stands where Debian wants it, in packages only.
install(
  FILES "${PROJECT_SOURCE_DIR}/LICENSE"
  DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/libcarom-dev
  RENAME copyright
  COMPONENT debian
  EXCLUDE_FROM_ALL)
set(CPACK_INSTALL_CMAKE_PROJECTS "${PROJECT_BINARY_DIR};carom;ALL;/;${PROJECT_BINARY_DIR};carom;debian;/")
include(CPack)
