# carom_optional(option package what): the cache option `option` (AUTO: if the package is found, ON, OFF) for what
# the package gives; sets carom_has_<package>.
function(carom_optional option package what)
  set(${option} AUTO CACHE STRING "${what}: AUTO (if ${package} is found), ON or OFF")
  set_property(CACHE ${option} PROPERTY STRINGS AUTO ON OFF)
  set(has FALSE)
  if(${option} STREQUAL "AUTO")
    find_package(${package} QUIET)
    set(has ${${package}_FOUND})
    if(NOT has)
      message(STATUS "carom: ${package} not found, without: ${what} (${option})")
    endif()
  elseif(${option})
    find_package(${package} REQUIRED)
    set(has TRUE)
  endif()
  set(carom_has_${package} ${has} PARENT_SCOPE)
endfunction()

# nlohmann-json writes and reads contact problems. It is headers only, seen by contact/solvers/problem_file*.cpp and the
# programs alone: neither users of a shared nor of a static copy need it.
carom_optional(CAROM_WITH_JSON nlohmann_json "contact problems as JSON files")
if(carom_has_nlohmann_json)
  target_link_libraries(carom PRIVATE $<BUILD_INTERFACE:nlohmann_json::nlohmann_json>)
  set_source_files_properties(
    "${PROJECT_SOURCE_DIR}/contact/solvers/problem_file.cpp"
    "${PROJECT_SOURCE_DIR}/contact/solvers/problem_file_writer.cpp" PROPERTIES COMPILE_DEFINITIONS CAROM_WITH_JSON)
endif()

# oneTBB shares work out to threads. It is seen by core/workers.cpp alone.
carom_optional(CAROM_WITH_TBB TBB "several threads by oneTBB")
if(carom_has_TBB)
  target_link_libraries(carom PRIVATE TBB::tbb)
  string(APPEND carom_private_packages "find_dependency(TBB)\n")
  set_source_files_properties("${PROJECT_SOURCE_DIR}/core/workers.cpp" PROPERTIES COMPILE_DEFINITIONS CAROM_HAS_TBB)
endif()
