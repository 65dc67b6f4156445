// names.hpp - the image's symbols as people type and read them at the console.
// Depends on   host_sim/image/symbols.hpp.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host_sim/image/symbols.hpp"

namespace debug_console {

class Names {
public:
    Names() = default;
    explicit Names(host_sim::Symbols symbols) : symbols_(std::move(symbols)) {}

    /// The address of the symbol of this name, or of the only one that is this name with a
    /// parameter list: "drive" finds "drive(int)".
    [[nodiscard]] std::optional<uint16_t> find(std::string_view name) const;
    /// The names at exactly this address.
    [[nodiscard]] std::vector<std::string> at(uint16_t address) const;
    /// "main" or "main+3" (decimal) for the symbol that covers an address, else empty.
    [[nodiscard]] std::string near(uint16_t address) const { return symbols_.describe(address); }
    /// The address and, when there is one, the symbol: "0103H main+3".
    [[nodiscard]] std::string address_text(uint16_t address) const;
    /// Where the source of an address is, as "drive.cpp:31"; empty when unknown.
    [[nodiscard]] std::string source_text(uint16_t address) const;
    /// Symbols whose name contains `part`, in any case of letters, in the order of addresses.
    [[nodiscard]] std::vector<host_sim::Symbol> containing(std::string_view part) const;

    [[nodiscard]] const host_sim::Symbols& symbols() const { return symbols_; }

private:
    host_sim::Symbols symbols_;
};

}  // namespace debug_console
