// little_endian.hpp - integers to and from bytes, least significant byte first, on any machine.
// Internal     to host_sim_log.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace host_sim::detail {

template <std::size_t kBytes>
void put_le(std::string& out, std::uint64_t value) {
    char bytes[kBytes];
    for (std::size_t i = 0; i < kBytes; ++i) bytes[i] = static_cast<char>(value >> (8 * i) & 0xFFu);
    out.append(bytes, kBytes);
}

/// The caller has checked that kBytes bytes are there.
template <std::size_t kBytes>
std::uint64_t get_le(std::string_view bytes, std::size_t at) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < kBytes; ++i) {
        const auto byte = static_cast<unsigned char>(bytes[at + i]);
        value |= std::uint64_t{byte} << (8 * i);
    }
    return value;
}

}  // namespace host_sim::detail
