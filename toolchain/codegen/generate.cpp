// generate.cpp - puts a function's blocks together: frame, prologue, epilogue, account of the
// stack. Depends on   homes.hpp, peephole.hpp.
#include "toolchain/codegen/generate.hpp"

#include "toolchain/codegen/effects.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "toolchain/codegen/abi.hpp"
#include "toolchain/codegen/cleanup.hpp"
#include "toolchain/codegen/early_loads.hpp"
#include "toolchain/codegen/homes.hpp"
#include "toolchain/codegen/merge_tails.hpp"
#include "toolchain/codegen/peephole.hpp"
#include "toolchain/codegen/short_forms.hpp"
#include "toolchain/codegen/tail_calls.hpp"
#include "toolchain/isa/instruction_set.hpp"

namespace toolchain::codegen {

namespace {

constexpr uint32_t kSpareWord = kNone - 1;  ///< a variable: HL while the stack pointer moves
constexpr uint8_t kTrap = 0x24;

CodeItem make_item(uint8_t opcode, CodeOperand operand = {}) {
    CodeItem item;
    item.opcode = opcode;
    item.operand = operand;
    return item;
}

CodeOperand number(int32_t value) {
    return {CodeOperand::Kind::number, CodeOperand::Part::word, 0, value & 0xFFFF};
}

class Generator {
public:
    Generator(const Module& module, const Function& function, const GenerateOptions& options)
        : module_(module),
          options_(options),
          facts_(find_facts(function,
                            options.undocumented ? options.steps : options.steps.documented())) {}

    FunctionCode run() {
        next_label_ = static_cast<uint32_t>(facts_.function.blocks.size());
        HomesOptions homes;
        homes.search = options_.search && takes(Step::homes);
        homes.budget = options_.search_budget;
        homes.byte_cost = options_.byte_cost;
        homes.by_chance = options_.homes_by_chance;
        homes.recipes.next_label = &next_label_;
        homes.recipes.clobbers_data = this;
        homes.recipes.clobbers_of = [](const void* self, SymbolId symbol) {
            const auto& ask = static_cast<const Generator*>(self)->options_.clobbers_of;
            return ask ? ask(symbol) : kAllRegisters;
        };
        homes.jump_index = symbol_of("__jumpindex");
        lay_out(make_blocks(facts_, homes));
        improve(code_.items);
        clean();
        find_clobbers();
        if (is_clean_ && facts_.function.interrupt < 0 && takes(Step::tail_calls)) {
            jump_to_last_calls(code_.items, symbol_of(kCallThroughHl));
        }
        count_stack();
        frame_stack_variables();
        frame_interrupt();
        if (!is_clean_) allocate_frame();
        return std::move(code_);
    }

private:
    [[nodiscard]] bool takes(Step step) const { return options_.steps.contains(step); }

    [[nodiscard]] uint32_t symbol_of(const char* name) const {
        const auto found = module_.symbol_ids.find(name);
        return found == module_.symbol_ids.end() ? kNone : found->second;
    }

    static CodeItem label(uint32_t id) {
        CodeItem item = make_item(0, {CodeOperand::Kind::label, CodeOperand::Part::word, id, 0});
        item.kind = CodeItem::Kind::label;
        return item;
    }

    void lay_out(FunctionBlocks blocks) {
        std::vector<CodeItem>& items = code_.items;
        for (const BlockId block : blocks.order) {
            items.push_back(label(block));
            const uint32_t bound = facts_.function.blocks[block].loop_bound;
            if (bound != 0) {
                CodeItem note;
                note.kind = CodeItem::Kind::loop_bound;
                note.operand.offset = static_cast<int32_t>(bound);
                items.push_back(note);
            }
            const std::vector<CodeItem>& code = blocks.blocks[block].items;
            items.insert(items.end(), code.begin(), code.end());
            if (facts_.function.blocks[block].terminator.kind == Terminator::Kind::unreachable) {
                const uint32_t again = next_label_++;
                items.push_back(label(again));
                items.push_back(make_item(op::kHlt));
                items.push_back(make_item(
                    op::kJmp, {CodeOperand::Kind::label, CodeOperand::Part::word, again, 0}));
            }
        }
        for (const BlockId block : blocks.order) {
            const std::vector<CodeItem>& cold = blocks.blocks[block].cold;
            items.insert(items.end(), cold.begin(), cold.end());
        }
    }

