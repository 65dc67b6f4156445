// lcov.cpp - coverage as .info files for genhtml.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>

#include "host_sim/trace/coverage.hpp"

namespace host_sim {
namespace {

/// One source file of an .info.
struct SourceCoverage {
    std::map<uint32_t, uint64_t> lines;  ///< executions by line
    struct Function {
        uint32_t line;
        std::string name;
        uint64_t calls;
    };
    std::vector<Function> functions;
};

/// In FN and FNDA a comma separates: it is replaced where a name holds one.
std::string function_name(std::string name) {
    std::ranges::replace(name, ',', ';');
    return name;
}

void append_file(std::string& out, std::string_view file, const SourceCoverage& source) {
    const auto put = std::back_inserter(out);
    fmt::format_to(put, "TN:\nSF:{}\n", file);
    for (const auto& function : source.functions) {
        fmt::format_to(put, "FN:{},{}\n", function.line, function_name(function.name));
    }
    for (const auto& function : source.functions) {
        fmt::format_to(put, "FNDA:{},{}\n", function.calls, function_name(function.name));
    }
    fmt::format_to(put, "FNF:{}\nFNH:{}\n", source.functions.size(),
                   std::ranges::count_if(source.functions,
                                         [](const auto& function) { return function.calls != 0; }));
    for (const auto& [line, count] : source.lines) fmt::format_to(put, "DA:{},{}\n", line, count);
    fmt::format_to(
        put, "LF:{}\nLH:{}\nend_of_record\n", source.lines.size(),
        std::ranges::count_if(source.lines, [](const auto& line) { return line.second != 0; }));
}

}  // namespace

std::string lcov_of_listing(const Listing& listing, std::string_view listing_file,
                            const Symbols* symbols, const Coverage& coverage) {
    SourceCoverage source;
    uint32_t number = 0;
    for (const Listing::Line& line : listing.lines) {
        ++number;
        if (!line.code) continue;
        source.lines[number] = coverage.executed(line.address);
        const Symbol* symbol = symbols == nullptr ? nullptr : symbols->function_at(line.address);
        if (symbol != nullptr && symbol->address == line.address) {
            source.functions.push_back({number, symbol->name, coverage.executed(line.address)});
        }
    }
    std::string out;
    append_file(out, listing_file, source);
    return out;
}

std::string lcov_of_sources(const Symbols& symbols, const Coverage& coverage) {
    std::map<std::string, SourceCoverage> sources;
    for (const Symbol& symbol : symbols.all()) {
        if (symbol.source_line == 0 || symbol.kind == SymbolKind::data) continue;
        SourceCoverage& source = sources[symbol.source];
        source.lines[symbol.source_line];  // executed or not
        if (symbol.is_function()) {
            source.functions.push_back(
                {symbol.source_line, symbol.name, coverage.executed(symbol.address)});
        }
    }
    for (std::size_t address = 0; address < kAddressSpaceSize; ++address) {
        const auto at = static_cast<uint16_t>(address);
        const Symbol* symbol = symbols.source_at(at);
        if (symbol == nullptr || symbol->kind == SymbolKind::data) continue;
        uint64_t& count = sources[symbol->source].lines[symbol->source_line];
        count = std::max(count, coverage.executed(at));
    }
    std::string out;
    for (const auto& [file, source] : sources) append_file(out, file, source);
    return out;
}

}  // namespace host_sim
