// identity.cpp - see identity.hpp.
#include "host_sim/image/identity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <span>
#include <vector>

#include "firmware/config/eeprom_layout.hpp"
#include "host_sim/image/board_image.hpp"
#include "host_sim/image/checksum.hpp"

namespace host_sim {
namespace {

constexpr std::size_t kFirst = rover::loader::kApplicationFirst;
constexpr std::size_t kEnd = rover::loader::kRecordPage;

constexpr const char* kStampIt = "build it with the project's own rule, which stamps it";

[[noreturn]] void refuse(const Image& image, std::string_view what, std::string_view advice) {
    throw ImageError(image.file, 0, what, advice);
}

uint32_t get(const Image& image, std::size_t at, unsigned size) {
    uint32_t value = 0;
    for (unsigned i = 0; i < size; ++i) value |= uint32_t{image.bytes[at + i]} << (8 * i);
    return value;
}

void set(Image& image, std::size_t at, unsigned size, uint32_t value) {
    for (unsigned i = 0; i < size; ++i) {
        image.put(static_cast<uint16_t>(at + i), static_cast<uint8_t>(value >> (8 * i)));
    }
}

std::string version_text(ImageVersion version) {
    return fmt::format("{}.{}.{}", version.major, version.minor, version.patch);
}

/// Where the only block is. The loader in front knows the magic as well.
uint16_t find_block(const Image& image) {
    std::vector<std::size_t> found;
    const auto end = image.bytes.end();
    for (auto at = image.bytes.begin() + kFirst;; ++at) {
        at = std::search(at, end, kIdentityMagic.begin(), kIdentityMagic.end(),
                         [](uint8_t byte, char letter) { return byte == uint8_t(letter); });
        if (at == end) break;
        found.push_back(static_cast<std::size_t>(at - image.bytes.begin()));
    }
    if (found.empty()) {
        refuse(image, "holds no identity block (\"ROVER85\" and a zero byte)",
               "give a rover85 image; a program of your own declares `rover_identity`");
    }
    if (found.size() > 1) {
        refuse(image,
               fmt::format("holds the identity block more than once, at {:04X}H and {:04X}H",
                           found[0], found[1]),
               "link the program with one `rover_identity`");
    }
    for (std::size_t at = found[0]; at < found[0] + IdentityOffset::end; ++at) {
        if (at < kAddressSpaceSize && image.present[at]) continue;
        refuse(image, fmt::format("ends inside of the identity block at {:04X}H", found[0]),
               "the file is cut off or no rover85 image");
    }
    const uint8_t format = image.bytes[found[0] + IdentityOffset::format];
    if (format != kIdentityFormat) {
        refuse(
            image,
            fmt::format("has an identity block of format {}, known is {}", format, kIdentityFormat),
            "use the rover85 of the same version");
    }
    return static_cast<uint16_t>(found[0]);
}

std::string vehicle_name(const Image& image, std::size_t block) {
    const auto first = image.bytes.begin() + static_cast<std::ptrdiff_t>(block) +
                       static_cast<std::ptrdiff_t>(IdentityOffset::vehicle);
    const auto last = first + static_cast<std::ptrdiff_t>(kVehicleNameSize);
    const auto end = std::find(first, last, uint8_t{0});
    const bool text = std::all_of(first, end, [](uint8_t c) { return c >= ' ' && c <= '~'; }) &&
                      std::all_of(end, last, [](uint8_t c) { return c == 0; });
    if (!text || first == end) {
        refuse(image, "has a vehicle name in its identity block that is not text",
               "give up to 8 characters, the rest zero bytes");
    }
    return {first, end};
}

/// Highest occupied address of the application + 1.
uint16_t size_of(const Image& image) {
    check_range(image, {hal::rb85::kEepromFirst, hal::rb85::kEepromLast}, "the EEPROM");
    if (!image.present[kFirst]) {
        refuse(image,
               fmt::format("has nothing at address {:04X}H, where the loader starts it", kFirst),
               fmt::format("link the program for {:04X}H-{:04X}H with its vectors at {:04X}H",
                           kFirst, kEnd - 1, kFirst));
    }
    std::size_t end = kEnd;
    while (!image.present[end - 1]) --end;
    return static_cast<uint16_t>(end);
}

uint16_t crc_of(const Image& image, std::size_t block, std::size_t size) {
    std::vector<uint8_t> bytes(image.bytes.begin(),
                               image.bytes.begin() + static_cast<std::ptrdiff_t>(size));
    bytes[block + IdentityOffset::image_crc] = 0;
    bytes[block + IdentityOffset::image_crc + 1] = 0;
    return crc16_ccitt_false(std::span(bytes).subspan(kFirst));
}

ImageIdentity block_at(const Image& image, uint16_t block) {
    ImageIdentity identity;
    identity.address = block;
    identity.version = {image.bytes[block + IdentityOffset::version],
                        image.bytes[block + IdentityOffset::version + 1],
                        image.bytes[block + IdentityOffset::version + 2]};
    identity.source_hash = get(image, block + IdentityOffset::source_hash, 4);
    identity.image_size = static_cast<uint16_t>(get(image, block + IdentityOffset::image_size, 2));
    identity.image_crc = static_cast<uint16_t>(get(image, block + IdentityOffset::image_crc, 2));
    identity.vehicle = vehicle_name(image, block);
    return identity;
}

}  // namespace

ImageIdentity stamp_identity(Image& image, ImageVersion version, uint32_t source_hash) {
    const uint16_t block = find_block(image);
    const uint16_t size = size_of(image);
    (void)vehicle_name(image, block);
    set(image, block + IdentityOffset::version, 1, version.major);
    set(image, block + IdentityOffset::version + 1, 1, version.minor);
    set(image, block + IdentityOffset::version + 2, 1, version.patch);
    set(image, block + IdentityOffset::source_hash, 4, source_hash);
    set(image, block + IdentityOffset::image_size, 2, size);
    set(image, block + IdentityOffset::image_crc, 2, crc_of(image, block, size));
    return read_identity(image);
}

ImageIdentity read_identity(const Image& image) {
    const ImageIdentity identity = block_at(image, find_block(image));
    if (identity.image_size == 0) refuse(image, "has never been stamped", kStampIt);
    const std::size_t block_end = identity.address + IdentityOffset::end;
    if (identity.image_size < block_end) {
        refuse(image,
               fmt::format("says it ends at {:04X}H, but its identity block does at {:04X}H",
                           identity.image_size, block_end),
               kStampIt);
    }
    const std::size_t last = std::size_t{size_of(image)} - 1;
    // A BIN that was padded has more bytes than the program, all of them erased ones.
    for (std::size_t at = identity.image_size; at <= last; ++at) {
        if (image.bytes[at] == kErasedByte) continue;
        refuse(image,
               fmt::format("says it ends at {:04X}H, but there is a byte at {:04X}H",
                           identity.image_size, at),
               "it was changed after it was stamped; build it anew");
    }
    if (last + 1 < identity.image_size) {
        refuse(image,
               fmt::format("says it ends at {:04X}H, but does at {:04X}H", identity.image_size,
                           last + 1),
               "the file is cut off; copy or build it anew");
    }
    const uint16_t crc = crc_of(image, identity.address, identity.image_size);
    if (crc != identity.image_crc) {
        refuse(image,
               fmt::format("has the CRC-16 {:04X}H, its identity block says {:04X}H", crc,
                           identity.image_crc),
               "it was changed after it was stamped; build it anew");
    }
    check_boot_record(image, identity);
    return identity;
}

std::size_t byte_count(const ImageIdentity& identity) {
    return identity.image_size - kFirst;
}

std::string describe_sources(const ImageIdentity& identity) {
    return fmt::format("rover85 {} sources {:08x}", version_text(identity.version),
                       identity.source_hash);
}

std::string describe(const ImageIdentity& identity) {
    return fmt::format("{} vehicle {}, {} bytes, CRC-16 {:04X}H", describe_sources(identity),
                       identity.vehicle, byte_count(identity), identity.image_crc);
}

std::optional<ImageVersion> parse_version(std::string_view text) {
    std::array<uint8_t, 3> numbers{};
    const char* at = text.data();
    const char* const end = at + text.size();
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        if (i > 0 && (at == end || *at++ != '.')) return {};
        const auto [next, error] = std::from_chars(at, end, numbers[i]);
        if (error != std::errc() || next == at) return {};
        at = next;
    }
    if (at != end) return {};
    return ImageVersion{numbers[0], numbers[1], numbers[2]};
}

}  // namespace host_sim
