# The target docs: a site of the pages of docs/ and the reference of the public headers, in <build>/html.
find_program(CAROM_DOXYGEN doxygen)
mark_as_advanced(CAROM_DOXYGEN)
if(NOT CAROM_DOXYGEN)
  return()
endif()

set(carom_docs_headers ${carom_public_headers} ${kit_headers})
list(JOIN carom_docs_headers " " carom_docs_headers)
configure_file("${PROJECT_SOURCE_DIR}/docs/Doxyfile.in" "${PROJECT_BINARY_DIR}/Doxyfile" @ONLY)
set(carom_copy_pictures "")
file(
  GLOB_RECURSE pictures CONFIGURE_DEPENDS
  RELATIVE "${PROJECT_SOURCE_DIR}"
  "${PROJECT_SOURCE_DIR}/docs/*.png")
foreach(picture IN LISTS pictures)
  cmake_path(GET picture PARENT_PATH folder)
  list(APPEND picture_folders "${folder}")
endforeach()
list(REMOVE_DUPLICATES picture_folders)
foreach(folder IN LISTS picture_folders)
  list(APPEND carom_copy_pictures COMMAND "${CMAKE_COMMAND}" -E copy_directory "${folder}"
              "${PROJECT_BINARY_DIR}/html/${folder}")
endforeach()

add_custom_target(
  docs
  COMMAND "${CMAKE_COMMAND}" -E rm -rf "${PROJECT_BINARY_DIR}/html"
  COMMAND "${CAROM_DOXYGEN}" "${PROJECT_BINARY_DIR}/Doxyfile" ${carom_copy_pictures}
  WORKING_DIRECTORY "${PROJECT_SOURCE_DIR}"
  COMMENT "Writing ${PROJECT_BINARY_DIR}/html"
  VERBATIM)
