// program.hpp - a linked program: every section at its address, every symbol's value, the bytes.
// Made by      link().      Read by   listing, map, symbol file, image files, verify.
#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "toolchain/asm/object.hpp"

namespace toolchain::assembly {

inline constexpr std::size_t kMemorySize = 0x10000;

/// Both ends included.
struct AddressRange {
    uint16_t first = 0;
    uint16_t last = 0xFFFF;

    [[nodiscard]] uint32_t size() const { return static_cast<uint32_t>(last) - first + 1; }
    bool operator==(const AddressRange&) const = default;
};

/// A part of memory that a program uses as a whole.
struct Region {
    uint32_t first = 0;
    uint32_t size = 0;

    [[nodiscard]] uint32_t end() const { return first + size; }  ///< first address behind it
    bool operator==(const Region&) const = default;
};

struct PlacedSection {
    Section section{};  ///< locations refer to Program::files
    uint16_t address = 0;
    uint32_t size = 0;
    uint16_t load_address = 0;  ///< of initialised data: where ROM holds it; else as address
};

struct Symbol {
    std::string name{};
    uint16_t value = 0;
    uint32_t size = 0;                     ///< bytes; 0: a label
    LabelKind kind = LabelKind::label;     ///< never automatic
    std::optional<std::size_t> section{};  ///< index into Program::sections; nothing: a number
    Location location{};
};

/// 64 KB of memory with the places that the program occupies.
struct Image {
    std::vector<uint8_t> bytes = std::vector<uint8_t>(kMemorySize, 0xFF);
    std::bitset<kMemorySize> present{};
};

struct Program {
    std::vector<std::string> files{};
    std::vector<PlacedSection> sections{};  ///< by address
    std::vector<Symbol> symbols{};          ///< by value
    Image image{};
    std::optional<uint16_t> start{};  ///< where execution begins
    AddressRange rom{};
    AddressRange ram{};
    Region frames{};      ///< overlaid static frames
    Region data{};        ///< initialised, in RAM
    Region data_image{};  ///< its bytes in ROM
    Region zero{};        ///< cleared by start-up; of even size if there is a start-up
    Region stack{};
    /// From the first instruction to the first call, if link() made the start-up.
    std::optional<uint32_t> startup_t_states{};

    /// The symbol of that name that is not local, or nullptr.
    [[nodiscard]] const Symbol* find(std::string_view name) const {
        for (const Symbol& symbol : symbols) {
            if (symbol.name == name && !is_local(name)) return &symbol;
        }
        return nullptr;
    }
};

}  // namespace toolchain::assembly
