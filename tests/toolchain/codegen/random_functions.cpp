// random_functions.cpp - see random_functions.hpp. A function is made statement by statement; what
// an arm or a loop's body defines is forgotten behind it, so that every use is dominated.
#include "tests/toolchain/codegen/random_functions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <random>
#include <utility>

#include "tests/toolchain/codegen/random_values.hpp"
#include "toolchain/codegen/builder.hpp"

namespace codegen_test {

using namespace toolchain::codegen;

namespace {

using Kind = Terminator::Kind;

/// A function that others may call.
struct Callee {
    SymbolId symbol;
    std::vector<std::size_t> sizes;
    std::size_t result;
};

class FunctionMaker : ValueMaker {
public:
    FunctionMaker(Module& module, std::mt19937_64& random, const std::vector<Callee>& callees,
                  unsigned statements)
        : ValueMaker(module, random), callees_(callees), statements_(statements) {}

    /// A function without arguments or result.
    Function entry(const std::string& name) {
        function_.symbol = module_.intern(name);
        for (unsigned i = 0; i < 3; ++i) {
            scope_.values.push_back(builder_.load(data(chance(200)), size(), false));
        }
        statements(0);
        leave_values();
        builder_.terminate(ending(Kind::give_back));
        return std::move(function_);
    }

    /// A function with arguments and result. @param recursive  it calls itself, and counts that
    Function callee(const Callee& shape, bool recursive) {
        function_.symbol = shape.symbol;
        function_.result_size = static_cast<uint32_t>(shape.result);
        for (const std::size_t bytes : shape.sizes) {
            const Bytes parameter = builder_.parameter(bytes);
            function_.parameters.push_back(parameter);
            Bytes& all = function_.blocks[0].parameters;
            all.insert(all.end(), parameter.begin(), parameter.end());
            function_.blocks[0].parameter_sizes.push_back(static_cast<uint32_t>(bytes));
            scope_.values.push_back(parameter);
        }
        statements(1);
        if (recursive) call_itself(shape);
        statements(1);
        Terminator end = ending(Kind::give_back);
        end.left = value(shape.result);
        builder_.terminate(end);
        return std::move(function_);
    }

private:
    // -- Statements ------------------------------------------------------------------------------
    void statements(unsigned depth) {
        const unsigned count = 2 + chance(depth == 0 ? statements_ : 2 + statements_ / 3);
        for (unsigned i = 0; i < count; ++i) statement(depth);
    }

    void statement(unsigned depth) {
        const unsigned which = chance(depth < 3 ? 26 : 19);
        if (which < 10) return compute();
        if (which < 13) return keep(builder_.load(pointer().address, size(), one_in(8)));
        if (which < 16) return builder_.store(pointer().address, value(size()), one_in(8));
        if (which < 17) return call_routine();
        if (which < 19) return one_in(2) ? call_function(depth) : compute();
        if (function_.blocks.size() > kMostBlocks) return;
        if (which < 22) return diamond(depth);
        if (which < 23) return table(depth);
        if (which < 25) return bottom_tested_loop(depth);
        return top_tested_loop(depth);
    }

    void compute() {
        const std::size_t bytes = size();
        switch (chance(10)) {
            case 0:
            case 1:
                return keep(builder_.add(value(bytes), value(bytes)));
            case 2:
                return keep(builder_.add(value(bytes), builder_.constant(number(), bytes)));
            case 3:
                return keep(builder_.subtract(value(bytes), value(bytes)));
            case 4:
            case 5: {
                static constexpr std::array<Opcode, 3> kLogic = {Opcode::bit_and, Opcode::bit_or,
                                                                 Opcode::bit_xor};
                return keep(builder_.bitwise(kLogic[chance(3)], value(bytes), value(bytes)));
            }
            case 6:
                return keep(builder_.shift_left(value(bytes), chance(8 * unsigned(bytes))));
            case 7:
                return keep(builder_.shift_right(value(bytes), chance(8 * unsigned(bytes))));
            case 8:
                return keep(builder_.shift_right_signed(value(bytes), chance(8 * unsigned(bytes))));
            default:
                return keep({builder_.compare(predicate(), value(bytes), value(bytes))});
        }
    }

