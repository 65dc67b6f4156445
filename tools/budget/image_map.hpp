// image_map.hpp - what the map file of an image says about its bytes.
// Depends on   the standard library.     Format  docs/spec/map.md
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace rover_budget {

struct MapSection {
    uint32_t first = 0, size = 0;
    std::string kind, name;

    [[nodiscard]] bool in_rom() const { return kind == "code" || kind == "constant"; }
    [[nodiscard]] bool is_frame() const { return kind == "frame"; }
};

struct MapFunction {
    uint32_t address = 0;
    std::optional<uint32_t> stack_bytes;
    std::string name;
};

/// What the compiler or a source says about an address: "loop 6", "t 72 to 7579".
struct MapNote {
    uint32_t address = 0;
    std::string text;
};

struct MapRegion {
    uint32_t first = 0, size = 0;
};

struct ImageMap {
    uint32_t rom_used = 0, ram_used = 0;
    std::map<std::string, MapRegion, std::less<>> regions;
    std::vector<MapSection> sections;
    std::vector<MapFunction> functions;
    std::vector<MapNote> notes;

    /// @errors BudgetError when the map has no such region
    [[nodiscard]] const MapRegion& region(std::string_view name) const;
};

/// Reads a map file. Lines of unknown kinds are passed over, as the format demands.
/// @errors BudgetError with file and line
[[nodiscard]] ImageMap parse_map(std::string_view text, std::string_view file);

}  // namespace rover_budget
