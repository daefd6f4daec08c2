# One function a kind of target. A folder's CMakeLists.txt lists its sources and what it uses.

# palpate_module(folder SOURCES a.cpp … USES palpate::math …)
# The library of common/<folder>. USES stays within the folder's row of the include table.
function(palpate_module folder)
  cmake_parse_arguments(arg "" "" "SOURCES;USES;PRIVATE_USES" ${ARGN})
  string(REPLACE "/" "_" name ${folder})
  if(arg_SOURCES)
    add_library(palpate_${name} STATIC ${arg_SOURCES})
    target_link_libraries(palpate_${name} PUBLIC palpate_options ${arg_USES} PRIVATE ${arg_PRIVATE_USES})
  else()
    add_library(palpate_${name} INTERFACE)
    target_link_libraries(palpate_${name} INTERFACE palpate_options ${arg_USES})
  endif()
  add_library(palpate::${name} ALIAS palpate_${name})
endfunction()

# palpate_join(target SOURCES a.cpp b.cpp … SOURCES c.cpp d.cpp …)
# What a unity build joins of a target whose sources name their parts alike: those of each list. Others stay alone.
function(palpate_join target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD_MODE GROUP)
  set(list 0)
  foreach(word ${ARGN})
    if(word STREQUAL SOURCES)
      math(EXPR list "${list} + 1")
    else()
      set_source_files_properties(${word} PROPERTIES UNITY_GROUP ${list})
    endif()
  endforeach()
endfunction()

# palpate_helper(name SOURCES … USES …): a helper program, in lib/palpate beside bin/.
function(palpate_helper name)
  cmake_parse_arguments(arg "" "" "SOURCES;USES" ${ARGN})
  add_executable(${name} ${arg_SOURCES})
  target_link_libraries(${name} PRIVATE palpate_options ${arg_USES})
  set_target_properties(${name} PROPERTIES
    RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib/palpate)
  # Not LIBDIR: helpers are found at ../lib/palpate from bin, installed or not.
  install(TARGETS ${name} RUNTIME DESTINATION lib/palpate)
endfunction()

# palpate_app(name SOURCES main.cpp … USES … READS vectors … HELPERS …): an explorer. Building it builds what it starts
# and opens, too: HELPERS, the drivers of devices, and the helper programs of the formats that hold one of the kinds
# READS (common/load/formats.def), which loaders/ adds after the programs. All but main.cpp is the library
# palpate_parts_<name>, for its tests.
function(palpate_app name)
  cmake_parse_arguments(arg "" "" "SOURCES;USES;READS;HELPERS" ${ARGN})
  list(REMOVE_ITEM arg_SOURCES main.cpp)
  add_library(palpate_parts_${name} STATIC ${arg_SOURCES})
  target_link_libraries(palpate_parts_${name} PUBLIC palpate_options ${arg_USES})
  add_executable(${name} main.cpp)
  target_link_libraries(${name} PRIVATE palpate_parts_${name})
  get_property(drivers GLOBAL PROPERTY PALPATE_DRIVERS)
  foreach(part ${arg_HELPERS} ${drivers})
    if(TARGET ${part})
      add_dependencies(${name} ${part})
    endif()
  endforeach()
  if(arg_READS)
    palpate_format_helpers(loaders ${arg_READS})
    foreach(loader ${loaders})
      set_property(GLOBAL APPEND PROPERTY PALPATE_USERS_OF_${loader} ${name})
    endforeach()
  endif()
  # Installed as palpate-<name>: `flow` alone is too common a word for /usr/bin.
  install(PROGRAMS $<TARGET_FILE:${name}> DESTINATION ${CMAKE_INSTALL_BINDIR} RENAME palpate-${name})
endfunction()

# palpate_test(common/ode/rk4_test LABELS … USES …): tests/common/ode/rk4_test.cpp as one program.
# Every test has the label `fast` (run under the sanitizers too) unless LABELS says `slow` (not built there).
function(palpate_test path)
  cmake_parse_arguments(arg "" "TIMEOUT" "LABELS;USES;DEPENDS;SOURCES" ${ARGN})
  if(PALPATE_SANITIZE AND "slow" IN_LIST arg_LABELS)
    return()
  endif()
  string(REPLACE "/" "_" name ${path})
  add_executable(${name} ${PROJECT_SOURCE_DIR}/tests/${path}.cpp ${arg_SOURCES})
  target_link_libraries(${name} PRIVATE palpate_test_support ${arg_USES})
  target_precompile_headers(${name} REUSE_FROM palpate_test_headers)
  if(arg_SOURCES)
    # The product's own: clang-tidy reads how they are compiled, and cannot read GCC's precompiled headers.
    set_source_files_properties(${arg_SOURCES} PROPERTIES SKIP_PRECOMPILE_HEADERS ON)
  endif()
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests PALPATE_IS_TEST ON)
  if(arg_DEPENDS)
    add_dependencies(${name} ${arg_DEPENDS})
  endif()
  if(NOT arg_TIMEOUT)
    set(arg_TIMEOUT 300)
  endif()
  if(NOT "slow" IN_LIST arg_LABELS)
    list(APPEND arg_LABELS fast)
  endif()
  add_test(NAME ${path} COMMAND ${name})
  set_tests_properties(${path} PROPERTIES LABELS "${arg_LABELS}" TIMEOUT ${arg_TIMEOUT})
endfunction()
