// protocol.hpp - frames between a host and the loader: types, results, payloads.
// Depends on   link/frames.hpp (their form), config/eeprom_layout.hpp.
// Normative    docs/spec/loader.md
#pragma once

#include "firmware/config/eeprom_layout.hpp"
#include "firmware/link/frames.hpp"

namespace rover::loader {

inline constexpr uint8_t kProtocolVersion = 1;
inline constexpr uint8_t kLoaderVersion = 1;

/// An address and a page. Both directions open frames as the application's do.
using ToLoader = FrameFormat<Uplink::kSync0, Uplink::kSync1, 2 + kPageSize>;
using FromLoader = FrameFormat<Downlink::kSync0, Downlink::kSync1, 2 + kPageSize>;

/// Requests. The answer to each has its type with bit 7 set; the application uses none of them.
enum class Request : uint8_t {
    hello = 0x10,  ///< no payload. Answer: Hello
    open = 0x11,   ///< no payload. The image is not bootable from here on, and can be written
    write = 0x12,  ///< u16 address, 64 bytes: a page of the application
    check = 0x13,  ///< u16 address, u8 count up to kChecksMax. Answer: address, CRC-16 of each page
    read = 0x14,   ///< u16 address, u8 count up to kPageSize. Answer: address, bytes
    close = 0x15,  ///< u16 address of the identity block. Verifies the image, makes it bootable
    start = 0x16,  ///< no payload. Resets into the image
};
inline constexpr uint8_t kAnswerBit = 0x80;
inline constexpr uint8_t kChecksMax = kPageSize / 2;

/// Answer to open, write, close and start; to every other request that is refused as well.
enum class Result : uint8_t {
    done = 0,
    unknown_type = 1,
    wrong_size = 2,
    wrong_address = 3,  ///< not a page of the application; not in the EEPROM
    not_open = 4,       ///< a page or the end comes before `open`
    no_end = 5,         ///< the EEPROM did not end its write cycle in time
    differs = 6,        ///< `address` reads `found`, not `expected`
    no_identity = 7,    ///< no identity block at `address`
    wrong_image_size = 8,
    wrong_crc = 9,      ///< of the image; `address` is what was computed
    not_bootable = 10,  ///< `start` without a valid boot record
};

/// Payload of those answers.
struct Report {
    Result result = Result::done;
    uint8_t address[2] = {};
    uint8_t expected = 0;
    uint8_t found = 0;
};
static_assert(sizeof(Report) == 5);

/// Payload of the answer to `hello`.
struct Hello {
    uint8_t protocol_version;
    uint8_t loader_version;
    uint8_t application_first[2];
    uint8_t application_end[2];  ///< the record page
    uint8_t page_size;
    Entry entry;
    uint8_t is_open;       ///< 1: pages can be written
    uint8_t bootable;      ///< 1: boot record valid, and the rest is that of the image
    uint8_t identity[20];  ///< as in the link's identity frame; zeros if not bootable
};
static_assert(sizeof(Hello) == 30);

/// How long the start listens for a hello frame behind every reset.
inline constexpr uint16_t kListenMs = 60;
/// Behind so long without a frame the loader lets the watchdog reset the board: into a bootable
/// image, else into the loader again, from a clean start.
inline constexpr uint16_t kPatienceMs = 3000;

/// The hello frame, byte by byte: what the start compares with.
struct HelloFrame {
    uint8_t bytes[kFrameOverhead] = {Uplink::kSync0, Uplink::kSync1,
                                     static_cast<uint8_t>(Request::hello), 0};
    constexpr HelloFrame() {
        const uint16_t crc = crc16_block(kCrc16Start, bytes + 2, 2);
        bytes[4] = narrow_wrap_u8(crc);
        bytes[5] = narrow_wrap_u8(shift_floor<8>(crc));
    }
};
inline constexpr HelloFrame kHelloFrame;

}  // namespace rover::loader