    void call_routine() {
        struct Routine {
            const char* name;
            std::size_t left, right, result;
        };
        static constexpr std::array<Routine, 15> kRoutines = {{{"__mul8", 1, 1, 2},
                                                               {"__mul16", 2, 2, 2},
                                                               {"__umul16w", 2, 2, 4},
                                                               {"__smul16w", 2, 2, 4},
                                                               {"__mul8_s16w", 1, 2, 3},
                                                               {"__mul32", 4, 4, 4},
                                                               {"__mul64", 8, 8, 8},
                                                               {"__shl16", 2, 1, 2},
                                                               {"__lshr8", 1, 1, 1},
                                                               {"__ashr32", 4, 1, 4},
                                                               {"__shl64", 8, 1, 8},
                                                               {"__udiv16", 2, 2, 4},
                                                               {"__udiv8", 1, 1, 2},
                                                               {"__udiv32", 4, 4, 8},
                                                               {"__sdiv16", 2, 2, 4}}};
        const Routine& routine = kRoutines[chance(kRoutines.size())];
        const Bytes left = value(routine.left);
        Bytes right = value(routine.right);
        if (std::string_view(routine.name).find("div") != std::string_view::npos) {
            // Never 0, and never -1.
            right[0] = builder_.bitwise(Opcode::bit_or, {right[0]}, builder_.constant(2, 1))[0];
            right[0] = builder_.bitwise(Opcode::bit_and, {right[0]}, builder_.constant(0x7E, 1))[0];
        } else if (routine.right == 1 && routine.left != 1) {
            right = builder_.bitwise(Opcode::bit_and, right,
                                     builder_.constant(8 * routine.left - 1, 1));
        }
        const SymbolId called = module_.intern(routine.name);
        const Bytes result = builder_.call(called, {left, right}, routine.result);
        keep(result);
        if (one_in(3)) keep({result.begin(), result.begin() + 1});
    }

    void call_function(unsigned depth) {
        if (callees_.empty() || depth > 2) return;
        const Callee& callee = any(callees_);
        std::vector<Bytes> arguments;
        for (const std::size_t bytes : callee.sizes) arguments.push_back(value(bytes));
        keep(builder_.call(callee.symbol, arguments, callee.result));
    }

    /// If the first argument, without its upper bits, is not 0: itself with one less.
    void call_itself(const Callee& shape) {
        const Bytes counter = builder_.bitwise(Opcode::bit_and, {function_.parameters[0][0]},
                                               builder_.constant(3, 1));
        const BlockId inside = new_block();
        const BlockId behind = new_block();
        const Bytes result = builder_.parameter(shape.result);
        set_parameters(behind, {result});
        branch(Predicate::equal, counter, builder_.constant(0, 1), {behind, value(shape.result)},
               {inside, {}});
        const Scope outside = scope_;
        builder_.set_block(inside);
        std::vector<Bytes> arguments;
        for (const std::size_t bytes : shape.sizes) arguments.push_back(value(bytes));
        arguments[0][0] = builder_.add(counter, builder_.constant(0xFF, 1))[0];
        const Bytes inner = builder_.call(shape.symbol, arguments, shape.result);
        keep(inner);
        compute();
        jump({behind, one_in(2) ? inner : value(shape.result)});
        scope_ = outside;
        builder_.set_block(behind);
        keep(result);
    }

    // -- Blocks ----------------------------------------------------------------------------------
    static constexpr std::size_t kMostBlocks = 30;

    BlockId new_block() {
        function_.blocks.emplace_back();
        Block& block = function_.blocks.back();
        block.frequency = frequency_;
        block.loop_depth = loop_depth_;
        return static_cast<BlockId>(function_.blocks.size() - 1);
    }

