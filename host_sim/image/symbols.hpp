// symbols.hpp - names of addresses: which function, which data, which source line.
// Normative    docs/spec/symbols.md.      Depends on   host_sim/image/image.hpp.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "host_sim/image/image.hpp"

namespace host_sim {

enum class SymbolKind : uint8_t { function, interrupt_entry, data, label };

/// One line of a symbol file.
struct Symbol {
    uint16_t address = 0;
    uint32_t size = 0;  ///< bytes; 0: up to the next symbol
    SymbolKind kind = SymbolKind::label;
    std::string name{};         ///< "-": no name, only a source line
    std::string source{};       ///< source file, or empty
    uint32_t source_line = 0;   ///< from 1; 0: none
    std::size_t file_line = 0;  ///< of the symbol file

    [[nodiscard]] bool is_function() const {
        return kind == SymbolKind::function || kind == SymbolKind::interrupt_entry;
    }
};

/// All symbols of a program, for questions by address and by name.
class Symbols {
public:
    Symbols() : Symbols({}, {}) {}

    /// @param file  name for messages
    /// @errors  ImageError: a range beyond FFFFH, two functions or data that overlap, a name twice
    Symbols(std::vector<Symbol> symbols, std::string_view file);

    /// In ascending order of addresses.
    [[nodiscard]] const std::vector<Symbol>& all() const { return symbols_; }

    /// The symbol of that name, or nullptr.
    [[nodiscard]] const Symbol* find(std::string_view name) const;

    /// The function or data that covers an address, else the label, else nullptr.
    [[nodiscard]] const Symbol* at(uint16_t address) const { return get(owner_[address]); }

    /// The function or interrupt entry that covers an address, or nullptr.
    [[nodiscard]] const Symbol* function_at(uint16_t address) const;

    /// The symbol with a source line that covers an address most closely, or nullptr.
    [[nodiscard]] const Symbol* source_at(uint16_t address) const { return get(line_[address]); }

    /// "name", "name+5" (decimal), or empty where no symbol is.
    [[nodiscard]] std::string describe(uint16_t address) const;

private:
    [[nodiscard]] const Symbol* get(int index) const {
        return index < 0 ? nullptr : &symbols_[static_cast<std::size_t>(index)];
    }
    [[nodiscard]] std::size_t end_of(std::size_t index) const;
    void occupy(std::string_view file);

    std::vector<Symbol> symbols_;
    std::map<std::string, std::size_t, std::less<>> by_name_;
    std::vector<int32_t> owner_;  ///< by address; -1: none
    std::vector<int32_t> line_;
};

/// Reads a symbol file. @errors ImageError with file and line
[[nodiscard]] Symbols read_symbols(std::string_view text, std::string_view file);
[[nodiscard]] Symbols load_symbols(const std::filesystem::path& path);

}  // namespace host_sim
