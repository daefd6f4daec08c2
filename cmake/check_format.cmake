# Fails, naming the files, where clang-format would change something.
file(GLOB_RECURSE files ${ROOT}/common/*.h ${ROOT}/common/*.cpp ${ROOT}/lab/*.h ${ROOT}/lab/*.cpp ${ROOT}/loaders/*.h ${ROOT}/loaders/*.cpp
     ${ROOT}/apps/*.h ${ROOT}/apps/*.cpp ${ROOT}/library/*.h ${ROOT}/library/*.cpp ${ROOT}/tests/*.h ${ROOT}/tests/*.cpp)
execute_process(COMMAND ${CLANG_FORMAT} --dry-run -Werror ${files}
                WORKING_DIRECTORY ${ROOT} RESULT_VARIABLE result ERROR_VARIABLE output)
if(NOT result EQUAL 0)
  string(REGEX MATCHALL "[^\n]*error: code should be clang-formatted" lines "${output}")
  list(TRANSFORM lines REPLACE ":[0-9]+:[0-9]+: error.*" "")
  list(REMOVE_DUPLICATES lines)
  list(JOIN lines "\n  " named)
  message(FATAL_ERROR "not formatted; run clang-format -i on\n  ${named}")
endif()
