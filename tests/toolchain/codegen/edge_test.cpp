// Edges: registers and slots exchanged, in circles too; executed here to see that all goals hold.
#include "toolchain/codegen/edge.hpp"

#include <gtest/gtest.h>

#include <array>
#include <map>

#include "tests/toolchain/codegen/coder_fixture.hpp"

namespace {

using namespace toolchain::codegen;
using namespace codegen_test;
using enum Register;

/// Just enough of the processor for what edges consist of. Words in slots lie in `memory`, by
/// variable and offset; every value is the number of its byte.
class Moves {
public:
    std::array<uint32_t, 8> registers{};
    std::map<std::pair<uint32_t, int32_t>, uint32_t> memory;

    void run(const std::vector<CodeItem>& items) {
        for (const CodeItem& item : items) step(item);
        EXPECT_TRUE(stack_.empty());
    }

private:
    uint32_t& at(Register which) { return registers[static_cast<unsigned>(which)]; }
    uint32_t& cell(const CodeOperand& operand, int32_t more = 0) {
        return memory[{operand.id, operand.offset + more}];
    }
    void push(uint32_t low, uint32_t high) {
        stack_.push_back(high);
        stack_.push_back(low);
    }
    uint32_t pop() {
        const uint32_t top = stack_.back();
        stack_.pop_back();
        return top;
    }

    void step(const CodeItem& item) {
        const uint8_t code = item.opcode;
        const CodeOperand& operand = item.operand;
        if (code >= 0x40 && code < 0x80 && (code & 7) != 6 && (code >> 3 & 7) != 6) {
            registers[code >> 3 & 7U] = registers[code & 7U];
        } else if (code == op::kXchg) {
            std::swap(at(h), at(d));
            std::swap(at(l), at(e));
        } else if (code == op::kLda) {
            at(a) = cell(operand);
        } else if (code == op::kSta) {
            cell(operand) = at(a);
        } else if (code == op::kLhld) {
            at(l) = cell(operand);
            at(h) = cell(operand, 1);
        } else if (code == op::kShld) {
            cell(operand) = at(l);
            cell(operand, 1) = at(h);
        } else if (code == op::kPushPsw) {
            push(0, at(a));
        } else if (code == op::kPopPsw) {
            (void)pop();
            at(a) = pop();
        } else if ((code & 0xCF) == op::kPush) {
            push(registers[(code >> 4 & 3U) * 2 + 1], registers[(code >> 4 & 3U) * 2]);
        } else if ((code & 0xCF) == op::kPop) {
            registers[(code >> 4 & 3U) * 2 + 1] = pop();
            registers[(code >> 4 & 3U) * 2] = pop();
        } else {
            ADD_FAILURE() << toolchain::isa::instruction(code).text();
        }
    }

    std::vector<uint32_t> stack_;
};

class EdgeTest : public CoderFixture {
protected:
    Bytes parameters;

    /// Block 0 hands these to block 1, which returns all of its parameters.
    void hand_over(const Bytes& arguments, const std::vector<uint32_t>& sizes) {
        function.blocks.emplace_back();
        for (const uint32_t size : sizes) {
            const Bytes one = builder.parameter(size);
            parameters.insert(parameters.end(), one.begin(), one.end());
        }
        function.blocks[1].parameters = parameters;
        function.blocks[1].parameter_sizes = sizes;
        Terminator jump;
        jump.kind = Terminator::Kind::jump;
        jump.edges = {{1, arguments}};
        builder.terminate(jump);
        builder.set_block(1);
        give_back(parameters);
    }

    /// Crosses and checks every goal. @return the code
    std::string cross_over(const Contract& target, double* cost = nullptr) {
        Coder way = coder();
        const Edge& edge = facts.function.blocks[0].terminator.edges[0];
        Moves machine;
        for (const Register which : kRegisters) {
            machine.registers[static_cast<unsigned>(which)] = way.content(which);
        }
        way.position = facts.blocks[0].end;
        cross(way, edge, target);
        EXPECT_FALSE(way.failed);
        machine.run(way.items);
        for (std::size_t i = 0; i < parameters.size(); ++i) {
            const ByteId wanted = edge.arguments[i];
            for (const Register which : kRegisters) {
                if (target.registers[static_cast<unsigned>(which)] == parameters[i]) {
                    EXPECT_EQ(machine.registers[static_cast<unsigned>(which)], wanted)
                        << text_of(way.items);
                }
            }
            if (target.in_slot(parameters[i])) {
                const std::pair place{facts.variable[parameters[i]],
                                      static_cast<int32_t>(facts.index[parameters[i]])};
                EXPECT_EQ(machine.memory[place], wanted) << text_of(way.items);
            }
        }
        if (cost != nullptr) *cost = way.cost;
        return text_of(way.items);
    }

    Contract in_registers(const std::vector<Register>& registers) {
        Contract contract;
        for (std::size_t i = 0; i < registers.size(); ++i) {
            contract.registers[static_cast<unsigned>(registers[i])] = parameters[i];
            contract.not_in_slot.push_back(parameters[i]);
        }
        return contract;
    }
};

TEST_F(EdgeTest, NothingToDoIsNothing) {
    const Bytes x = in({l, h});
    hand_over(x, {2});
    EXPECT_EQ(cross_over(in_registers({l, h})), "");
}

TEST_F(EdgeTest, ASwapOfWordsIsXchg) {
    const Bytes x = in({l, h});
    const Bytes y = in({e, d});
    hand_over({y[0], y[1], x[0], x[1]}, {2, 2});
    EXPECT_EQ(cross_over(in_registers({l, h, e, d})), "XCHG");
}

TEST_F(EdgeTest, ARotationOfThreeBytesTakesFourMoves) {
    const Bytes x = in({b});
    const Bytes y = in({c});
    const Bytes z = in({d});
    hand_over({y[0], z[0], x[0]}, {1, 1, 1});
    double cost = 0;
    (void)cross_over(in_registers({b, c, d}), &cost);
    EXPECT_EQ(cost, 4 * 4);
}

TEST_F(EdgeTest, ARotationOfAllSevenRegistersGoesOverTheStack) {
    const std::vector<Register> all(kRegisters.begin(), kRegisters.end());
    Bytes values;
    for (const Register which : all) values.push_back(in({which})[0]);
    Bytes turned(values.begin() + 1, values.end());
    turned.push_back(values[0]);
    hand_over(turned, std::vector<uint32_t>(7, 1));
    const std::string text = cross_over(in_registers(all));
    EXPECT_NE(text.find("PUSH PSW"), std::string::npos) << text;
}

TEST_F(EdgeTest, AWordGoesToItsSlotByShld) {
    const Bytes x = in({l, h});
    hand_over(x, {2});
    EXPECT_EQ(cross_over(Contract{}), "SHLD a16");
}

TEST_F(EdgeTest, RegistersAndSlotsAtOnce) {
    const Bytes x = in({l, h});
    const Bytes y = in({e, d});
    const Bytes z = in({c, b});
    hand_over({z[0], z[1], x[0], x[1], y[0], y[1]}, {2, 2, 2});
    Contract target = in_registers({l, h});  // z; x and y in their slots
    (void)cross_over(target);
    target.not_in_slot.clear();  // z in both
    (void)cross_over(target);
}

TEST_F(EdgeTest, TheSameValueForTwoParameters) {
    const Bytes x = in({a});
    hand_over({x[0], x[0]}, {1, 1});
    EXPECT_EQ(cross_over(in_registers({a, c})), "MOV C,A");
}

}  // namespace
