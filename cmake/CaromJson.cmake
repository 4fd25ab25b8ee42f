# nlohmann-json writes and reads contact problems. It is headers only, seen by contact/problem_file.cpp and the
# programs alone: neither users of a shared nor of a static copy need it.
set(CAROM_WITH_JSON AUTO CACHE STRING "Contact problems as JSON files: AUTO (if nlohmann-json is found), ON or OFF")
set_property(CACHE CAROM_WITH_JSON PROPERTY STRINGS AUTO ON OFF)

set(carom_has_json FALSE)
if(CAROM_WITH_JSON STREQUAL "AUTO")
  find_package(nlohmann_json QUIET)
  set(carom_has_json ${nlohmann_json_FOUND})
  if(NOT carom_has_json)
    message(STATUS "carom: nlohmann-json not found, contact problems cannot be saved (CAROM_WITH_JSON)")
  endif()
elseif(CAROM_WITH_JSON)
  find_package(nlohmann_json REQUIRED)
  set(carom_has_json TRUE)
endif()

if(carom_has_json)
  target_link_libraries(carom PRIVATE $<BUILD_INTERFACE:nlohmann_json::nlohmann_json>)
  set_source_files_properties("${PROJECT_SOURCE_DIR}/contact/problem_file.cpp" PROPERTIES COMPILE_DEFINITIONS
                                                                                          CAROM_WITH_JSON)
endif()
