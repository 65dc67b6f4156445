// symbols_read.cpp - symbol files, see docs/spec/symbols.md.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "host_sim/image/symbols.hpp"

namespace host_sim {
namespace {

constexpr std::string_view kForm = "write ADDR SIZE KIND NAME [@ SOURCE:LINE]";

/// One line of a symbol file.
class LineReader {
public:
    LineReader(std::string_view rest, std::string_view file, std::size_t line)
        : rest_(rest), file_(file), line_(line) {}

    Symbol read() {
        Symbol symbol;
        symbol.file_line = line_;
        symbol.address = static_cast<uint16_t>(hex_word("address"));
        symbol.size = hex_word("size");
        symbol.kind = kind();
        source(symbol);
        symbol.name = rest_;
        if (symbol.name.empty()) fail("has no name");
        if (symbol.name == "-" && symbol.kind != SymbolKind::label) fail("only an L goes unnamed");
        return symbol;
    }

private:
    [[noreturn]] void fail(const std::string& what) const {
        throw ImageError(file_, line_, what, kForm);
    }

    std::string_view field() {
        const std::size_t end = std::min(rest_.find(' '), rest_.size());
        const std::string_view text = rest_.substr(0, end);
        rest_.remove_prefix(end);
        rest_.remove_prefix(std::min(rest_.find_first_not_of(' '), rest_.size()));
        return text;
    }

    uint32_t hex_word(std::string_view what) {
        const std::string_view text = field();
        uint32_t value = 0;
        const auto [end, error] =
            std::from_chars(text.data(), text.data() + text.size(), value, 16);
        if (text.size() != 4 || error != std::errc() || end != text.data() + text.size()) {
            fail(fmt::format("{} '{}' is not four hexadecimal digits", what, text));
        }
        return value;
    }

    SymbolKind kind() {
        const std::string_view text = field();
        if (text == "F") return SymbolKind::function;
        if (text == "I") return SymbolKind::interrupt_entry;
        if (text == "D") return SymbolKind::data;
        if (text == "L") return SymbolKind::label;
        fail(fmt::format("kind '{}' is not F, I, D or L", text));
    }

    /// Takes "@ SOURCE:LINE" off the end.
    void source(Symbol& symbol) {
        const std::size_t at = rest_.rfind(" @ ");
        if (at == std::string_view::npos) return;
        const std::string_view place = rest_.substr(at + 3);
        const std::size_t colon = place.rfind(':');
        const std::string_view number =
            colon == std::string_view::npos ? std::string_view() : place.substr(colon + 1);
        const auto [end, error] =
            std::from_chars(number.data(), number.data() + number.size(), symbol.source_line);
        if (number.empty() || colon == 0 || error != std::errc() ||
            end != number.data() + number.size() || symbol.source_line == 0) {
            fail(fmt::format("'{}' is not SOURCE:LINE", place));
        }
        symbol.source = place.substr(0, colon);
        rest_ = rest_.substr(0, at);
        rest_ = rest_.substr(0, rest_.find_last_not_of(' ') + 1);
    }

    std::string_view rest_;
    std::string_view file_;
    std::size_t line_;
};

}  // namespace

Symbols read_symbols(std::string_view text, std::string_view file) {
    std::vector<Symbol> symbols;
    for (std::size_t number = 1; !text.empty(); ++number) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        std::string_view line = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        if (line.ends_with('\r')) line.remove_suffix(1);
        for (const char character : line) {
            const auto code = static_cast<unsigned char>(character);
            if (code < 0x20 || code == 0x7F) {
                throw ImageError(file, number, "holds a control character", kForm);
            }
        }
        line = line.substr(0, line.find_last_not_of(' ') + 1);
        line.remove_prefix(std::min(line.find_first_not_of(' '), line.size()));
        if (line.empty() || line.front() == '#') continue;
        symbols.push_back(LineReader(line, file, number).read());
    }
    return {std::move(symbols), file};
}

Symbols load_symbols(const std::filesystem::path& path) {
    return read_symbols(read_image_file(path), path.string());
}

}  // namespace host_sim
