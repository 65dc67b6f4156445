# Builds the probe for an ATmega2560 (16 bit int), runs it in simavr and compares every group's
# checksum with the native run. The first difference names the group.
include(${CMAKE_CURRENT_LIST_DIR}/programs.cmake)
need(CLANG clang++-19 clang-19)
need(AVR_GCC avr-gcc gcc-avr)
need(AVR_LD avr-ld binutils-avr)
need(SIMAVR simavr simavr)
if(NOT EXISTS /usr/lib/avr/include/avr/io.h)
  message(FATAL_ERROR "the C start-up code for AVR is missing: apt-get install avr-libc")
endif()

set(device -mmcu=atmega2560)
set(objects)
# At -O2: at -Os clang 19 makes AVR code that finds a sinkage of 0 where -O1, -O2, the native build
# (also under the sanitizers) and the 8085 image at every level agree.
foreach(source probe_avr.cpp ${GROUPS})
  set(object ${OUT}/${source}.avr.o)
  run(ignored ${CLANG} --target=avr ${device} -std=c++20 -O2 -ffreestanding
    -fno-exceptions -fno-rtti -Wall -Wextra -Werror -I${ROOT} -I${ROOT}/firmware/config/native -I${CMAKE_CURRENT_LIST_DIR}
    -c ${CMAKE_CURRENT_LIST_DIR}/${source} -o ${object})
  list(APPEND objects ${object})
endforeach()
run(ignored ${AVR_GCC} ${device} ${objects} -o ${OUT}/int_width_probe.elf)

# simavr's log holds colours and a stop at each line's end: take the probe's own lines only.
function(probe_lines variable)
  run(text ${ARGN})
  string(REGEX MATCHALL "probe [a-z0-9_]+( [0-9a-f]+)?" lines "${text}")
  if(NOT "probe end" IN_LIST lines)
    message(FATAL_ERROR "the probe did not reach its end: ${ARGN}\n${text}")
  endif()
  set(${variable} ${lines} PARENT_SCOPE)
endfunction()
probe_lines(wide ${PROBE})
probe_lines(narrow ${SIMAVR} -m atmega2560 -f 16000000 ${OUT}/int_width_probe.elf)

list(LENGTH wide wide_count)
list(LENGTH narrow narrow_count)
if(NOT wide_count EQUAL narrow_count OR wide_count LESS 10)
  message(FATAL_ERROR "${wide_count} groups on the host, ${narrow_count} on the AVR")
endif()
foreach(here there IN ZIP_LISTS wide narrow)
  if(NOT here STREQUAL there)
    message(FATAL_ERROR "int of 32 bits: ${here}\nint of 16 bits: ${there}")
  endif()
endforeach()
math(EXPR compared "${wide_count} - 1")
message(STATUS "${compared} groups give the same bits with int of 16 and of 32 bits")
