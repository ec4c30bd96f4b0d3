# Run at build time: writes OUTPUT from INPUT with the commit of SOURCE_DIR; unchanged text leaves the file alone.
set(HWSIM_COMMIT "unknown")
execute_process(COMMAND git -C ${SOURCE_DIR} rev-parse --short=12 HEAD
                OUTPUT_VARIABLE commit RESULT_VARIABLE failed OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT failed)
  set(HWSIM_COMMIT ${commit})
  execute_process(COMMAND git -C ${SOURCE_DIR} diff --quiet HEAD -- RESULT_VARIABLE changed ERROR_QUIET)
  if(changed)
    string(APPEND HWSIM_COMMIT "+changes")
  endif()
endif()
configure_file(${INPUT} ${OUTPUT} @ONLY)
