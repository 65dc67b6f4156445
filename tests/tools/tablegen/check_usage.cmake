# Usage errors: status 2 and a message that names the argument.
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
