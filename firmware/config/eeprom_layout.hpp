// eeprom_layout.hpp - who owns which part of the EEPROM, and the record that makes an image
// bootable. Depends on   hal/board/rb85.hpp. Use          loader, application and the host's image
// files read the same numbers. Normative    docs/spec/loader.md, docs/spec/memory-map.md
#pragma once

#include "hal/board/rb85.hpp"

namespace rover::loader {

// -- EEPROM --------------------------------------------------------------------------------------
inline constexpr uint16_t kPageSize = 64;  ///< what the 28C256 writes in one cycle

/// Never written by the loader: start and program below.
inline constexpr uint16_t kLoaderLast = 0x0BFF;
inline constexpr uint16_t kStartLast = 0x01FF;           ///< runs from ROM
inline constexpr uint16_t kStoredProgramFirst = 0x0200;  ///< copied to RAM and run there

/// The image: vectors as at 0000H, then everything else.
inline constexpr uint16_t kApplicationFirst = 0x0C00;
inline constexpr uint16_t kApplicationLast = 0x7FBF;

/// The last page: the boot record.
inline constexpr uint16_t kRecordPage = 0x7FC0;
static_assert(kRecordPage == hal::rb85::kEepromLast + 1 - kPageSize);
static_assert(kApplicationFirst % kPageSize == 0 && kRecordPage % kPageSize == 0);

// -- RAM while the loader runs -------------------------------------------------------------------
inline constexpr uint16_t kProgramFirst = 0xE000;
inline constexpr uint16_t kProgramSize = kLoaderLast + 1 - kStoredProgramFirst;
inline constexpr uint16_t kEntryReason = 0xEFFF;  ///< an Entry, left by the start

/// Why the loader runs.
enum class Entry : uint8_t {
    no_image = 0,  ///< no valid boot record
    hello = 1,     ///< a hello frame came in the listening window
    asked = 2,     ///< the application was told to
};

// -- Boot record ---------------------------------------------------------------------------------

/// In the record page, words low byte first. An image is started only with a valid one.
struct BootRecord {
    uint8_t magic[4];      ///< "R85B"
    uint16_t image_size;   ///< the image ends before this address
    uint16_t image_crc;    ///< as in the identity block
    uint16_t identity_at;  ///< address of the identity block
    uint16_t crc;          ///< CRC-16/CCITT-FALSE of the bytes before
};
inline constexpr uint8_t kBootRecordSize = 12;
inline constexpr uint8_t kBootRecordChecked = kBootRecordSize - 2;
inline constexpr uint8_t kRecordMagic[4] = {'R', '8', '5', 'B'};

}  // namespace rover::loader
