# Manual pages, which help2man writes from the program's own --help: hwsim(1), and hwsim-COMMAND(1) for each command.
find_program(HWSIM_HELP2MAN help2man)
if(NOT HWSIM_HELP2MAN)
  message(STATUS "no help2man: no manual pages")
  return()
endif()
set(manual_folder ${CMAKE_BINARY_DIR}/man)
add_custom_command(OUTPUT ${manual_folder}/hwsim.1
  COMMAND ${CMAKE_COMMAND} -D PROGRAM=$<TARGET_FILE:hwsim_cli> -D HELP2MAN=${HWSIM_HELP2MAN} -D OUT=${manual_folder}
          -D VERSION=${PROJECT_VERSION} "-D ABOUT=${PROJECT_DESCRIPTION}" -P ${CMAKE_CURRENT_LIST_DIR}/WriteManual.cmake
  DEPENDS hwsim_cli ${CMAKE_CURRENT_LIST_DIR}/WriteManual.cmake
  COMMENT "Writing manual pages" VERBATIM)
add_custom_target(hwsim_manual ALL DEPENDS ${manual_folder}/hwsim.1)
install(DIRECTORY ${manual_folder}/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT runtime FILES_MATCHING PATTERN "*.1")
