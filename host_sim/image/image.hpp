// image.hpp - a program as bytes at addresses; Intel HEX and BIN in and out.
// Depends on   the standard library.
// Source       Intel Hexadecimal Object File Format Specification, revision A (1988).
// Modelled     record types 00, 01, 03, 05, and 02 and 04 as far as they say "base 0".
// Strict       what a reader does not understand completely is refused with file and line: a wrong
//              byte in the program store is found by nobody else.
#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace host_sim {

inline constexpr std::size_t kAddressSpaceSize = 0x10000;

/// What an unprogrammed EEPROM holds, and so the value of a byte that no image has.
inline constexpr uint8_t kErasedByte = 0xFF;

/// Both ends included, so that 0000H-FFFFH can be said.
struct AddressRange {
    uint16_t first = 0;
    uint16_t last = 0xFFFF;
    bool operator==(const AddressRange&) const = default;
};

/// An image or symbol file that cannot be used. The text is complete: "file:line: what; what to
/// do".
class ImageError : public std::runtime_error {
public:
    /// @param line  0: concerns the whole file
    ImageError(std::string_view file, std::size_t line, std::string_view what,
               std::string_view advice);
    [[nodiscard]] std::size_t line() const { return line_; }

private:
    std::size_t line_;
};

/// 64 KB of memory with the places that the program occupies.
struct Image {
    std::vector<uint8_t> bytes = std::vector<uint8_t>(kAddressSpaceSize, kErasedByte);
    std::bitset<kAddressSpaceSize> present;
    std::optional<uint16_t> start;  ///< where execution begins, if the file says so
    std::string file{};             ///< where it came from, for messages
    /// Line of the HEX file that gave each byte; empty for images from elsewhere.
    std::vector<uint32_t> lines{};

    /// Puts a byte, replacing what is there.
    void put(uint16_t address, uint8_t value) {
        bytes[address] = value;
        present.set(address);
    }
    [[nodiscard]] std::size_t byte_count() const { return present.count(); }
    /// Lowest and highest occupied address; nothing if empty.
    [[nodiscard]] std::optional<AddressRange> extent() const;
    /// The occupied ranges in ascending order.
    [[nodiscard]] std::vector<AddressRange> segments() const;
    /// Same bytes at the same addresses, same start.
    [[nodiscard]] bool same_content(const Image& other) const {
        return bytes == other.bytes && present == other.present && start == other.start;
    }
};

/// Reads Intel HEX.
/// @param file  name for messages
/// @errors  ImageError: anything but records and empty lines, damage, an address twice or beyond
///          FFFFH, no data, no end record or something behind it
[[nodiscard]] Image read_hex(std::string_view text, std::string_view file);

/// Reads raw bytes, placed from `load_address` on.
/// @errors  ImageError: empty, or does not fit below FFFFH
[[nodiscard]] Image read_bin(std::string_view content, uint16_t load_address,
                             std::string_view file);

/// @errors  ImageError: also when the file cannot be read
[[nodiscard]] Image load_hex(const std::filesystem::path& path);
[[nodiscard]] Image load_bin(const std::filesystem::path& path, uint16_t load_address);

/// Intel HEX of an image: records of up to 16 bytes, a start record (05) if there is a start.
[[nodiscard]] std::string write_hex(const Image& image);

/// The bytes of a range, `fill` where the image has none.
[[nodiscard]] std::string write_bin(const Image& image, AddressRange range,
                                    uint8_t fill = kErasedByte);

/// @errors  ImageError naming the first byte outside of `range`, with its line if it is known
/// @param what  the range's name in the message, as "ROM"
void check_range(const Image& image, AddressRange range, std::string_view what);

/// The content of a file of at most 16 MiB. @errors ImageError
[[nodiscard]] std::string read_image_file(const std::filesystem::path& path);

}  // namespace host_sim