    void set_parameters(BlockId block, const std::vector<Bytes>& values) {
        Block& to = function_.blocks[block];
        for (const Bytes& one : values) {
            to.parameters.insert(to.parameters.end(), one.begin(), one.end());
            to.parameter_sizes.push_back(static_cast<uint32_t>(one.size()));
        }
    }

    static Terminator ending(Kind kind) {
        Terminator end;
        end.kind = kind;
        return end;
    }

    void jump(Edge edge) {
        Terminator end = ending(Kind::jump);
        end.edges = {std::move(edge)};
        builder_.terminate(std::move(end));
    }

    void branch(Predicate which, Bytes left, Bytes right, Edge yes, Edge no) {
        Terminator end = ending(Kind::branch);
        end.predicate = which;
        end.left = std::move(left);
        end.right = std::move(right);
        end.edges = {std::move(yes), std::move(no)};
        builder_.terminate(std::move(end));
    }

    Predicate predicate() { return static_cast<Predicate>(chance(6)); }

    /// Values for parameters of those sizes; now and then one twice.
    Bytes arguments_for(const std::vector<Bytes>& parameters) {
        Bytes all;
        Bytes last;
        for (const Bytes& parameter : parameters) {
            const bool again = last.size() == parameter.size() && one_in(4);
            if (!again) last = value(parameter.size());
            all.insert(all.end(), last.begin(), last.end());
        }
        return all;
    }

    std::vector<Bytes> new_parameters(unsigned most) {
        std::vector<Bytes> parameters;
        const unsigned count = chance(most + 1);
        for (unsigned i = 0; i < count; ++i) parameters.push_back(builder_.parameter(size()));
        return parameters;
    }

    void random_branch(Edge yes, Edge no) {
        const std::size_t bytes = size();
        const Bytes left = value(bytes);
        const Bytes right = one_in(2) ? builder_.constant(number(), bytes) : value(bytes);
        branch(predicate(), left, right, std::move(yes), std::move(no));
    }

    // One arm of something that meets again in `behind`.
    void arm(BlockId block, BlockId behind, const std::vector<Bytes>& merged, unsigned depth) {
        const Scope outside = scope_;
        builder_.set_block(block);
        const double frequency = std::exchange(frequency_, frequency_ / 2);
        if (!one_in(4)) statements(depth + 1);
        frequency_ = frequency;
        jump({behind, arguments_for(merged)});
        scope_ = outside;
    }

    void go_on(BlockId block, const std::vector<Bytes>& merged) {
        builder_.set_block(block);
        for (const Bytes& value : merged) keep(value);
    }

    void diamond(unsigned depth) {
        const std::vector<Bytes> merged = new_parameters(3);
        const BlockId first = new_block();
        const BlockId second = one_in(2) ? new_block() : kNone;
        const BlockId behind = new_block();
        set_parameters(behind, merged);
        Edge other = second == kNone ? Edge{behind, arguments_for(merged)} : Edge{second, {}};
        random_branch({first, {}}, std::move(other));
        arm(first, behind, merged, depth);
        if (second != kNone) arm(second, behind, merged, depth);
        go_on(behind, merged);
    }

    void table(unsigned depth) {
        const std::vector<Bytes> merged = new_parameters(2);
        Terminator end = ending(Kind::table);
        end.left = builder_.bitwise(Opcode::bit_and, {byte()}, builder_.constant(3, 1));
        const BlockId behind = new_block();
        set_parameters(behind, merged);
        std::vector<BlockId> arms;
        for (unsigned i = 0; i < 4; ++i) {
            if (!arms.empty() && one_in(3)) {
                end.edges.push_back({any(arms), {}});
            } else if (one_in(3)) {
                end.edges.push_back({behind, arguments_for(merged)});
            } else {
                arms.push_back(new_block());
                end.edges.push_back({arms.back(), {}});
            }
        }
        builder_.terminate(end);
        for (const BlockId block : arms) arm(block, behind, merged, depth);
        go_on(behind, merged);
    }

