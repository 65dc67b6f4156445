# Every header of firmware and hal, included alone, compiles for a freestanding 16 bit target with
# packed structs. MSP430 stands for the 8085 here: 16 bit int and pointers, in stock clang.
include(${CMAKE_CURRENT_LIST_DIR}/programs.cmake)
need(CLANG clang++-19 clang-19)

file(GLOB_RECURSE headers RELATIVE ${ROOT} ${ROOT}/firmware/*.hpp ${ROOT}/hal/*.hpp)
list(LENGTH headers count)
if(count LESS 5)
  message(FATAL_ERROR "only ${count} headers found under ${ROOT}")
endif()
set(failures)
foreach(header ${headers})
  file(WRITE ${OUT}/alone.cpp "#include \"${header}\"\n")
  execute_process(
    COMMAND ${CLANG} --target=msp430-none-elf -std=c++20 -ffreestanding -fno-exceptions -fno-rtti
      -fpack-struct=1 -fsyntax-only -Wall -Wextra -Werror -I${ROOT}
      -I${ROOT}/firmware/config/native -I${ROOT}/toolchain/include ${OUT}/alone.cpp
    RESULT_VARIABLE result ERROR_VARIABLE text)
  if(NOT result EQUAL 0)
    string(APPEND failures "${header}:\n${text}\n")
  endif()
endforeach()
if(failures)
  message(FATAL_ERROR "Not fit for a 16 bit target:\n${failures}")
endif()
message(STATUS "${count} headers compile for a 16 bit target")
