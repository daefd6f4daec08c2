# One function a kind of target. A folder's CMakeLists.txt lists its sources and what it uses.

# palpate_plain(target): the sanitizers' build leaves out the optimiser, which takes longer there than it saves: for code
# that has others compute.
function(palpate_plain target)
  if(PALPATE_SANITIZE)
    target_compile_options(${target} PRIVATE -O0)
  endif()
endfunction()

# palpate_module(folder [PLAIN] SOURCES a.cpp … USES palpate::math …)
# The library of common/<folder>. USES stays within the folder's row of the include table.
function(palpate_module folder)
  cmake_parse_arguments(arg "PLAIN" "" "SOURCES;USES;PRIVATE_USES" ${ARGN})
  string(REPLACE "/" "_" name ${folder})
  if(arg_SOURCES)
    add_library(palpate_${name} STATIC ${arg_SOURCES})
    target_link_libraries(palpate_${name} PUBLIC palpate_options ${arg_USES} PRIVATE ${arg_PRIVATE_USES})
  else()
    add_library(palpate_${name} INTERFACE)
    target_link_libraries(palpate_${name} INTERFACE palpate_options ${arg_USES})
  endif()
  add_library(palpate::${name} ALIAS palpate_${name})
  if(arg_PLAIN)
    palpate_plain(palpate_${name})
  endif()
endfunction()

# palpate_helper(name SOURCES … USES … COMPONENT palpate-mesh): a helper program, in lib/palpate beside bin/, and the
# package that it is in: palpate-common, where nothing else is said.
function(palpate_helper name)
  cmake_parse_arguments(arg "" "COMPONENT" "SOURCES;USES" ${ARGN})
  if(NOT arg_COMPONENT)
    set(arg_COMPONENT palpate-common)
  endif()
  add_executable(${name} ${arg_SOURCES})
  target_link_libraries(${name} PRIVATE palpate_options ${arg_USES})
  palpate_plain(${name})
  set_target_properties(${name} PROPERTIES
    RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib/palpate)
  # Not LIBDIR: helpers are found at ../lib/palpate from bin, installed or not.
  install(TARGETS ${name} RUNTIME DESTINATION lib/palpate COMPONENT ${arg_COMPONENT})
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
  palpate_plain(palpate_parts_${name})
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
  install(PROGRAMS $<TARGET_FILE:${name}> DESTINATION ${CMAKE_INSTALL_BINDIR} RENAME palpate-${name}
          COMPONENT palpate-${name})
  # CMake strips targets only, and these cannot be renamed.
  install(CODE "if(CMAKE_INSTALL_DO_STRIP)
  execute_process(COMMAND ${CMAKE_STRIP} \$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_BINDIR}/palpate-${name})
endif()" COMPONENT palpate-${name})
  palpate_pages(palpate-${name} palpate-${name} $<TARGET_FILE:${name}>)
endfunction()

