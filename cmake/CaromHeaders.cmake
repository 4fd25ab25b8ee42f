# Headers stand beside sources but are spelled <carom/folder/name.h> everywhere. The build stages
# <build>/include/carom with links to the folders, so that the build tree, the installed tree and a
# subdirectory user see one path.

# carom_collect_sources(folders sources programs public private): source files of the library, sources of
# programs (named carom_*.cpp, one program each), and headers relative to the project, public ones apart from
# those that match carom_private_headers.
function(carom_collect_sources folders sources_out programs_out public_out private_out)
  set(sources "")
  set(programs "")
  set(public "")
  set(private "")
  foreach(folder IN LISTS folders)
    file(GLOB folder_sources CONFIGURE_DEPENDS LIST_DIRECTORIES false "${PROJECT_SOURCE_DIR}/${folder}/*.cpp")
    file(
      GLOB folder_headers CONFIGURE_DEPENDS LIST_DIRECTORIES false
      RELATIVE "${PROJECT_SOURCE_DIR}"
      "${PROJECT_SOURCE_DIR}/${folder}/*.h")
    foreach(source IN LISTS folder_sources)
      if(source MATCHES "/carom_[^/]*$")
        list(APPEND programs "${source}")
      else()
        list(APPEND sources "${source}")
      endif()
    endforeach()
    foreach(header IN LISTS folder_headers)
      set(is_private FALSE)
      foreach(pattern IN LISTS carom_private_headers)
        if(header MATCHES "^${pattern}$")
          set(is_private TRUE)
        endif()
      endforeach()
      if(is_private)
        list(APPEND private "${header}")
      else()
        list(APPEND public "${header}")
      endif()
    endforeach()
  endforeach()
  set(${sources_out} "${sources}" PARENT_SCOPE)
  set(${programs_out} "${programs}" PARENT_SCOPE)
  set(${public_out} "${public}" PARENT_SCOPE)
  set(${private_out} "${private}" PARENT_SCOPE)
endfunction()

# carom_stage_headers(target folders headers): links the folders and declares the file set.
function(carom_stage_headers target folders headers)
  set(include_root "${PROJECT_BINARY_DIR}/include")
  file(MAKE_DIRECTORY "${include_root}/carom")
  foreach(folder IN LISTS folders)
    if(IS_DIRECTORY "${PROJECT_SOURCE_DIR}/${folder}")
      file(CREATE_LINK "${PROJECT_SOURCE_DIR}/${folder}" "${include_root}/carom/${folder}" SYMBOLIC)
    endif()
  endforeach()
  list(TRANSFORM headers PREPEND "${include_root}/carom/")
  target_sources(
    ${target}
    PUBLIC FILE_SET HEADERS
           BASE_DIRS "${include_root}"
           FILES ${headers})
endfunction()

# carom_write_umbrella(target headers): writes <carom/carom.h>, which includes the headers, and adds it to the
# file set.
function(carom_write_umbrella target headers)
  set(umbrella "${PROJECT_BINARY_DIR}/include/carom/carom.h")
  set(includes "")
  foreach(header IN LISTS headers)
    string(APPEND includes "#include <carom/${header}>\n")
  endforeach()
  file(
    CONFIGURE
    OUTPUT "${umbrella}"
    CONTENT "#pragma once

/// \\file
/// Every public header of carom @PROJECT_VERSION@. Generated.

${includes}"
    @ONLY)
  target_sources(${target} PUBLIC FILE_SET HEADERS FILES "${umbrella}")
endfunction()
