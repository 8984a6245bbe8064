# How every file is compiled. Same bits on every machine: no fast-math, no contraction that the compiler
# chooses (fused operations are written in the kernels), no flags that depend on the building machine.
if(PROJECT_IS_TOP_LEVEL AND NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()

find_program(REPOSE_CCACHE ccache)
if(REPOSE_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${REPOSE_CCACHE})
endif()

add_library(repose_flags INTERFACE)
target_compile_options(repose_flags INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion $<$<BOOL:${PROJECT_IS_TOP_LEVEL}>:-Werror>
  -Wno-restrict  # g++ 12 warns of std::string operator+ (GCC bug 105329)
  -ffp-contract=off -fno-math-errno)
# With sanitizers gcc takes much of the standard library for uninitialized, as its manual says.
if(CMAKE_CXX_FLAGS MATCHES "-fsanitize")
  add_compile_options(-Wno-maybe-uninitialized)
endif()
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  # Highway needs a vector baseline; every x86-64 since 2006 has this one.
  target_compile_options(repose_flags INTERFACE -mssse3)
endif()
if(REPOSE_STD_THREADS)
  target_compile_definitions(repose_flags INTERFACE REPOSE_STD_THREADS)
endif()
if(REPOSE_FEWER_TARGETS)
  target_compile_definitions(repose_flags INTERFACE REPOSE_FEWER_TARGETS)
endif()
if(REPOSE_VALIDATION)
  target_compile_definitions(repose_flags INTERFACE REPOSE_VALIDATION)
endif()
