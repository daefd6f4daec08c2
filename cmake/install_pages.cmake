# Run when a program is installed: its manual page and its completions, printed by itself.
#   PALPATE_PROGRAM  the built program        PALPATE_NAME  its installed name
#   PALPATE_PAGES    a folder for what is made
function(palpate_print file)
  execute_process(COMMAND ${PALPATE_PROGRAM} ${ARGN} OUTPUT_FILE ${PALPATE_PAGES}/${file} RESULT_VARIABLE result)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${PALPATE_PROGRAM} ${ARGN}: ends with ${result}")
  endif()
endfunction()

# palpate_install_page(file folder name): as man pages are packed where gzip is there.
function(palpate_install_page file folder name)
  find_program(PALPATE_GZIP gzip)
  if(folder MATCHES "/man[0-9]$" AND PALPATE_GZIP)
    execute_process(COMMAND ${PALPATE_GZIP} -9nkf ${PALPATE_PAGES}/${file} COMMAND_ERROR_IS_FATAL ANY)
    string(APPEND file .gz)
    string(APPEND name .gz)
  endif()
  file(INSTALL DESTINATION ${CMAKE_INSTALL_PREFIX}/${folder} TYPE FILE RENAME ${name} FILES ${PALPATE_PAGES}/${file})
endfunction()

file(MAKE_DIRECTORY ${PALPATE_PAGES})
if(PALPATE_PROGRAM)
  palpate_print(${PALPATE_NAME}.1 --manual)
  foreach(shell bash zsh fish)
    palpate_print(${PALPATE_NAME}.${shell} --completion ${shell})
  endforeach()
endif()
# Where Debian's man and shells look.
palpate_install_page(${PALPATE_NAME}.1 share/man/man1 ${PALPATE_NAME}.1)
if(EXISTS ${PALPATE_PAGES}/${PALPATE_NAME}.bash)
  palpate_install_page(${PALPATE_NAME}.bash share/bash-completion/completions ${PALPATE_NAME})
  palpate_install_page(${PALPATE_NAME}.zsh share/zsh/vendor-completions _${PALPATE_NAME})
  palpate_install_page(${PALPATE_NAME}.fish share/fish/vendor_completions.d ${PALPATE_NAME}.fish)
endif()
