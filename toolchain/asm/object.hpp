// object.hpp - what a program consists of before it has addresses: modules, sections, items.
// Filled by    the code generator (in memory) and by parse() (from text).    Read by   link().
// Depends on   the standard library.
// Design note  plain values; an instruction is its opcode byte and at most one operand. The section
//              is the unit that the linker keeps, drops, places and clones.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace toolchain::assembly {

/// Which part of a value goes into the program.
enum class Part : uint8_t { word, low, high };

/// A number, or the value of a symbol plus a number.
struct Operand {
    std::string symbol{};  ///< empty: only the number
    int32_t offset = 0;
    Part part = Part::word;  ///< low and high are taken after the offset has been added

    bool operator==(const Operand&) const = default;
};

/// A line of a source file.
struct Location {
    uint32_t file = 0;  ///< index into Module::files
    uint32_t line = 0;  ///< from 1; 0: not known

    [[nodiscard]] bool known() const { return line != 0; }
    bool operator==(const Location&) const = default;
};

/// What a label stands for in the symbol file.
enum class LabelKind : uint8_t {
    automatic,  ///< from its section: what code begins with is a function, other code labels are
                ///< labels, labels of data are data
    function,
    interrupt_entry,
    data,
    label,
};

enum class ItemKind : uint8_t {
    instruction,  ///< opcode, operand
    label,        ///< operand.symbol is its name, label_kind; size of what it names, or 0
    bytes,        ///< bytes
    byte,         ///< operand, stored as one byte
    word,         ///< operand, stored as two bytes, low one first
    space,        ///< size bytes of 00
    note,         ///< text about this address, taken into the map: "loop 16"
};

/// One thing in a section. Made by the functions below; only the fields named above count.
struct Item {
    ItemKind kind = ItemKind::space;
    uint8_t opcode = 0;
    LabelKind label_kind = LabelKind::automatic;
    uint32_t size = 0;
    Location location{};
    Operand operand{};
    std::vector<uint8_t> bytes{};
    std::string text{};

    bool operator==(const Item&) const = default;
};

[[nodiscard]] Item instruction(uint8_t opcode, Operand operand = {}, Location location = {});
/// @param size  bytes of what it names; 0: up to the next label that is not local, or the end
[[nodiscard]] Item label(std::string name, LabelKind kind = LabelKind::automatic, uint32_t size = 0,
                         Location location = {});
[[nodiscard]] Item data_bytes(std::vector<uint8_t> bytes, Location location = {});
[[nodiscard]] Item data_byte(Operand operand, Location location = {});
[[nodiscard]] Item data_word(Operand operand, Location location = {});
[[nodiscard]] Item space(uint32_t size, Location location = {});
[[nodiscard]] Item note(std::string text, Location location = {});

/// Where a section goes, and what start-up does with it.
enum class SectionKind : uint8_t {
    code,         ///< ROM
    constant,     ///< ROM
    initialised,  ///< RAM; start-up copies it from ROM
    zero,         ///< RAM; cleared by start-up
    persistent,   ///< RAM; start-up leaves it alone
    frame,        ///< RAM; a static frame in the overlay region, never initialised
};

struct Section {
    std::string name{};
    SectionKind kind = SectionKind::code;
    std::optional<uint16_t> address{};  ///< fixed; such a section is always kept
    uint32_t alignment = 1;             ///< a power of two
    uint32_t frame_offset = 0;          ///< of a frame: from the start of the overlay region
    std::string function{};             ///< the function that code or frame belongs to
    std::string title{};                ///< for people: the demangled name, or empty
    Location location{};                ///< where the source defines it
    std::vector<Item> items{};

    bool operator==(const Section&) const = default;
};

/// A name for a number, or for a symbol plus a number.
struct Equate {
    std::string name{};
    Operand value{};
    Location location{};

    bool operator==(const Equate&) const = default;
};

/// What one source file or one compilation gives.
struct Module {
    std::string name{};
    std::vector<std::string> files{};
    std::vector<Section> sections{};
    std::vector<Equate> equates{};

    bool operator==(const Module&) const = default;
};

/// A label that begins with . or ? is known in its own section only.
[[nodiscard]] inline bool is_local(std::string_view name) {
    return !name.empty() && (name.front() == '.' || name.front() == '?');
}

[[nodiscard]] inline bool in_rom(SectionKind kind) {
    return kind == SectionKind::code || kind == SectionKind::constant;
}

/// code, constant, initialised, zero, persistent, frame.
[[nodiscard]] std::string_view kind_name(SectionKind kind);

/// Bytes that an item, a section takes.
[[nodiscard]] std::size_t item_size(const Item& item);
[[nodiscard]] std::size_t section_size(const Section& section);

/// The name of an item's operand if it refers to a symbol, else empty. A label refers to none.
[[nodiscard]] std::string_view reference_of(const Item& item);

/// One mistake. What a person reads is "file:line: text".
struct Diagnostic {
    std::string file{};
    uint32_t line = 0;  ///< 0: concerns no line
    std::string text{};

    [[nodiscard]] std::string message() const;
};

/// Everything found wrong by one step, a line each.
class Error : public std::runtime_error {
public:
    explicit Error(std::vector<Diagnostic> diagnostics);
    [[nodiscard]] std::span<const Diagnostic> diagnostics() const { return diagnostics_; }

private:
    std::vector<Diagnostic> diagnostics_;
};

}  // namespace toolchain::assembly
