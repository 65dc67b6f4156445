// image_map.cpp - see image_map.hpp.
#include "tools/budget/image_map.hpp"

#include <charconv>
#include <sstream>

#include "tools/budget/budget_error.hpp"

namespace rover_budget {
namespace {

constexpr std::string_view kFirstLine = "# rover85 map 1";

/// The words of one line, with what to say when one is not as it should be.
class Words {
public:
    Words(const std::string& line, std::string_view file, std::size_t number)
        : stream_(line), file_(file), number_(number) {
        stream_ >> kind_;
    }
    [[nodiscard]] const std::string& kind() const { return kind_; }
    std::string word() {
        std::string text;
        if (!(stream_ >> text)) fail();
        return text;
    }
    uint32_t number(int base) {
        const std::string text = word();
        uint32_t value = 0;
        const char* const end = text.data() + text.size();
        const auto [at, error] = std::from_chars(text.data(), end, value, base);
        if (error != std::errc() || at != end) fail();
        return value;
    }
    std::optional<uint32_t> number_or_dash() {
        const std::string text = word();
        if (text == "-") return {};
        uint32_t value = 0;
        const char* const end = text.data() + text.size();
        const auto [at, error] = std::from_chars(text.data(), end, value, 10);
        if (error != std::errc() || at != end) fail();
        return value;
    }
    void expect(std::string_view text) {
        if (word() != text) fail();
    }
    std::string rest() {
        std::string text;
        std::getline(stream_ >> std::ws, text);
        if (text.empty()) fail();
        return text;
    }

private:
    [[noreturn]] void fail() const {
        throw BudgetError(file_, number_, "is not of the form of a map file",
                          "take the map that i85cc wrote beside the image (docs/spec/map.md)");
    }
    std::istringstream stream_;
    std::string_view file_;
    std::size_t number_;
    std::string kind_;
};

void read_range(Words& words, ImageMap& map) {
    const std::string name = words.word();
    (void)words.number(16);
    (void)words.number(16);
    words.expect("used");
    (name == "ROM" ? map.rom_used : map.ram_used) = words.number(10);
}

void read_section(Words& words, ImageMap& map) {
    MapSection section;
    section.first = words.number(16);
    section.size = words.number(16);
    section.kind = words.word();
    (void)words.number(16);
    section.name = words.rest();
    map.sections.push_back(std::move(section));
}

void read_function(Words& words, ImageMap& map) {
    MapFunction function;
    function.address = words.number(16);
    words.expect("rom");
    (void)words.number(10);
    words.expect("ram");
    (void)words.number(10);
    words.expect("t");
    (void)words.number_or_dash();
    (void)words.number_or_dash();
    words.expect("stack");
    function.stack_bytes = words.number_or_dash();
    function.name = words.rest();
    map.functions.push_back(std::move(function));
}

}  // namespace

const MapRegion& ImageMap::region(std::string_view name) const {
    const auto found = regions.find(name);
    if (found == regions.end()) {
        throw BudgetError("map", 0, "has no region " + std::string(name), "build the image anew");
    }
    return found->second;
}

ImageMap parse_map(std::string_view text, std::string_view file) {
    ImageMap map;
    std::istringstream lines{std::string(text)};
    std::string line;
    if (!std::getline(lines, line) || line != kFirstLine) {
        throw BudgetError(file, 1, "is no map file", "the first line is `# rover85 map 1`");
    }
    for (std::size_t number = 2; std::getline(lines, line); ++number) {
        Words words(line, file, number);
        if (words.kind() == "range") read_range(words, map);
        if (words.kind() == "section") read_section(words, map);
        if (words.kind() == "function") read_function(words, map);
        if (words.kind() == "note") {
            const uint32_t address = words.number(16);
            map.notes.push_back({address, words.rest()});
        }
        if (words.kind() == "region") {
            const std::string name = words.word();
            const uint32_t first = words.number(16);
            map.regions[name] = {first, words.number(16)};
        }
    }
    return map;
}

}  // namespace rover_budget
