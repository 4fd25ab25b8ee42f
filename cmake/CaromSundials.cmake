# SUNDIALS serves the smooth flow of the event-driven mode. Only integrators/flow/sundials*.cpp may include it;
# without such a file it is not even looked for.
file(GLOB carom_sundials_sources CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/integrators/flow/sundials*.cpp")
if(NOT carom_sundials_sources)
  return()
endif()

set(carom_sundials_components cvode arkode nvecserial sunnonlinsolfixedpoint)
# Asked for without a version, since the package of 7.0 refuses a request for 6.4; checked afterwards.
find_package(SUNDIALS REQUIRED COMPONENTS ${carom_sundials_components})
if(SUNDIALS_VERSION VERSION_LESS 6.4 OR SUNDIALS_VERSION VERSION_GREATER_EQUAL 8)
  message(FATAL_ERROR "carom needs SUNDIALS 6.4 or newer, below 8; found ${SUNDIALS_VERSION}")
endif()

set(carom_sundials_parts ${carom_sundials_components})
if(TARGET SUNDIALS::core) # what was "generic" before 7
  list(APPEND carom_sundials_parts core)
elseif(CAROM_BUNDLE_DEPENDENCIES)
  list(APPEND carom_sundials_parts generic)
endif()
list(TRANSFORM carom_sundials_parts PREPEND "SUNDIALS::")
if(CAROM_BUNDLE_DEPENDENCIES)
  list(TRANSFORM carom_sundials_parts APPEND "_static")
endif()
target_link_libraries(carom PRIVATE ${carom_sundials_parts})

list(JOIN carom_sundials_components " " carom_sundials_list)
string(APPEND carom_private_packages "find_dependency(SUNDIALS COMPONENTS ${carom_sundials_list})\n")

# A SUNDIALS built with MPI (Debian 13) names MPI's library for C, which CMake finds where that is enabled only.
if(TARGET MPI::MPI_CXX AND NOT TARGET MPI::MPI_C)
  enable_language(C)
  find_package(MPI REQUIRED COMPONENTS C CXX)
  string(APPEND carom_private_packages "enable_language(C)\nfind_dependency(MPI COMPONENTS C CXX)\n")
endif()
