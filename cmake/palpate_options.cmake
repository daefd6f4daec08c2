# Compiler settings of every target, carried by palpate_options: targets, not global flags.

if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)

# `dev` and `asan` keep -DNDEBUG away so that PALPATE_ASSERT is live.
option(PALPATE_ASSERTIONS "Check PALPATE_ASSERT" OFF)
set(CMAKE_CXX_FLAGS_RELWITHDEBINFO "-O2 -g1")
set(CMAKE_CXX_FLAGS_RELEASE "-O3 -DNDEBUG")

set(PALPATE_SANITIZE "" CACHE STRING "Sanitizers, as for -fsanitize=")
if(PALPATE_SANITIZE)
  # Instrumented code inlines badly: -O2 takes minutes on the templates of the tracers, -O1 seconds. Lines of a report's
  # functions take a tenth of the time to compile: -DCMAKE_CXX_FLAGS=-g1 has them.
  set(CMAKE_CXX_FLAGS_RELWITHDEBINFO "-O1")
endif()

find_program(PALPATE_CCACHE ccache)
if(PALPATE_CCACHE)
  # What it takes to cache sources that use precompiled headers.
  if(NOT DEFINED ENV{CCACHE_SLOPPINESS})
    list(PREPEND PALPATE_CCACHE ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros)
  endif()
  set(CMAKE_CXX_COMPILER_LAUNCHER ${PALPATE_CCACHE})
  set(CMAKE_C_COMPILER_LAUNCHER ${PALPATE_CCACHE})
endif()

# In the presets of developers and of continuous integration. A user's compiler may know warnings that ours does not.
option(PALPATE_WARNINGS_AS_ERRORS "Stop at a compiler's warning" OFF)

add_library(palpate_options INTERFACE)
target_compile_features(palpate_options INTERFACE cxx_std_20)
target_include_directories(palpate_options INTERFACE ${PROJECT_SOURCE_DIR})
# -ffp-contract=off: a fused multiply-add must not be the compiler's choice, or replay and
# power-of-two scaling would not be bit-identical between builds.
target_compile_options(palpate_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual -Wnull-dereference
  -Wno-missing-field-initializers $<$<BOOL:${PALPATE_WARNINGS_AS_ERRORS}>:-Werror> -ffp-contract=off
  # GCC 12 sees overlapping copies in `"text" + std::string` where there are none (its bug 105651).
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>
  # Clang takes a captured structured binding, legal in C++20, for an extension.
  $<$<CXX_COMPILER_ID:Clang>:-Wno-c++20-extensions>
  # Tests of lanes are joined by & on purpose: without branches they become vector instructions.
  $<$<CXX_COMPILER_ID:Clang>:-Wno-bitwise-instead-of-logical>
  # Lanes never leave the function that they are in.
  $<$<CXX_COMPILER_ID:Clang>:-Wno-psabi>
  # std::stable_sort of libstdc++ 12 calls what it has marked deprecated itself, which newer ones blame on the caller; GCC and
  # Clang 14 still look at all calls.
  $<$<AND:$<CXX_COMPILER_ID:Clang>,$<VERSION_GREATER_EQUAL:$<CXX_COMPILER_VERSION>,15>>:-Wno-deprecated-declarations>)
if(CMAKE_UNITY_BUILD)
  # Twice CMake's number: most of a file's time goes into headers that all have in common.
  set(CMAKE_UNITY_BUILD_BATCH_SIZE 16)
  # Files compiled together see one another's names, and are no longer main files: a build file by file has
  # these warnings.
  target_compile_options(palpate_options INTERFACE
    -Wno-shadow $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
endif()
# Tests are compiled more often than they run: the optimiser's last round costs them a quarter of that time, and all of
# it a third where the work is done by the libraries or by a program that the test starts.
target_compile_options(palpate_options INTERFACE
  $<$<AND:$<CONFIG:Release>,$<BOOL:$<TARGET_PROPERTY:PALPATE_IS_TEST>>>:-O1>
  $<$<BOOL:$<TARGET_PROPERTY:PALPATE_IS_PLAIN_TEST>>:-O0>)
# GCC 12 sees short strings copied beyond their end where they are long, once more code is known to it.
target_compile_options(palpate_options INTERFACE
  $<$<AND:$<CXX_COMPILER_ID:GNU>,$<BOOL:$<TARGET_PROPERTY:PALPATE_IS_TEST>>>:-Wno-array-bounds>)
if(PALPATE_ASSERTIONS)
  target_compile_definitions(palpate_options INTERFACE PALPATE_ASSERTIONS=1)
endif()
if(PALPATE_SANITIZE)
  # The sanitizers' instrumentation defeats GCC's flow analysis: null-dereference then warns falsely.
  target_compile_options(palpate_options INTERFACE
    -fsanitize=${PALPATE_SANITIZE} -fno-omit-frame-pointer -Wno-null-dereference
    $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>
    # Checks of every pointer take a fifth of the time to compile, and half of it for a test's macros. An access
    # through a null pointer is reported without them, by AddressSanitizer.
    -fno-sanitize=null,object-size $<$<BOOL:$<TARGET_PROPERTY:PALPATE_IS_TEST>>:-fno-sanitize=vptr>)
  target_link_options(palpate_options INTERFACE -fsanitize=${PALPATE_SANITIZE})
  find_program(PALPATE_LLD ld.lld)
  if(PALPATE_LLD)
    # A fifth of the time of GNU's linker, which these programs take seconds of.
    target_link_options(palpate_options INTERFACE $<$<CXX_COMPILER_ID:Clang>:-fuse-ld=lld>)
  endif()
endif()
