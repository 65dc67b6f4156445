// opcode_lookup.cpp - see opcode_lookup.hpp.
#include "toolchain/asm/opcode_lookup.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <unordered_map>
#include <vector>

#include "toolchain/asm/source_lines.hpp"

namespace toolchain::assembly {
namespace {

struct Candidate {
    const isa::Instruction* entry;
    std::vector<std::string_view> operands;  ///< as in the table, split at the comma
};

std::vector<std::string_view> table_operands(const isa::Instruction& entry) {
    std::vector<std::string_view> operands;
    std::string_view rest = entry.operands();
    while (!rest.empty()) {
        const std::size_t comma = std::min(rest.find(','), rest.size());
        operands.push_back(rest.substr(0, comma));
        rest.remove_prefix(std::min(comma + 1, rest.size()));
    }
    return operands;
}

using Candidates = std::unordered_map<std::string_view, std::vector<Candidate>>;

const Candidates& candidates() {
    static const Candidates kByMnemonic = [] {
        Candidates result;
        for (const isa::Instruction& entry : isa::instruction_set()) {
            const Candidate candidate{&entry, table_operands(entry)};
            result[entry.mnemonic()].push_back(candidate);
            if (!entry.alternate_mnemonic.empty()) {
                result[entry.alternate_mnemonic].push_back(candidate);
            }
        }
        return result;
    }();
    return kByMnemonic;
}

bool is_number(std::string_view text) {
    return text[0] >= '0' && text[0] <= '9';
}

/// An expression, and not the name of a register.
bool is_value(std::string_view text) {
    const std::size_t other = text.find_first_not_of(
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_?@.");
    return other != std::string_view::npos || is_number(text) || is_symbol(text);
}

bool matches(const Candidate& candidate, std::span<const std::string> given,
             const std::function<int(std::string_view)>& number) {
    const auto& wanted = candidate.operands;
    if (wanted.size() != given.size()) return false;
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        const bool placeholder =
            candidate.entry->operand != isa::Operand::none && i + 1 == wanted.size();
        if (placeholder) {
            if (!is_value(given[i])) return false;
        } else if (is_number(wanted[i])) {  // RST n
            if (number(given[i]) != wanted[i][0] - '0') return false;
        } else if (upper_case(given[i]) != wanted[i]) {
            return false;
        }
    }
    return true;
}

}  // namespace

const isa::Instruction* find_instruction(std::string_view mnemonic,
                                         std::span<const std::string> operands,
                                         const std::function<int(std::string_view)>& number) {
    const auto found = candidates().find(mnemonic);
    if (found == candidates().end()) return nullptr;
    for (const Candidate& candidate : found->second) {
        if (matches(candidate, operands, number)) return candidate.entry;
    }
    throw Mistake(fmt::format("{} does not take '{}'", mnemonic, fmt::join(operands, ",")));
}

}  // namespace toolchain::assembly
