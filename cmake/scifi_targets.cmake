# SPDX-License-Identifier: MPL-2.0
# How executables of this repository are compiled; nothing here reaches a user of the library.

# scifi_compile_here(<target> [NATIVE]): warnings, sanitizers, coverage; NATIVE honours SCIFI_NATIVE.
function(scifi_compile_here target)
  cmake_parse_arguments(PARSE_ARGV 1 arg "NATIVE" "" "")
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wconversion -Wshadow)
  if(SCIFI_WARNINGS_AS_ERRORS)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(${target} PRIVATE -Wno-psabi)  # a note on parameter passing that changed in GCC 4.6
  endif()
  if(SCIFI_SANITIZERS)
    target_compile_options(${target} PRIVATE -fsanitize=${SCIFI_SANITIZERS} -fno-omit-frame-pointer -fno-sanitize-recover=all)
    target_link_options(${target} PRIVATE -fsanitize=${SCIFI_SANITIZERS})
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
      target_compile_options(${target} PRIVATE -Wno-maybe-uninitialized)  # GCC 12: false alarms in instrumented std::regex
    endif()
  endif()
  if(SCIFI_COVERAGE)
    target_compile_options(${target} PRIVATE --coverage -fprofile-update=atomic)
    target_link_options(${target} PRIVATE --coverage)
  endif()
  if(arg_NATIVE AND SCIFI_NATIVE)
    target_compile_options(${target} PRIVATE -march=native)
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
      target_compile_options(${target} PRIVATE -Wno-array-bounds)  # false alarms from AVX-512 stores of odd-sized Eigen objects
    endif()
  endif()
  get_target_property(sources ${target} SOURCES)
  set_property(GLOBAL APPEND PROPERTY SCIFI_REGISTERED_SOURCES ${sources})
endfunction()

# scifi_link_needed(<target> <sources>...): the core, and scifi::io where a source includes scifi/io.
function(scifi_link_needed target)
  target_link_libraries(${target} PRIVATE scifi::scifi)
  if(TARGET scifi::io)
    foreach(source IN LISTS ARGN)
      file(STRINGS "${source}" uses_io REGEX "#include.*[<\"](scifi/io/|nlohmann/|zlib\\.h)")
      if(uses_io)
        target_link_libraries(${target} PRIVATE scifi::io)
        break()
      endif()
    endforeach()
  endif()
endfunction()
