// abi.cpp - see abi.hpp.
#include "toolchain/codegen/abi.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <optional>

namespace toolchain::codegen {

namespace {

using Registers = std::vector<Register>;

/// Registers that no value has yet.
class FreeRegisters {
public:
    explicit FreeRegisters(bool without_hl) {
        if (without_hl) take({Register::l, Register::h});
    }

    std::optional<Registers> place(std::size_t size) {
        FreeRegisters left = *this;
        Registers registers;
        const std::size_t pairs = size / 2;
        if (size == 0 || size > kLargest) return std::nullopt;
        for (std::size_t i = 0; i < pairs; ++i) {
            if (!left.add_pair(registers)) return std::nullopt;
        }
        if (size % 2 != 0 && !left.add_byte(registers)) return std::nullopt;
        *this = left;
        return registers;
    }

private:
    static constexpr std::size_t kLargest = 4;

    [[nodiscard]] bool is_free(Register which) const { return (taken_ & set_of(which)) == 0; }
    void take(const Registers& registers) {
        for (const Register which : registers) taken_ |= set_of(which);
    }

    bool add_pair(Registers& registers) {
        constexpr std::array<std::array<Register, 2>, 3> kPairs = {
            {{Register::l, Register::h}, {Register::e, Register::d}, {Register::c, Register::b}}};
        for (const auto& [low, high] : kPairs) {
            if (!is_free(low) || !is_free(high)) continue;
            registers.insert(registers.end(), {low, high});
            take({low, high});
            return true;
        }
        return false;
    }

    bool add_byte(Registers& registers) {
        constexpr std::array<Register, 7> kBytes = {Register::a, Register::c, Register::b,
                                                    Register::e, Register::d, Register::l,
                                                    Register::h};
        for (const Register which : kBytes) {
            if (!is_free(which)) continue;
            registers.push_back(which);
            take({which});
            return true;
        }
        return false;
    }

    RegisterSet taken_ = 0;
};

}  // namespace

ValuePlaces place_arguments(std::span<const std::size_t> sizes, bool through_pointer) {
    FreeRegisters free(through_pointer);
    ValuePlaces places;
    for (const std::size_t size : sizes) {
        ValuePlace place;
        if (const auto registers = free.place(size)) {
            place.registers = *registers;
        } else {
            place.offset = places.memory_bytes;
            places.memory_bytes += static_cast<uint32_t>(size);
        }
        places.values.push_back(std::move(place));
    }
    return places;
}

ValuePlaces place_result(std::size_t size) {
    return place_arguments(std::array{size}, false);
}

std::string signature_text(std::span<const std::size_t> sizes, std::size_t result) {
    return fmt::format("p{}r{}", fmt::join(sizes, "_"), result);
}

std::string arguments_name(const std::string& function) {
    return function + "@args";
}

std::string result_name(const std::string& function) {
    return function + "@result";
}

std::string shared_arguments_name(const std::string& signature) {
    return "__args@" + signature;
}

std::string shared_result_name(const std::string& signature) {
    return "__result@" + signature;
}

bool is_shared_name(const std::string& name) {
    return name.starts_with("__args@") || name.starts_with("__result@");
}

}  // namespace toolchain::codegen