    // Slots have their places then. A function that is entered again while it is active keeps its
    // variables elsewhere.
    void clean() {
        if (facts_.function.recursive || facts_.function.stack_bytes != 0) return;
        allocate_frame();
        RegisterSet at_return = 0;
        for (const Register which : facts_.function.result_registers) at_return |= set_of(which);
        if (takes(Step::clean_up)) clean_up(code_.items, code_.frame_bytes, at_return);
        improve(code_.items);
        if (options_.byte_cost > 0) {
            if (takes(Step::early_loads)) load_early(code_.items, at_return);
            improve(code_.items);
            if (takes(Step::merged_tails)) merge_tails(code_.items, next_label_);
            improve(code_.items);
        }
        if (takes(Step::short_forms)) take_short_forms(code_.items, at_return);
        is_clean_ = true;
    }

    // -- What it changes -------------------------------------------------------------------------
    static RegisterSet written_by(uint8_t opcode) {
        const isa::Instruction& instruction = isa::instruction(opcode);
        if (!instruction.documented) {
            CodeItem item;
            item.opcode = opcode;
            return static_cast<RegisterSet>(effects_of(item).writes & kAllRegisters);
        }
        RegisterSet set = instruction.flags != 0 ? set_of(Register::flags) : RegisterSet{0};
        const unsigned high = opcode >> 3 & 7U;
        const auto register_bit = [](unsigned which) {
            return which == 6 ? RegisterSet{0} : static_cast<RegisterSet>(1U << which);
        };
        const auto pair_bits = [](unsigned pair) {
            return pair == 3 ? RegisterSet{0} : static_cast<RegisterSet>(3U << 2 * pair);
        };
        const unsigned low_three = opcode & 7U;
        const unsigned pair = opcode >> 4 & 3U;
        if (opcode < 0x40) {
            if (low_three == 4 || low_three == 5 || low_three == 6) return set | register_bit(high);
            if ((opcode & 0x0F) == 0x01 || (opcode & 0x0F) == 0x03 || (opcode & 0x0F) == 0x0B) {
                return set | pair_bits(pair);
            }
            if ((opcode & 0x0F) == 0x09 || opcode == op::kLhld) {
                return set | set_of(Pair::hl);
            }
            const bool writes_a = low_three == 7 || opcode == op::kLda || opcode == 0x0A ||
                                  opcode == 0x1A || opcode == op::kRim;
            return writes_a ? set | set_of(Register::a) : set;
        }
        if (opcode < 0x80) return opcode == op::kHlt ? set : set | register_bit(high);
        if (opcode < 0xB8) return set | set_of(Register::a);
        if (opcode < 0xC0) return set;
        if (opcode == op::kPopPsw) return kAllRegisters & (set_of(Register::a) | 0x40);
        if ((opcode & 0xCF) == 0xC1) return set | pair_bits(pair);
        if (low_three == 6 && opcode != 0xFE) return set | set_of(Register::a);
        if (opcode == op::kXchg) return set | 0x3C;
        if (opcode == op::kXthl) return set | set_of(Pair::hl);
        if (opcode == op::kIn) return set | set_of(Register::a);
        return set;
    }

    void find_clobbers() {
        for (const CodeItem& item : code_.items) {
            if (item.kind == CodeItem::Kind::instruction) code_.clobbers |= written_by(item.opcode);
        }
        for (const Block& block : facts_.function.blocks) {
            for (const Operation& operation : block.operations) {
                if (operation.opcode != Opcode::call && operation.opcode != Opcode::call_indirect) {
                    continue;
                }
                RegisterSet set = operation.clobbers;
                if (set == kAllRegisters && operation.opcode == Opcode::call &&
                    options_.clobbers_of) {
                    set = options_.clobbers_of(operation.symbol);
                }
                for (const Register which : operation.result_registers) set |= set_of(which);
                code_.clobbers |= set;
            }
            if (block.terminator.kind == Terminator::Kind::table) code_.clobbers |= 0xF0;
        }
    }

