# rover_image(NAME SOURCES file ... [DIRECTORY folder] [OPTIONS option ...])
# A target NAME_image, part of the default build: compiles and links the sources with i85cc, stamps
# the identity block, and leaves NAME.hex .bin .map .lst .sym in the folder, by default where programs
# land. Built anew when a header of the firmware or of hal, the compiler or the identity changes.
# Needs ROVER_FIRMWARE_SOURCES and FIRMWARE_SOURCE_HASH of firmware_identity.cmake.

# Where `rover85` is, and so where it looks for its image.
function(rover_image_directory result)
  if(CMAKE_RUNTIME_OUTPUT_DIRECTORY)
    set(${result} ${CMAKE_RUNTIME_OUTPUT_DIRECTORY} PARENT_SCOPE)
  else()
    set(${result} ${CMAKE_BINARY_DIR}/tools/rover85 PARENT_SCOPE)
  endif()
endfunction()

# What i85cc needs, said before it fails: its own error would stand in the middle of a build.
function(rover_need_compiler)
  if(DEFINED ENV{I85CC_CLANG} AND NOT "$ENV{I85CC_CLANG}" STREQUAL "")
    set(clang $ENV{I85CC_CLANG})
  else()
    find_program(ROVER_CLANG clang-19 DOC "clang 19 (package clang-19)")
    set(clang ${ROVER_CLANG})
  endif()
  if(NOT TARGET i85cc OR NOT clang)
    message(FATAL_ERROR "The rover's image needs clang 19 and LLVM 19: run `tools/setup run`, or "
      "`apt-get install clang-19 llvm-19-dev`, or set I85CC_CLANG to the path of clang 19.")
  endif()
endfunction()

# The loader, in its two parts, which stands in front of every image. Addresses: eeprom_layout.hpp in
# firmware/config, which a test compares with what is linked.
set(ROVER_LOADER_DIRECTORY ${PROJECT_BINARY_DIR}/firmware/loader)
function(rover_loader)
  rover_need_compiler()
  file(MAKE_DIRECTORY ${ROVER_LOADER_DIRECTORY})
  set(start_options --rom 0-1FFH --ram 0FE00H-0FEFFH --forward 0C00H)
  set(program_options --rom 0E000H-0E9FFH --ram 0EA00H-0EFFEH --vectors 0E000H)
  set(outputs "")
  foreach(part start program)
    set(result ${ROVER_LOADER_DIRECTORY}/${part})
    add_custom_command(OUTPUT ${result}.hex
      COMMAND i85cc -Os --small-runtime -I. -Ifirmware/config/native ${${part}_options}
        -o ${result}.hex firmware/loader/${part}.cpp
      DEPENDS ${ROVER_FIRMWARE_SOURCES} i85cc
      WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}
      COMMENT "Compiling the loader: ${part}" VERBATIM)
    list(APPEND outputs ${result}.hex)
  endforeach()
  add_custom_target(rover85_loader ALL DEPENDS ${outputs})
endfunction()

function(rover_image name)
  cmake_parse_arguments(arg "" "DIRECTORY" "SOURCES;OPTIONS" ${ARGN})
  rover_need_compiler()
  if(NOT arg_DIRECTORY)
    rover_image_directory(arg_DIRECTORY)
  endif()
  set(linked ${CMAKE_CURRENT_BINARY_DIR}/${name}.linked)
  file(MAKE_DIRECTORY ${linked} ${arg_DIRECTORY})
  set(sources "")
  foreach(source ${arg_SOURCES})
    get_filename_component(source ${source} ABSOLUTE BASE_DIR ${CMAKE_CURRENT_SOURCE_DIR})
    list(APPEND sources ${source})
  endforeach()
  set(outputs "")
  foreach(ending hex bin map lst sym)
    list(APPEND outputs ${arg_DIRECTORY}/${name}.${ending})
  endforeach()
  # From the root, with relative paths: listing and symbols name sources as the repository does.
  set(relative "")
  foreach(source ${sources})
    file(RELATIVE_PATH path ${PROJECT_SOURCE_DIR} ${source})
    list(APPEND relative ${path})
  endforeach()
  add_custom_command(OUTPUT ${outputs}
    COMMAND i85cc -Os -I. -Ifirmware/config/native --rom 0C00H-7FBFH --vectors 0C00H
      ${arg_OPTIONS} -o ${linked}/${name}.hex ${relative}
    COMMAND rover_stamp ${linked}/${name}.hex -o ${arg_DIRECTORY}/${name}.hex
      --image-version ${PROJECT_VERSION} --sources ${FIRMWARE_SOURCE_HASH}
      --loader-start ${ROVER_LOADER_DIRECTORY}/start.hex
      --loader-program ${ROVER_LOADER_DIRECTORY}/program.hex
    DEPENDS ${sources} ${ROVER_FIRMWARE_SOURCES} i85cc rover_stamp
      ${ROVER_LOADER_DIRECTORY}/start.hex ${ROVER_LOADER_DIRECTORY}/program.hex
    WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}
    COMMENT "Compiling the image ${name}" VERBATIM)
  add_custom_target(${name}_image ALL DEPENDS ${outputs})
  add_dependencies(${name}_image rover85_loader)
endfunction()
