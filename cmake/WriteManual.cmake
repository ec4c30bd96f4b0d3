# cmake -D PROGRAM=hwsim -D HELP2MAN=help2man -D OUT=folder -D VERSION=0.1.0 -D ABOUT=words -P WriteManual.cmake
file(MAKE_DIRECTORY ${OUT})

function(write_page name about)
  execute_process(COMMAND ${HELP2MAN} --no-info --version-string=${VERSION} --name=${about} --output=${OUT}/${name}.1 ${ARGN}
                  COMMAND_ERROR_IS_FATAL ANY)
  # Each example is a line of its own.
  file(READ ${OUT}/${name}.1 page)
  string(REGEX REPLACE "\nhwsim " "\n.br\nhwsim " page "${page}")
  file(WRITE ${OUT}/${name}.1 "${page}")
endfunction()

execute_process(COMMAND ${PROGRAM} --help OUTPUT_VARIABLE help COMMAND_ERROR_IS_FATAL ANY)
write_page(hwsim ${ABOUT} ${PROGRAM})
string(REGEX REPLACE "^.*\nSubcommands:\n" "" commands "${help}")
string(REPLACE ";" "," commands "${commands}")
string(REGEX MATCHALL "  [a-z]+ +[^\n]+" commands "${commands}")
foreach(line IN LISTS commands)
  string(REGEX MATCH "^  ([a-z]+) +([^.:;,]+)" ignored "${line}")
  write_page(hwsim-${CMAKE_MATCH_1} ${CMAKE_MATCH_2} "${PROGRAM} ${CMAKE_MATCH_1}")
endforeach()