    // -- The stack -------------------------------------------------------------------------------
    void count_stack() {
        std::map<uint32_t, uint32_t> signatures;
        for (const Block& block : facts_.function.blocks) {
            for (const Operation& operation : block.operations) {
                if (operation.opcode == Opcode::call_indirect) indirect_.push_back(&operation);
            }
        }
        uint32_t depth = 0;
        for (const CodeItem& item : code_.items) {
            if (item.kind != CodeItem::Kind::instruction) continue;
            const isa::Instruction& instruction = isa::instruction(item.opcode);
            if ((item.opcode & 0xCF) == 0xC5) depth += 2;
            if ((item.opcode & 0xCF) == 0xC1) depth -= 2;
            code_.stack_bytes = std::max(code_.stack_bytes, depth);
            if (instruction.flow == isa::Flow::call &&
                item.operand.kind == CodeOperand::Kind::symbol) {
                code_.calls.push_back({item.operand.id, kNone, depth});
            }
            if (instruction.flow == isa::Flow::jump &&
                item.operand.kind == CodeOperand::Kind::symbol) {
                code_.calls.push_back({item.operand.id, kNone, depth, true});
            }
        }
        for (CallSite& call : code_.calls) {
            for (const Operation* operation : indirect_) {
                if (operation->symbol != call.symbol) continue;
                const bool first = call.signature == kNone;
                if (first) call.signature = operation->signature;
            }
        }
        add_signatures();
    }

    // Which indirect call an instruction belongs to is not known any more: each signature at the
    // deepest of them.
    void add_signatures() {
        uint32_t deepest = 0;
        std::set<uint32_t> signatures;
        for (const Operation* operation : indirect_) signatures.insert(operation->signature);
        if (signatures.empty()) return;
        const uint32_t routine = indirect_.front()->symbol;
        std::vector<CallSite> kept;
        for (const CallSite& call : code_.calls) {
            if (call.symbol == routine) {
                deepest = std::max(deepest, call.pushed);
            } else {
                kept.push_back(call);
            }
        }
        for (const uint32_t signature : signatures) kept.push_back({routine, signature, deepest});
        code_.calls = std::move(kept);
    }

    void deeper(uint32_t bytes) {
        code_.stack_bytes += bytes;
        for (CallSite& call : code_.calls) call.pushed += bytes;
    }

    // Variables of a recursive function on the real stack.
    void move_stack(std::vector<CodeItem>& to, int32_t bytes) {
        const CodeOperand spare{CodeOperand::Kind::frame, CodeOperand::Part::word, kSpareWord, 0};
        to.push_back(make_item(op::kShld, spare));
        to.push_back(make_item(by_pair(op::kLxi, Pair::hl), number(bytes)));
        to.push_back(make_item(op::kDadSp));
        to.push_back(make_item(op::kSphl));
        to.push_back(make_item(op::kLhld, spare));
    }

    /// Code in front, and code before every return. A conditional return becomes a jump around.
    void wrap(const std::vector<CodeItem>& before, const std::vector<CodeItem>& behind) {
        std::vector<CodeItem> items = before;
        for (const CodeItem& item : code_.items) {
            const bool returns = item.kind == CodeItem::Kind::instruction &&
                                 isa::instruction(item.opcode).flow == isa::Flow::ret;
            if (!returns) {
                items.push_back(item);
                continue;
            }
            const bool conditional = isa::instruction(item.opcode).conditional();
            const uint32_t around = next_label_;
            if (conditional) {
                ++next_label_;
                const auto jump = static_cast<uint8_t>((item.opcode ^ 0x08) | 0x02);
                items.push_back(make_item(
                    jump, {CodeOperand::Kind::label, CodeOperand::Part::word, around, 0}));
            }
            items.insert(items.end(), behind.begin(), behind.end());
            items.push_back(make_item(op::kRet));
            if (conditional) items.push_back(label(around));
        }
        code_.items = std::move(items);
    }

    void frame_stack_variables() {
        if (facts_.function.stack_bytes == 0) return;
        const auto bytes = static_cast<int32_t>(facts_.function.stack_bytes);
        std::vector<CodeItem> before;
        std::vector<CodeItem> behind;
        move_stack(before, -bytes);
        move_stack(behind, bytes);
        wrap(before, behind);
        code_.clobbers |= set_of(Register::flags);
        deeper(facts_.function.stack_bytes);
    }

