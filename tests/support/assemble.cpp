// assemble.cpp - the two passes: addresses and symbols, then bytes.
#include "tests/support/assemble.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tests/support/assemble_lines.hpp"
#include "toolchain/isa/instruction_set.hpp"

namespace test_support {
namespace {

using toolchain::isa::Instruction;
using toolchain::isa::Operand;

constexpr std::size_t kMemorySize = 0x10000;

/// The operands of a table entry, split at the comma.
std::vector<std::string_view> table_operands(const Instruction& entry) {
    std::vector<std::string_view> operands;
    std::string_view rest = entry.operands();
    while (!rest.empty()) {
        const std::size_t comma = std::min(rest.find(','), rest.size());
        operands.push_back(rest.substr(0, comma));
        rest.remove_prefix(std::min(comma + 1, rest.size()));
    }
    return operands;
}

class Assembler {
public:
    explicit Assembler(std::string_view source) : lines_(split_source(source)) {}

    Assembled run() {
        pass();
        emitting_ = true;
        pass();
        return std::move(result_);
    }

private:
    void pass() {
        address_ = 0;
        started_ = false;
        for (const SourceLine& line : lines_) {
            line_ = &line;
            here_ = static_cast<uint16_t>(address_);
            if (!line.label.empty() && line.operation != "EQU") define(here_);
            if (!line.operation.empty() && !directive()) instruction();
        }
    }

    [[noreturn]] void fail(const std::string& reason) const {
        throw AssembleError(line_->number, reason);
    }

    void define(uint16_t value) {
        if (emitting_) {
            // Sizes do not depend on values, so both passes see the same addresses.
            result_.symbols.at(line_->label) = value;
        } else if (!result_.symbols.emplace(line_->label, value).second) {
            fail("'" + line_->label + "' is defined twice");
        }
    }

    [[nodiscard]] int value(std::string_view expression) const {
        return Evaluator(result_.symbols, line_->number, here_).value(expression);
    }

    /// A value that must be known in the first pass; as an address or size, so not negative.
    [[nodiscard]] uint16_t sole_operand() const {
        if (line_->operands.size() != 1) fail(line_->operation + " takes one operand");
        const int number = value(line_->operands[0]);
        if (number < 0 && line_->operation != "EQU")
            fail(line_->operation + " of a negative number");
        return static_cast<uint16_t>(number);
    }

    bool directive() {
        const std::string& name = line_->operation;
        if (name == "END") return true;
        if (name == "EQU" && !line_->label.empty()) {
            define(sole_operand());
        } else if (name == "ORG") {
            origin(sole_operand());
        } else if (name == "DS") {
            for (unsigned left = sole_operand(); left > 0; --left) put(0);
        } else if (name == "DB" || name == "DW") {
            if (line_->operands.empty()) fail(name + " without operands");
            for (const std::string& operand : line_->operands) data(operand, name == "DB");
        } else {
            return false;
        }
        return true;
    }

    void origin(uint16_t target) {
        if (started_ && target < address_) {
            fail(fmt::format("ORG {:04X}H goes back from {:04X}H", target, address_));
        }
        if (!started_) address_ = target;
        while (address_ < target) put(0);
    }

    void data(const std::string& operand, bool bytes) {
        const auto text = string_operand(operand);
        if (bytes && text) {
            for (const char character : *text) put(static_cast<uint8_t>(character));
        } else if (bytes) {
            put_value8(operand);
        } else {
            put_value16(operand);
        }
    }

    void instruction() {
        bool known = false;
        for (const Instruction& entry : toolchain::isa::instruction_set()) {
            if (entry.mnemonic() != line_->operation &&
                entry.alternate_mnemonic != line_->operation) {
                continue;
            }
            known = true;
            if (matches(entry)) {
                encode(entry);
                return;
            }
        }
        if (!known) fail("'" + line_->operation + "' is neither instruction nor directive");
        fail(fmt::format("{} does not take '{}'", line_->operation,
                         fmt::join(line_->operands, ",")));
    }

    [[nodiscard]] bool matches(const Instruction& entry) const {
        const auto wanted = table_operands(entry);
        const auto& given = line_->operands;
        if (wanted.size() != given.size()) return false;
        for (std::size_t i = 0; i < wanted.size(); ++i) {
            const bool placeholder = entry.operand != Operand::none && i + 1 == wanted.size();
            if (placeholder) {
                if (!is_value(given[i])) return false;
            } else if (is_number(wanted[i])) {  // RST n
                if (value(given[i]) != wanted[i][0] - '0') return false;
            } else if (upper_case(given[i]) != wanted[i]) {
                return false;
            }
        }
        return true;
    }

    static bool is_number(std::string_view text) { return text[0] >= '0' && text[0] <= '9'; }
    /// An expression, and not the name of a register.
    static bool is_value(std::string_view text) {
        const std::size_t letter = text.find_first_not_of(
            "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_?@");
        return letter != std::string_view::npos || is_number(text) || is_symbol(text);
    }

    void encode(const Instruction& entry) {
        put(entry.opcode);
        if (entry.operand == Operand::none) return;
        if (entry.bytes == 2) {
            put_value8(line_->operands.back());
        } else {
            put_value16(line_->operands.back());
        }
    }

    void put_value8(const std::string& operand) {
        const int number = emitting_ ? value(operand) : 0;
        if (number < -128 || number > 255) fail(fmt::format("'{}' is beyond 8 bits", operand));
        put(static_cast<uint8_t>(number));
    }

    void put_value16(const std::string& operand) {
        const int number = emitting_ ? value(operand) : 0;
        put(static_cast<uint8_t>(number));
        put(static_cast<uint8_t>(number >> 8));
    }

    void put(uint8_t byte) {
        if (address_ >= kMemorySize) fail("the program goes beyond 0FFFFH");
        if (emitting_) {
            if (!started_) result_.origin = static_cast<uint16_t>(address_);
            result_.bytes.push_back(byte);
        }
        started_ = true;
        ++address_;
    }

    std::vector<SourceLine> lines_;
    const SourceLine* line_ = nullptr;
    Assembled result_;
    std::size_t address_ = 0;
    uint16_t here_ = 0;      ///< of the line's first byte
    bool started_ = false;   ///< a byte has been placed
    bool emitting_ = false;  ///< second pass
};

}  // namespace

AssembleError::AssembleError(std::size_t line, const std::string& reason)
    : std::runtime_error(fmt::format("line {}: {}", line, reason)), line_(line) {}

Assembled assemble(std::string_view source) {
    return Assembler(source).run();
}

}  // namespace test_support
