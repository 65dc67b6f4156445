# Which firmware this tree holds: FIRMWARE_SOURCE_HASH, eight hexadecimal digits over all sources.
# The host build (host_sim/bind) and the image (rover_image) carry the same.
file(GLOB_RECURSE ROVER_FIRMWARE_SOURCES CONFIGURE_DEPENDS
  ${PROJECT_SOURCE_DIR}/firmware/*.hpp ${PROJECT_SOURCE_DIR}/firmware/*.cpp
  ${PROJECT_SOURCE_DIR}/hal/*.hpp)
list(SORT ROVER_FIRMWARE_SOURCES)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${ROVER_FIRMWARE_SOURCES})
set(all_hashes "")
foreach(source ${ROVER_FIRMWARE_SOURCES})
  file(SHA256 ${source} one_hash)
  string(APPEND all_hashes ${one_hash})
endforeach()
string(SHA256 firmware_hash "${all_hashes}")
string(SUBSTRING ${firmware_hash} 0 8 FIRMWARE_SOURCE_HASH)
