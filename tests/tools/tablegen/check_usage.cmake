# Usage errors give status 2 and a message; a missing folder gives status 3 and its name.
foreach(arguments "square;--entries;0" "square;--scale;-1" "nonsense")
  execute_process(COMMAND ${PROGRAM} ${arguments} RESULT_VARIABLE result ERROR_VARIABLE message
    OUTPUT_QUIET)
  if(NOT result EQUAL 2)
    message(FATAL_ERROR "`tablegen ${arguments}` gave status ${result}, not 2")
  endif()
  if(message STREQUAL "")
    message(FATAL_ERROR "`tablegen ${arguments}` gave no message")
  endif()
endforeach()
execute_process(COMMAND ${PROGRAM} write --root /nonexistent RESULT_VARIABLE result
  ERROR_VARIABLE message OUTPUT_QUIET)
if(NOT result EQUAL 3 OR NOT message MATCHES "/nonexistent/firmware")
  message(FATAL_ERROR "a missing folder gave status ${result}: ${message}")
endif()