    // An interrupt function leaves everything as it was. TRAP may come while interrupts are off:
    // the first RIM behind it says whether they were on.
    void frame_interrupt() {
        if (facts_.function.interrupt < 0) return;
        const bool trap = facts_.function.interrupt == kTrap;
        const RegisterSet used = code_.clobbers;
        std::vector<CodeItem> before;
        std::vector<CodeItem> behind;
        uint32_t pushed = 0;
        const auto keep = [&](uint8_t push, uint8_t pop) {
            before.push_back(make_item(push));
            behind.insert(behind.begin(), make_item(pop));
            pushed += 2;
        };
        if (trap || (used & 0xC0) != 0) keep(op::kPushPsw, op::kPopPsw);
        if (trap) {
            before.push_back(make_item(op::kRim));
            before.push_back(make_item(op::kPushPsw));
            pushed += 2;
        }
        std::vector<CodeItem> pops;
        for (const Pair pair : {Pair::bc, Pair::de, Pair::hl}) {
            if ((used & set_of(pair)) == 0) continue;
            before.push_back(make_item(by_pair(op::kPush, pair)));
            pops.insert(pops.begin(), make_item(by_pair(op::kPop, pair)));
            pushed += 2;
        }
        if (trap) {
            const uint32_t was_off = next_label_++;
            pops.push_back(make_item(op::kPopPsw));
            pops.push_back(make_item(0xE6, number(0x08)));  // ANI: the IE bit of RIM
            pops.push_back(make_item(
                op::kJz, {CodeOperand::Kind::label, CodeOperand::Part::word, was_off, 0}));
            pops.push_back(make_item(op::kPopPsw));
            pops.push_back(make_item(op::kEi));
            pops.push_back(make_item(op::kRet));
            pops.push_back(label(was_off));
            behind.insert(behind.begin(), pops.begin(), pops.end());
        } else {
            behind.insert(behind.begin(), pops.begin(), pops.end());
            behind.push_back(make_item(op::kEi));
        }
        wrap_interrupt(before, behind, trap);
        deeper(pushed);
        code_.clobbers = 0;
    }

    // One epilogue, jumped to from every return: labels in it must be there once.
    void wrap_interrupt(const std::vector<CodeItem>& before, const std::vector<CodeItem>& behind,
                        bool) {
        const uint32_t out = next_label_++;
        std::vector<CodeItem> items = before;
        for (CodeItem item : code_.items) {
            const bool returns = item.kind == CodeItem::Kind::instruction &&
                                 isa::instruction(item.opcode).flow == isa::Flow::ret;
            if (returns) {
                const bool conditional = isa::instruction(item.opcode).conditional();
                item.opcode = conditional ? static_cast<uint8_t>(item.opcode | 0x02) : op::kJmp;
                item.operand = {CodeOperand::Kind::label, CodeOperand::Part::word, out, 0};
            }
            items.push_back(item);
        }
        items.push_back(label(out));
        items.insert(items.end(), behind.begin(), behind.end());
        items.push_back(make_item(op::kRet));
        code_.items = std::move(items);
        improve(code_.items);
    }

    // -- The frame -------------------------------------------------------------------------------
    [[nodiscard]] uint32_t size_of_variable(uint32_t variable) const {
        if (variable == kNone) return 1;
        if (variable == kSpareWord) return 2;
        return facts_.variable_size[variable];
    }

    // First place where nothing that lives at the same time is.
    void allocate_frame() {
        std::set<uint32_t> used;
        for (const CodeItem& item : code_.items) {
            if (item.operand.kind == CodeOperand::Kind::frame) used.insert(item.operand.id);
        }
        std::map<uint32_t, uint32_t> offsets;
        for (const uint32_t variable : used) {
            std::set<uint32_t> others;
            if (variable < facts_.interferes.size()) {
                others.insert(facts_.interferes[variable].begin(),
                              facts_.interferes[variable].end());
            }
            const bool spare = variable >= kSpareWord;
            const uint32_t size = size_of_variable(variable);
            uint32_t offset = 0;
            for (bool moved = true; moved;) {
                moved = false;
                for (const auto& [other, at] : offsets) {
                    const bool apart = !spare && other < kSpareWord && !others.contains(other);
                    const uint32_t end = at + size_of_variable(other);
                    if (apart || offset >= end || offset + size <= at) continue;
                    offset = end;
                    moved = true;
                }
            }
            offsets[variable] = offset;
            code_.frame_bytes = std::max(code_.frame_bytes, offset + size);
        }
        for (CodeItem& item : code_.items) {
            if (item.operand.kind != CodeOperand::Kind::frame) continue;
            item.operand.offset += static_cast<int32_t>(offsets.at(item.operand.id));
            item.operand.id = 0;
        }
    }

    const Module& module_;
    const GenerateOptions& options_;
    FunctionFacts facts_;
    FunctionCode code_;
    uint32_t next_label_ = 0;
    bool is_clean_ = false;
    std::vector<const Operation*> indirect_;
};

}  // namespace

FunctionCode generate(const Module& module, const Function& function,
                      const GenerateOptions& options) {
    return Generator(module, function, options).run();
}

}  // namespace toolchain::codegen
