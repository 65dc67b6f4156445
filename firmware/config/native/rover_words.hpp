// rover_words.hpp - the integer types that estimation kernels compute with: the machine's own.
// A host build may put another folder first on the include path (tools/opcount) whose types count
// every operation; nothing else differs between the two builds.
#pragma once

#include <stdint.h>

namespace rover {

using U8 = uint8_t;
using S8 = int8_t;
using U16 = uint16_t;
using S16 = int16_t;
using U32 = uint32_t;
using S32 = int32_t;

}  // namespace rover
