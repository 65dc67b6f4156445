// identity.hpp - the identity block of a program image: found, checked, filled in after linking.
// Depends on   host_sim/image/image.hpp, firmware/config/eeprom_layout.hpp: the application's part
// of the
//              EEPROM is what is checked; the loader beside it is not part of an image's identity.
// Normative    docs/design/image.md, "The identity block". The firmware declares it with zeros as
//              `rover_identity`; what the linker cannot know is stamped in.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "host_sim/image/image.hpp"

namespace host_sim {

/// Begins the block; the eighth character is a zero byte.
inline constexpr std::string_view kIdentityMagic{"ROVER85", 8};
inline constexpr uint8_t kIdentityFormat = 1;

/// Bytes from the block's first one. Words are stored low byte first.
struct IdentityOffset {
    static constexpr std::size_t format = 8;
    static constexpr std::size_t version = 9;  ///< major, minor, patch
    static constexpr std::size_t source_hash = 12;
    static constexpr std::size_t image_size = 16;
    static constexpr std::size_t image_crc = 18;
    static constexpr std::size_t vehicle = 20;
    static constexpr std::size_t end = 28;
};
inline constexpr std::size_t kVehicleNameSize = IdentityOffset::end - IdentityOffset::vehicle;

struct ImageVersion {
    uint8_t major = 0, minor = 0, patch = 0;
    bool operator==(const ImageVersion&) const = default;
};

/// Which program an image is.
struct ImageIdentity {
    uint16_t address = 0;  ///< of the block
    ImageVersion version;
    uint32_t source_hash = 0;  ///< of the firmware's sources; the host build of them has the same
    uint16_t image_size = 0;   ///< it ends before this address
    uint16_t image_crc = 0;    ///< CRC-16 from kApplicationFirst on, its own field taken as 0
    std::string vehicle;

    bool operator==(const ImageIdentity&) const = default;
};

/// Bytes of the application, gaps included.
[[nodiscard]] std::size_t byte_count(const ImageIdentity& identity);

/// Fills version, hash, size and CRC into the block that the program holds. The vehicle is the
/// program's own.
/// @return  what the image is now
/// @errors  ImageError: no block or several, another format, nothing at kApplicationFirst, bytes
///          beyond the EEPROM, a vehicle name that is not text
ImageIdentity stamp_identity(Image& image, ImageVersion version, uint32_t source_hash);

/// The identity of a stamped image.
/// @errors  ImageError: as stamping; also when the image was never stamped, size or CRC do not fit,
///          or the boot record beside it is not its own
[[nodiscard]] ImageIdentity read_identity(const Image& image);

/// "rover85 0.1.0 sources 1a2b3c4d": as the host build says it of itself.
[[nodiscard]] std::string describe_sources(const ImageIdentity& identity);

/// The same with vehicle, size and CRC.
[[nodiscard]] std::string describe(const ImageIdentity& identity);

/// Reads "0.1.0". Nothing if it is not three numbers up to 255.
[[nodiscard]] std::optional<ImageVersion> parse_version(std::string_view text);

}  // namespace host_sim
