# Build defaults shared by every package: C++17, an optimised build unless asked otherwise, and
# hv_target() for the warnings of each target.
include_guard()
set(CMAKE_CXX_STANDARD 17)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()
option(HV_WARNINGS_AS_ERRORS "Treat compiler warnings as errors" OFF)

# hv_target(<target>): the project's warnings for one of its own targets.
function(hv_target target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion)
  if(CMAKE_UNITY_BUILD AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # GCC takes files that are compiled together for headers, and warns of their local types.
    target_compile_options(${target} PRIVATE -Wno-subobject-linkage)
  endif()
  if(HV_WARNINGS_AS_ERRORS)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
endfunction()
