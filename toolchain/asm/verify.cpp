// verify.cpp - see verify.hpp.
#include "toolchain/asm/verify.hpp"

#include <fmt/format.h>

#include <bitset>
#include <utility>

#include "toolchain/asm/print.hpp"
#include "toolchain/isa/instruction_set.hpp"

namespace toolchain::assembly {
namespace {

bool transfers(const isa::Instruction& entry) {
    return entry.flow == isa::Flow::jump || entry.flow == isa::Flow::call;
}

class Verifier {
public:
    Verifier(const Program& program, const VerifyOptions& options)
        : program_(program), options_(options) {}

    std::vector<Diagnostic> run() {
        find_instructions();
        for (const PlacedSection& placed : program_.sections) section(placed);
        regions();
        return std::move(findings_);
    }

private:
    void find_instructions() {
        for (const PlacedSection& placed : program_.sections) {
            std::size_t address = placed.address;
            for (const Item& item : placed.section.items) {
                if (item.kind == ItemKind::instruction) is_instruction_.set(address);
                address += item_size(item);
            }
        }
    }

    void report(const PlacedSection& placed, const Item& item, std::string text) {
        const Location location = item.location;
        if (location.known() && location.file < program_.files.size()) {
            findings_.push_back({program_.files[location.file], location.line, std::move(text)});
        } else {
            findings_.push_back({placed.section.name, 0, std::move(text)});
        }
    }

    void section(const PlacedSection& placed) {
        const Section& section = placed.section;
        const bool stored = in_rom(section.kind) || section.kind == SectionKind::initialised;
        if (stored && !section.address && placed.size != 0 &&
            (placed.load_address < program_.rom.first ||
             placed.load_address + placed.size - 1 > program_.rom.last)) {
            report(placed, {}, fmt::format("section '{}' is not in ROM", section.name));
        }
        std::size_t address = placed.load_address;
        for (const Item& item : section.items) {
            const std::size_t size = item_size(item);
            for (std::size_t at = address; stored && at < address + size; ++at) {
                if (program_.image.present[at]) continue;
                report(placed, item, fmt::format("the image has no byte at {:04X}H", at));
            }
            if (item.kind == ItemKind::instruction) check(placed, item, address);
            address += size;
        }
    }

    void check(const PlacedSection& placed, const Item& item, std::size_t address) {
        const isa::Instruction& entry = isa::instruction(program_.image.bytes[address]);
        const std::string at = fmt::format("{:04X}H: {}", address, item_text(item));
        if (entry.opcode != item.opcode) {
            report(placed, item,
                   fmt::format("{}, but the image has {:02X}H there", at, entry.opcode));
            return;
        }
        if (!entry.documented && !options_.allow_undocumented) {
            report(placed, item, at + " is not documented for the 8085");
        }
        if (!transfers(entry) || item.operand.symbol.empty()) return;
        const unsigned target = program_.image.bytes[address + 1] |
                                static_cast<unsigned>(program_.image.bytes[address + 2]) << 8;
        if (is_instruction_[target]) return;
        report(placed, item,
               fmt::format("{} goes to {:04X}H, where no instruction is", at, target));
    }

    void regions() {
        const std::pair<const char*, Region> all[] = {{"frames", program_.frames},
                                                      {"data", program_.data},
                                                      {"zero", program_.zero},
                                                      {"stack", program_.stack}};
        std::bitset<kMemorySize> used;
        for (const auto& [name, region] : all) {
            bool inside = true;
            bool apart = true;
            for (uint32_t at = region.first; at < region.end(); ++at) {
                inside = inside && at >= program_.ram.first && at <= program_.ram.last;
                if (!inside) break;
                apart = apart && !used[at];
                used.set(at);
            }
            if (!inside) findings_.push_back({name, 0, "this region is not in RAM"});
            if (!apart) findings_.push_back({name, 0, "this region overlaps another one"});
        }
    }

    const Program& program_;
    const VerifyOptions& options_;
    std::bitset<kMemorySize> is_instruction_;
    std::vector<Diagnostic> findings_;
};

}  // namespace

std::vector<Diagnostic> verify(const Program& program, const VerifyOptions& options) {
    return Verifier(program, options).run();
}

}  // namespace toolchain::assembly
