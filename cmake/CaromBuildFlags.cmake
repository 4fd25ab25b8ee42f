# carom_add_build_flags(target): what every target of the project is compiled with. Nothing of it reaches
# users: all options are private.
function(carom_add_build_flags target)
  set_target_properties(
    ${target}
    PROPERTIES CXX_EXTENSIONS OFF
               CXX_VISIBILITY_PRESET hidden
               VISIBILITY_INLINES_HIDDEN ON
               POSITION_INDEPENDENT_CODE ON)
  if(NOT CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang")
    return()
  endif()

  # Results must not depend on whether the compiler fuses a multiplication with an addition.
  target_compile_options(${target} PRIVATE -ffp-contract=off -fno-math-errno)

  # Calls within a shared library go straight to their function; nobody is to put another in its place.
  get_target_property(type ${target} TYPE)
  if(type STREQUAL "SHARED_LIBRARY" AND NOT APPLE)
    target_compile_options(${target} PRIVATE -fno-semantic-interposition)
    target_link_options(${target} PRIVATE -Wl,-Bsymbolic-functions)
    # Several sources are compiled as one, which GCC takes for a reason to inline less: small functions that are
    # called in every evaluation would be calls.
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
      target_compile_options(${target} PRIVATE --param=large-unit-insns=100000)
    endif()
    # A structure of some hundred bytes is set and copied by plain moves: the string instructions that GCC takes
    # instead begin slowly, and a step of one body has several of them.
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
      set(set_plainly "vector_loop:2048:noalign,libcall:-1:noalign")
      set(copy_plainly "unrolled_loop:2048:noalign,libcall:-1:noalign")
      target_compile_options(${target} PRIVATE -mmemset-strategy=${set_plainly} -mmemcpy-strategy=${copy_plainly})
    endif()
  endif()

  target_compile_options(
    ${target}
    PRIVATE -Wall
            -Wextra
            -Wpedantic
            -Wshadow
            -Wconversion
            -Wsign-conversion
            -Wold-style-cast
            -Wnon-virtual-dtor
            -Woverloaded-virtual
            -Wcast-qual
            -Wformat=2
            -Wimplicit-fallthrough
            -Wextra-semi
            -Wundef)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # Not -Wnull-dereference: it misfires inside the standard library's stream buffers.
    target_compile_options(${target} PRIVATE -Wduplicated-cond -Wduplicated-branches -Wlogical-op -Wsuggest-override)
    if(CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
      # "literal" + std::string misfires (GCC bug 105651).
      target_compile_options(${target} PRIVATE -Wno-restrict)
    endif()
  endif()
  if(CAROM_WARNINGS_AS_ERRORS)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
endfunction()
