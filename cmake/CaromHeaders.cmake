# Headers stand beside sources but are spelled <carom/folder/name.h> everywhere. The build stages
# <build>/include/carom with links to the folders, so that the build tree, the installed tree and a
# subdirectory user see one path.

# carom_collect_sources(folders public sources programs private): source files of the library, sources of programs
# (named carom_*.cpp, one program each), and its headers that are not in the list of public ones, all relative to the
# project. A public header that does not exist is an error.
function(carom_collect_sources folders public sources_out programs_out private_out)
  set(sources "")
  set(programs "")
  set(private "")
  set(missing "${public}")
  foreach(folder IN LISTS folders)
    file(GLOB_RECURSE folder_sources CONFIGURE_DEPENDS LIST_DIRECTORIES false "${PROJECT_SOURCE_DIR}/${folder}/*.cpp")
    file(
      GLOB_RECURSE folder_headers CONFIGURE_DEPENDS LIST_DIRECTORIES false
      RELATIVE "${PROJECT_SOURCE_DIR}"
      "${PROJECT_SOURCE_DIR}/${folder}/*.h")
    foreach(source IN LISTS folder_sources)
      if(source MATCHES "/carom_[^/]*$")
        list(APPEND programs "${source}")
      else()
        list(APPEND sources "${source}")
      endif()
    endforeach()
    list(REMOVE_ITEM missing ${folder_headers})
    list(REMOVE_ITEM folder_headers ${public})
    list(APPEND private ${folder_headers})
  endforeach()
  if(missing)
    message(FATAL_ERROR "public headers that do not exist: ${missing}")
  endif()
  set(${sources_out} "${sources}" PARENT_SCOPE)
  set(${programs_out} "${programs}" PARENT_SCOPE)
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