    // -- Loops -----------------------------------------------------------------------------------
    /// Parameters that a loop carries: counter, values, pointers.
    struct Loop {
        Bytes counter;
        std::vector<Bytes> values;
        std::vector<Pointer> pointers;

        [[nodiscard]] std::vector<Bytes> parameters() const {
            std::vector<Bytes> all = {counter};
            all.insert(all.end(), values.begin(), values.end());
            for (const Pointer& pointer : pointers) all.push_back(pointer.address);
            return all;
        }
    };

    static constexpr unsigned kMostTurns = 5;
    static constexpr unsigned kMostStep = 4;

    /// The loop's parameters, and what they begin with.
    std::pair<Loop, Bytes> begin_loop() {
        Loop loop;
        loop.counter = builder_.parameter(one_in(3) ? 2 : 1);
        for (unsigned i = chance(5); i > 0; --i) {
            // Equal sizes, so that they can be exchanged.
            loop.values.push_back(builder_.parameter(one_in(2) || i == 1 ? size() : 2));
        }
        const Bytes low =
            one_in(2)
                ? builder_.constant(1 + chance(kMostTurns), 1)
                : builder_.add(builder_.bitwise(Opcode::bit_and, {byte()}, builder_.constant(3, 1)),
                               builder_.constant(1, 1));
        Bytes first = builder_.zero_extended(low, loop.counter.size());
        const Bytes values = arguments_for(loop.values);
        first.insert(first.end(), values.begin(), values.end());
        for (unsigned i = chance(3); i > 0; --i) {
            const Pointer start = pointer();
            const unsigned most = start.most + kMostTurns * kMostStep * 2;
            if (most + kLargest >= kDataBytes) continue;
            loop.pointers.push_back({builder_.parameter(2), most});
            first.insert(first.end(), start.address.begin(), start.address.end());
        }
        return {loop, first};
    }

    /// What the next turn begins with: values change places, or are new.
    Bytes next_turn(const Loop& loop, const Bytes& counter) {
        Bytes all = counter;
        const bool turn = one_in(3);
        for (std::size_t i = 0; i < loop.values.size(); ++i) {
            const Bytes& from = loop.values[(i + 1) % loop.values.size()];
            const bool fits = from.size() == loop.values[i].size();
            const Bytes next = turn && fits ? from : value(loop.values[i].size());
            all.insert(all.end(), next.begin(), next.end());
        }
        for (const Pointer& pointer : loop.pointers) {
            const Bytes next =
                builder_.add(pointer.address, builder_.constant(chance(kMostStep + 1), 2));
            all.insert(all.end(), next.begin(), next.end());
        }
        return all;
    }

    void enter_loop(const Loop& loop) {
        keep(loop.counter);
        for (const Bytes& value : loop.values) keep(value);
        scope_.pointers.insert(scope_.pointers.end(), loop.pointers.begin(), loop.pointers.end());
    }

    // Counts down; now and then leaves early. All its values are defined behind it.
    void bottom_tested_loop(unsigned depth) {
        const auto [loop, first] = begin_loop();
        const double frequency = std::exchange(frequency_, frequency_ * (one_in(4) ? 1 : 4));
        ++loop_depth_;
        const BlockId header = new_block();
        set_parameters(header, loop.parameters());
        jump({header, first});
        const Scope outside = scope_;
        builder_.set_block(header);
        enter_loop(loop);
        const Scope header_scope = scope_;
        statements(depth + 1);
        const std::vector<Bytes> merged = new_parameters(2);
        const bool leaves = one_in(3);
        const BlockId behind = new_block();
        set_parameters(behind, merged);
        if (leaves) {
            const BlockId rest = new_block();
            random_branch({behind, arguments_for(merged)}, {rest, {}});
            builder_.set_block(rest);
            if (one_in(2)) statements(depth + 2);
        }
        const Bytes counter =
            builder_.subtract(loop.counter, builder_.constant(1, loop.counter.size()));
        keep(counter);
        const Bytes next = next_turn(loop, counter);
        const Bytes result = arguments_for(merged);
        const Bytes zero = builder_.constant(0, counter.size());
        if (one_in(2)) {
            branch(Predicate::not_equal, counter, zero, {header, next}, {behind, result});
        } else {
            branch(Predicate::equal, counter, zero, {behind, result}, {header, next});
        }
        frequency_ = frequency;
        --loop_depth_;
        function_.blocks[behind].frequency = frequency_;
        scope_ = one_in(2) ? header_scope : outside;
        go_on(behind, merged);
    }

