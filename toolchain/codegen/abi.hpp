// abi.hpp - where arguments and results are: the rules of docs/spec/abi.md as functions.
// Depends on   mir.hpp.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "toolchain/codegen/mir.hpp"

namespace toolchain::codegen {

/// Where one value is: in registers, one for each byte, or in memory.
struct ValuePlace {
    std::vector<Register> registers{};
    uint32_t offset = 0;  ///< in the memory of all values; if there are no registers
};

struct ValuePlaces {
    std::vector<ValuePlace> values{};
    uint32_t memory_bytes = 0;
};

/// Places of arguments, in their order.
/// @param sizes            in bytes
/// @param through_pointer  HL is not for arguments: the target of an indirect call is there
[[nodiscard]] ValuePlaces place_arguments(std::span<const std::size_t> sizes, bool through_pointer);

/// Place of a result: where a first argument would be.
[[nodiscard]] ValuePlaces place_result(std::size_t size);

/// "p2_1r4": arguments of 2 and 1 bytes, result of 4. Fits into a symbol.
[[nodiscard]] std::string signature_text(std::span<const std::size_t> sizes, std::size_t result);

/// Names of static memory for arguments and results that do not fit into registers. No name in C
/// has an @, so they meet no variable of the program (a static local of f is `f.name`).
[[nodiscard]] std::string arguments_name(const std::string& function);
[[nodiscard]] std::string result_name(const std::string& function);
[[nodiscard]] std::string shared_arguments_name(const std::string& signature);
[[nodiscard]] std::string shared_result_name(const std::string& signature);
/// @return true for the last two
[[nodiscard]] bool is_shared_name(const std::string& name);

/// The routine that an indirect call goes through: PCHL.
inline constexpr const char* kCallThroughHl = "__callhl";

}  // namespace toolchain::codegen