# palpate_pages(palpate-flow COMPONENT [program]): installs manual page and completions, which the program prints; without
# one they lie in the folder `pages` of the build.
function(palpate_pages name component)
  install(CODE "set(PALPATE_NAME ${name})
set(PALPATE_PROGRAM \"${ARGV2}\")
set(PALPATE_PAGES \"${PROJECT_BINARY_DIR}/pages\")
include(\"${PROJECT_SOURCE_DIR}/cmake/install_pages.cmake\")" COMPONENT ${component})
endfunction()

# palpate_test(common/ode/root_test LABELS … USES … SOURCES … DEPENDS …): tests/common/ode/root_test.cpp as one test of
# ctest. The tests of a CMakeLists.txt share a program, <folder>_tests, since linking a program for each costs as much
# as compiling it; tests that are slow, count allocations or locks, or need VTK or OpenVDB have programs apart. A test
# that compiles sources of the product has a program for itself.
# OWN_DISPLAY: the test moves the mouse of its display, which windows of others would see.
# A folder that sets PALPATE_PLAIN_TESTS has its tests compiled without the optimiser.
# Every test has the label `fast` (run under the sanitizers too) unless LABELS says `slow` (not built there).
function(palpate_test path)
  cmake_parse_arguments(arg "OWN_DISPLAY" "TIMEOUT" "LABELS;USES;DEPENDS;SOURCES" ${ARGN})
  if(PALPATE_SANITIZE AND "slow" IN_LIST arg_LABELS)
    return()
  endif()
  set(tests ${PROJECT_SOURCE_DIR}/tests)
  list(TRANSFORM arg_SOURCES PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/ REGEX "^[^/]")
  set(product ${arg_SOURCES})
  list(FILTER product EXCLUDE REGEX "^${tests}/")
  if(product)
    string(REPLACE "/" "_" program ${path})
    # clang-tidy reads how they are compiled, and cannot read GCC's precompiled headers.
    set_source_files_properties(${product} PROPERTIES SKIP_PRECOMPILE_HEADERS ON)
  else()
    file(RELATIVE_PATH program ${tests} ${CMAKE_CURRENT_SOURCE_DIR})
    string(REPLACE "/" "_" program ${program})
    if("${arg_USES}" MATCHES "VTK::|palpate_vtk_support")
      string(APPEND program _vtk)
    endif()
    if(palpate_openvdb IN_LIST arg_USES)
      string(APPEND program _openvdb)
    endif()
    if(palpate_allocation_guard IN_LIST arg_USES)
      string(APPEND program _counted)
    endif()
    if(palpate_lock_count IN_LIST arg_USES)
      string(APPEND program _locks)
    endif()
    if("slow" IN_LIST arg_LABELS)
      string(APPEND program _slow)
    endif()
    string(APPEND program _tests)
  endif()

  if(NOT TARGET ${program})
    add_executable(${program})
    target_link_libraries(${program} PRIVATE palpate_test_support)
    if(PALPATE_PLAIN_TESTS)
      target_precompile_headers(${program} REUSE_FROM palpate_plain_test_headers)
    else()
      target_precompile_headers(${program} REUSE_FROM palpate_test_headers)
    endif()
    set_target_properties(${program} PROPERTIES
      RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests PALPATE_IS_TEST ON
      PALPATE_IS_PLAIN_TEST "${PALPATE_PLAIN_TESTS}")
  endif()
  get_target_property(known ${program} SOURCES)
  set(sources ${tests}/${path}.cpp ${arg_SOURCES})
  list(REMOVE_ITEM sources ${known})
  target_sources(${program} PRIVATE ${sources})
  target_link_libraries(${program} PRIVATE ${arg_USES})
  if(arg_DEPENDS)
    add_dependencies(${program} ${arg_DEPENDS})
  endif()

  if(NOT arg_TIMEOUT)
    set(arg_TIMEOUT 300)
  endif()
  if(NOT "slow" IN_LIST arg_LABELS)
    list(APPEND arg_LABELS fast)
    add_dependencies(fast_tests ${program})
  endif()
  set(display "")
  if(arg_OWN_DISPLAY AND PALPATE_XVFB_RUN)
    set(display ${PALPATE_XVFB_RUN} -a -n ${PALPATE_NEXT_DISPLAY} -s "-screen 0 1280x1024x24")
    math(EXPR next "${PALPATE_NEXT_DISPLAY} + 20")
    set(PALPATE_NEXT_DISPLAY ${next} CACHE INTERNAL "")
  endif()
  add_test(NAME ${path} COMMAND ${display} $<TARGET_FILE:${program}> --file=tests/${path}.cpp)
  # Long tests begin first, or the last of them would run alone.
  set(cost 1)
  if("slow" IN_LIST arg_LABELS)
    set(cost ${arg_TIMEOUT})
  endif()
  set_tests_properties(${path} PROPERTIES LABELS "${arg_LABELS}" TIMEOUT ${arg_TIMEOUT} COST ${cost})
endfunction()

# palpate_join_tests(program SOURCES a_test.cpp b_test.cpp … SOURCES …): in a unity build, the test files of each list are
# compiled together, after their palpate_test lines: most of a test's time goes into templates that all have in
# common. Files of one list name their helpers differently; files that are no part of the program are left out. Includes from the project's root, not CMake's absolute
# ones: the compiler's cache then knows the joined file in any checkout.
function(palpate_join_tests program)
  if(NOT PALPATE_JOINS_TESTS OR NOT TARGET ${program})
    return()
  endif()
  set(count 0)
  get_target_property(known ${program} SOURCES)
  foreach(word ${ARGN} SOURCES)
    if(NOT word STREQUAL SOURCES)
      if(NOT EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/${word})
        message(FATAL_ERROR "palpate_join_tests(${program}): there is no ${word}")
      endif()
      if(NOT ${CMAKE_CURRENT_SOURCE_DIR}/${word} IN_LIST known)
        continue()  # the test of a part that is not built
      endif()
      file(RELATIVE_PATH path ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR}/${word})
      string(APPEND includes "#include \"${path}\"\n")
      set_source_files_properties(${PROJECT_SOURCE_DIR}/${path} PROPERTIES HEADER_FILE_ONLY ON)
    elseif(includes)
      math(EXPR count "${count} + 1")
      set(joined ${CMAKE_CURRENT_BINARY_DIR}/${program}_${count}.cpp)
      file(CONFIGURE OUTPUT ${joined} CONTENT "${includes}" @ONLY)
      target_sources(${program} PRIVATE ${joined})
      set(includes "")
    endif()
  endforeach()
endfunction()
