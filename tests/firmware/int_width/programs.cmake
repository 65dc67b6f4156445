cmake_minimum_required(VERSION 3.25)

# need(VARIABLE program package): the program's path, or a failure that names the Debian package.
function(need variable program package)
  find_program(${variable} ${program} NO_CACHE)
  if(NOT ${variable})
    message(FATAL_ERROR "${program} is missing: apt-get install ${package}")
  endif()
  set(${variable} ${${variable}} PARENT_SCOPE)
endfunction()

# run(OUTPUT_VARIABLE command...): standard output and error together; a failure shows them.
function(run variable)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE text ERROR_VARIABLE text)
  if(NOT result EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "failed (${result}): ${command}\n${text}")
  endif()
  set(${variable} "${text}" PARENT_SCOPE)
endfunction()
