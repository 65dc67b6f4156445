# Compiles one case of must_not_compile.cpp and checks that it is refused for the stated reason.
file(STRINGS ${SOURCE} line REGEX "ROVER_CASE == ${CASE} +//")
execute_process(
  COMMAND ${COMPILER} -std=c++20 -fsyntax-only -I${ROOT} -I${ROOT}/firmware/config/native
    -DROVER_CASE=${CASE} ${SOURCE}
  RESULT_VARIABLE result ERROR_VARIABLE message OUTPUT_VARIABLE message)
if(CASE EQUAL 0)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "The control must compile, but:\n${message}")
  endif()
  return()
endif()
if(result EQUAL 0)
  message(FATAL_ERROR "This misuse compiles: ${line}")
endif()
string(REGEX REPLACE "^.*expect: " "" expected ${line})
if(NOT message MATCHES "${expected}")
  message(FATAL_ERROR "Refused, but not because of `${expected}`:\n${message}")
endif()
