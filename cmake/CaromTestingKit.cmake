# carom::testing: matchers for GoogleTest. The library knows nothing of GoogleTest, only its header matchers.h
# does: it serves whichever GoogleTest a user compiles with.
if(NOT TARGET GTest::gmock)
  find_package(GTest)
endif()
if(NOT TARGET GTest::gmock)
  message(STATUS "carom::testing is left out: GoogleTest was not found")
  return()
endif()

carom_collect_sources(testing "${kit_headers}" kit_sources kit_programs kit_private_headers)
add_library(carom_testing STATIC ${kit_sources})
add_library(carom::testing ALIAS carom_testing)
set_target_properties(carom_testing PROPERTIES EXPORT_NAME testing)
carom_add_build_flags(carom_testing)
carom_stage_headers(carom_testing testing "${kit_headers}")
target_link_libraries(
  carom_testing
  PUBLIC carom
  INTERFACE GTest::gmock)
