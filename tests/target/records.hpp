// records.hpp - the structs that cross the target's mailbox, as the bytes that they are there:
// packed, least significant byte first.
// Depends on   firmware/executive/controller.hpp.
// Why listed   the host's structs have padding and the target's have none. A field that is missing
//              here shows: the record is then shorter than the target's variable.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include "firmware/executive/controller.hpp"

namespace target_test {

/// A struct as bytes, with the name of what every byte belongs to.
class Record {
public:
    template <class T>
        requires(std::is_integral_v<T> || std::is_enum_v<T>)
    void field(const char* name, const T& value) {
        uint64_t bits = 0;
        if constexpr (std::is_enum_v<T>) {
            bits = static_cast<uint64_t>(static_cast<std::underlying_type_t<T>>(value));
        } else {
            bits = static_cast<uint64_t>(value);
        }
        for (std::size_t i = 0; i < sizeof(T); ++i, bits >>= 8) {
            bytes_.push_back(static_cast<uint8_t>(bits));
            names_.push_back(name);
        }
    }
    template <class T, std::size_t kCount>
    void field(const char* name, const T (&values)[kCount]) {
        for (const T& value : values) field(name, value);
    }

    [[nodiscard]] const std::vector<uint8_t>& bytes() const { return bytes_; }
    /// "position_q4_mm + 2": the field of a byte, and where the byte is in it.
    [[nodiscard]] std::string name_at(std::size_t offset) const;

private:
    std::vector<uint8_t> bytes_;
    std::vector<const char*> names_;
};

[[nodiscard]] Record record_of(const hal::Calibration& calibration);
[[nodiscard]] Record record_of(const hal::RawInputs& inputs);
[[nodiscard]] Record record_of(const hal::Commands& commands);
[[nodiscard]] Record record_of(const rover::Controller& controller);

}  // namespace target_test