    void top_tested_loop(unsigned depth) {
        const auto [loop, first] = begin_loop();
        const double frequency = std::exchange(frequency_, frequency_ * 4);
        ++loop_depth_;
        const BlockId header = new_block();
        const BlockId body = new_block();
        set_parameters(header, loop.parameters());
        jump({header, first});
        builder_.set_block(header);
        enter_loop(loop);
        const Scope header_scope = scope_;
        const BlockId behind = new_block();
        const Bytes zero = builder_.constant(0, loop.counter.size());
        branch(Predicate::below, zero, loop.counter, {body, {}}, {behind, {}});
        builder_.set_block(body);
        statements(depth + 1);
        const Bytes counter =
            builder_.subtract(loop.counter, builder_.constant(1, loop.counter.size()));
        jump({header, next_turn(loop, counter)});
        frequency_ = frequency;
        --loop_depth_;
        function_.blocks[behind].frequency = frequency_;
        scope_ = header_scope;
        builder_.set_block(behind);
    }

    // -- The end ---------------------------------------------------------------------------------
    /// Stores what is left, so that it matters.
    void leave_values() {
        unsigned offset = 0;
        std::vector<Bytes> values = scope_.values;
        std::shuffle(values.begin(), values.end(), random_);
        for (const Bytes& value : values) {
            if (offset + value.size() > kOutBytes) break;
            if (one_in(4)) continue;
            builder_.store(builder_.address(module_.intern("out"), static_cast<int32_t>(offset)),
                           value, false);
            offset += static_cast<unsigned>(value.size());
        }
        if (one_in(3)) {
            builder_.store(builder_.address(module_.intern("nobody"), 0),
                           {byte(), builder_.undefined(1)[0]}, false);
        }
    }

    const std::vector<Callee>& callees_;
    unsigned statements_;
    double frequency_ = 1;
    uint32_t loop_depth_ = 0;
};

Variable variable(Module& module, const char* name, uint32_t size) {
    return {.symbol = module.intern(name), .size = size};
}

}  // namespace

RandomProgram random_program(uint64_t seed, const RandomLimits& limits) {
    std::mt19937_64 random(seed);
    RandomProgram program;
    Module& module = program.module;
    module.variables = {variable(module, "data", kDataBytes), variable(module, "out", kOutBytes),
                        variable(module, "nobody", 2)};
    std::vector<Callee> callees;
    for (unsigned i = 0; i < limits.callees; ++i) {
        Callee callee{module.intern(fmt::format("callee{}", i)), {}, 1 + random() % 4};
        if (random() % 6 == 0) callee.result = 8;
        for (uint64_t count = 1 + random() % 4; count > 0; --count) {
            callee.sizes.push_back(random() % 7 == 0 ? 8 : 1 + random() % 4);
        }
        const bool recursive = random() % 4 == 0;
        module.functions.push_back(FunctionMaker(module, random, callees, limits.statements / 2)
                                       .callee(callee, recursive));
        callees.push_back(callee);
    }
    for (unsigned i = 0; i < limits.entries; ++i) {
        const std::string name = fmt::format("entry{}", i);
        const unsigned statements = 1 + static_cast<unsigned>(random() % (2 * limits.statements));
        module.functions.push_back(FunctionMaker(module, random, callees, statements).entry(name));
        program.entries.push_back(name);
    }
    return program;
}

}  // namespace codegen_test
