// coder_fixture.hpp - a function whose parameters come in registers, and a Coder at its start: what
// tests of recipes, moves and edges begin with.
// Depends on   toolchain/codegen/builder.hpp, coder.hpp, toolchain/isa.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "toolchain/codegen/builder.hpp"
#include "toolchain/codegen/recipes.hpp"
#include "toolchain/isa/instruction_set.hpp"

namespace codegen_test {

/// Intel mnemonics without operands' values, "; " between them; a label is "L:".
inline std::string text_of(const std::vector<toolchain::codegen::CodeItem>& items) {
    using toolchain::codegen::CodeItem;
    std::string text;
    for (const CodeItem& item : items) {
        if (!text.empty()) text += "; ";
        text += item.kind == CodeItem::Kind::instruction
                    ? std::string(toolchain::isa::instruction(item.opcode).text())
                    : "L:";
    }
    return text;
}

class CoderFixture : public testing::Test {
protected:
    toolchain::codegen::Module module;
    toolchain::codegen::Function function;
    toolchain::codegen::Builder builder{function};
    toolchain::codegen::FunctionFacts facts;
    toolchain::codegen::Wishes wishes;
    uint32_t next_label = 100;

    CoderFixture() {
        function.symbol = module.intern("f");
        function.blocks.emplace_back();
    }

    /// A parameter in these registers, the lowest byte's first.
    toolchain::codegen::Bytes in(const std::vector<toolchain::codegen::Register>& registers) {
        toolchain::codegen::Bytes value = builder.parameter(registers.size());
        function.parameters.push_back(value);
        toolchain::codegen::Block& entry = function.blocks[0];
        entry.parameters.insert(entry.parameters.end(), value.begin(), value.end());
        entry.parameter_sizes.push_back(static_cast<uint32_t>(value.size()));
        function.parameter_registers.insert(function.parameter_registers.end(), registers.begin(),
                                            registers.end());
        return value;
    }

    /// Ends the function with values that are needed up to there.
    void give_back(const toolchain::codegen::Bytes& value) {
        toolchain::codegen::Terminator end;
        end.kind = toolchain::codegen::Terminator::Kind::give_back;
        end.left = value;
        function.result_size = static_cast<uint32_t>(value.size());
        builder.terminate(end);
        facts = toolchain::codegen::find_facts(function);
    }

    /// At the start of the first block, parameters in their registers.
    toolchain::codegen::Coder coder(double byte_cost = 0) {
        using namespace toolchain::codegen;
        const BlockFacts& block = facts.blocks[0];
        wishes.slot.assign(block.relevant.size(), 0);
        wishes.registers.assign(block.relevant.size(), 0);
        Coder result(facts, block, wishes, byte_cost);
        result.state.in_slot = Bits(block.relevant.size());
        const Bytes& parameters = facts.function.blocks[0].parameters;
        for (std::size_t i = 0; i < parameters.size(); ++i) {
            result.set(function.parameter_registers[i], parameters[i]);
        }
        return result;
    }

    const toolchain::codegen::Operation& operation(std::size_t index = 0) const {
        return facts.function.blocks[0].operations.at(index);
    }

    toolchain::codegen::RecipeContext context() {
        toolchain::codegen::RecipeContext result;
        result.next_label = &next_label;
        return result;
    }

    /// The cheapest of all ways for the first operation.
    toolchain::codegen::Coder best_way(double byte_cost = 0) {
        using namespace toolchain::codegen;
        Coder best = coder();
        bool found = false;
        for (Coder& way : translate(coder(byte_cost), operation(), context())) {
            if (!way.complete() || (found && way.cost >= best.cost)) continue;
            best = std::move(way);
            found = true;
        }
        EXPECT_TRUE(found);
        return best;
    }
};

}  // namespace codegen_test
