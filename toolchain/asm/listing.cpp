// listing.cpp - see listing.hpp.
#include "toolchain/asm/listing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "toolchain/asm/encode.hpp"
#include "toolchain/asm/print.hpp"
#include "toolchain/isa/instruction_set.hpp"

namespace toolchain::assembly {
namespace {

constexpr std::size_t kBytesALine = 4;
constexpr std::size_t kTextColumn = 27;

std::string hex_bytes(std::span<const uint8_t> bytes) {
    std::string text;
    for (const uint8_t byte : bytes) text += fmt::format("{}{:02X}", text.empty() ? "" : " ", byte);
    return text;
}

std::string t_states(const Item& item) {
    if (item.kind != ItemKind::instruction) return {};
    const isa::Instruction& entry = isa::instruction(item.opcode);
    if (!entry.conditional()) return std::to_string(entry.t_taken);
    return fmt::format("{}/{}", entry.t_not_taken, entry.t_taken);
}

class Lister {
public:
    Lister(const Program& program, const SourceText& source)
        : program_(program), source_(source), values_(program) {}

    std::string run() {
        out_ = "; T: T-states; of a conditional instruction not taken/taken\n";
        out_ += "; addr bytes          T  instruction\n";
        for (std::size_t i = 0; i < program_.sections.size(); ++i) section(i);
        return std::move(out_);
    }

private:
    void section(std::size_t index) {
        const PlacedSection& placed = program_.sections[index];
        out_ += fmt::format("\n; {} {}, {:04X}H, {} bytes", kind_name(placed.section.kind),
                            placed.section.name, placed.address, placed.size);
        if (placed.load_address != placed.address) {
            out_ += fmt::format(", in ROM at {:04X}H", placed.load_address);
        }
        if (!placed.section.title.empty()) out_ += "; " + placed.section.title;
        out_ += '\n';
        last_ = {};
        uint32_t address = placed.address;
        for (const Item& item : placed.section.items) {
            source_line(item.location);
            line(item, index, address);
            address += static_cast<uint32_t>(item_size(item));
        }
    }

    void source_line(Location location) {
        if (!location.known() || location == last_) return;
        last_ = location;
        if (location.file >= program_.files.size()) return;
        const std::string& file = program_.files[location.file];
        std::string text = source_ ? source_(file, location.line) : std::string();
        text.erase(0, std::min(text.find_first_not_of(" \t"), text.size()));
        out_ += fmt::format("{:{}}; {}:{}{}{}\n", "", kTextColumn, file, location.line,
                            text.empty() ? "" : "  ", text);
    }

    void line(const Item& item, std::size_t index, uint32_t address) {
        if (item.kind == ItemKind::label) {
            out_ += fmt::format("{:04X}{:{}}{}:\n", address, "", kTextColumn - 4,
                                symbol_text(item.operand.symbol));
            return;
        }
        if (item.kind == ItemKind::note) {
            out_ += fmt::format("{:{}};@{}\n", "", kTextColumn, item.text);
            return;
        }
        if (item.kind == ItemKind::space) {
            row(address, "", "", item_text(item));
            return;
        }
        const auto bytes = encode(item, index, values_);
        if (item.kind != ItemKind::bytes) {
            row(address, hex_bytes(bytes), t_states(item), item_text(item));
            return;
        }
        for (std::size_t at = 0; at < bytes.size(); at += kBytesALine) {
            const auto end = std::min(bytes.size(), at + kBytesALine);
            const std::vector<uint8_t> part(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                                            bytes.begin() + static_cast<std::ptrdiff_t>(end));
            row(address + static_cast<uint32_t>(at), hex_bytes(part), "",
                item_text(data_bytes(part)));
        }
    }

    void row(uint32_t address, const std::string& bytes, const std::string& t,
             const std::string& text) {
        out_ += fmt::format("{:04X}  {:<11} {:>5}      {}\n", address, bytes, t, text);
    }

    const Program& program_;
    const SourceText& source_;
    SymbolValues values_;
    std::string out_;
    Location last_{};  ///< source line shown last
};

std::vector<std::string> read_lines(const std::string& file) {
    std::vector<std::string> lines;
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);) {
        if (line.ends_with('\r')) line.pop_back();
        lines.push_back(line);
    }
    return lines;
}

}  // namespace

SourceText source_files() {
    auto files = std::make_shared<std::map<std::string, std::vector<std::string>>>();
    return [files](const std::string& file, uint32_t line) -> std::string {
        auto found = files->find(file);
        if (found == files->end()) found = files->emplace(file, read_lines(file)).first;
        return line == 0 || line > found->second.size() ? "" : found->second[line - 1];
    };
}

std::string listing(const Program& program, const SourceText& source) {
    return Lister(program, source).run();
}

}  // namespace toolchain::assembly
