// compare_programs.cpp - see compare_programs.hpp.
#include "tests/toolchain/codegen/compare_programs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <exception>
#include <random>
#include <stdexcept>

#include "tests/toolchain/codegen/generated_program.hpp"
#include "tests/toolchain/codegen/interpreter.hpp"
#include "toolchain/codegen/lower_calls.hpp"

namespace codegen_test {

using namespace toolchain::codegen;

namespace {

constexpr uint64_t kStepLimit = 100'000;
constexpr uint64_t kLimitT = 60'000'000;

uint8_t random_byte(std::mt19937_64& random) {
    static constexpr std::array<uint8_t, 6> kCorners = {0, 1, 0x7F, 0x80, 0xFE, 0xFF};
    const uint64_t number = random();
    return number % 4 == 0 ? kCorners[(number >> 8) % kCorners.size()]
                           : static_cast<uint8_t>(number >> 16);
}

std::string compare_variable(const Interpreter& expected, const GeneratedProgram& actual,
                             const std::string& name, unsigned size) {
    for (unsigned i = 0; i < size; ++i) {
        const uint8_t right = expected.memory[expected.address(name) + i];
        const uint8_t got = actual.machine.memory.bytes[actual.address(name) + i];
        if (right != got) {
            return fmt::format("{}[{}] is {:02X}, should be {:02X}", name, i, got, right);
        }
    }
    return {};
}

std::string run_once(const std::string& entry, Interpreter& expected, GeneratedProgram& actual,
                     std::mt19937_64& random) {
    for (unsigned i = 0; i < kDataBytes; ++i) {
        const uint8_t value = random_byte(random);
        expected.memory[expected.address("data") + i] = value;
        actual.machine.memory.bytes[actual.address("data") + i] = value;
    }
    for (unsigned i = 0; i < kOutBytes; ++i) {
        expected.memory[expected.address("out") + i] = 0;
        actual.machine.memory.bytes[actual.address("out") + i] = 0;
    }
    expected.steps = 0;
    try {
        (void)expected.call(entry);
    } catch (const std::exception&) {
        return {};  // a program that takes too long says nothing
    }
    try {
        (void)actual.call(entry, kLimitT);
    } catch (const std::exception& error) {
        return error.what();
    }
    std::string found = compare_variable(expected, actual, "data", kDataBytes);
    return found.empty() ? compare_variable(expected, actual, "out", kOutBytes) : found;
}

GeneratedProgram generated(const RandomProgram& program, const CompareOptions& options) {
    Module lowered = program.module;
    lower_calls(lowered);
    GenerateOptions generate_options;
    generate_options.search = options.search;
    generate_options.undocumented = options.undocumented;
    generate_options.byte_cost = options.byte_cost;
    generate_options.search_budget = options.budget;
    generate_options.homes_by_chance = options.homes_by_chance;
    return GeneratedProgram(lowered, generate_options, options.ask_clobbers);
}

}  // namespace

std::string listing(const RandomProgram& program, const CompareOptions& options) {
    try {
        return generated(program, options).listing();
    } catch (const std::exception&) {
        return {};
    }
}

std::string difference(const RandomProgram& program, const CompareOptions& options) {
    for (const Function& function : program.module.functions) {
        const std::string wrong = verify(function);
        if (!wrong.empty()) return fmt::format("not a function: {}", wrong);
    }
    Interpreter expected(program.module);
    expected.step_limit = kStepLimit;
    try {
        GeneratedProgram actual = generated(program, options);
        std::mt19937_64 random(options.seed);
        for (const std::string& entry : program.entries) {
            for (unsigned run = 0; run < options.runs; ++run) {
                const std::string found = run_once(entry, expected, actual, random);
                if (!found.empty()) return fmt::format("{}, run {}: {}", entry, run, found);
            }
        }
    } catch (const std::exception& error) {
        return fmt::format("no code: {}", error.what());
    }
    return {};
}

namespace {

/// Tries simplifications one after another; each that keeps the difference stays.
class Shrinker {
public:
    Shrinker(RandomProgram program, const CompareOptions& options)
        : program_(std::move(program)), options_(options) {}

    RandomProgram run() {
        for (bool again = true; again;) {
            again = false;
            drop_entries(again);
            for (std::size_t i = 0; i < program_.module.functions.size(); ++i) {
                shorten_ways(i, again);
                drop_blocks(i, again);
                drop_parameters(i, again);
                drop_operations(i, again);
                replace_operands(i, again);
            }
        }
        return std::move(program_);
    }

private:
    bool accept(RandomProgram smaller, bool& again) {
        const std::string found = difference(smaller, options_);
        if (found.empty() || found.starts_with("not a function") ||
            found.find("not defined") != std::string::npos) {
            return false;
        }
        program_ = std::move(smaller);
        again = true;
        return true;
    }

    Function& function(RandomProgram& of, std::size_t index) { return of.module.functions[index]; }

    void drop_entries(bool& again) {
        for (std::size_t i = program_.module.functions.size(); i-- > 0;) {
            RandomProgram smaller = program_;
            std::erase(smaller.entries, smaller.module.symbols[smaller.module.functions[i].symbol]);
            smaller.module.functions.erase(smaller.module.functions.begin() +
                                           static_cast<std::ptrdiff_t>(i));
            if (!smaller.entries.empty()) accept(std::move(smaller), again);
        }
    }

    // A branch becomes a jump; a block ends the function.
    void shorten_ways(std::size_t index, bool& again) {
        for (std::size_t block = 0; block < function(program_, index).blocks.size(); ++block) {
            const std::size_t count =
                function(program_, index).blocks[block].terminator.edges.size();
            for (std::size_t way = 0; count > 1 && way < count; ++way) {
                RandomProgram smaller = program_;
                Terminator& end = function(smaller, index).blocks[block].terminator;
                end.kind = Terminator::Kind::jump;
                end.edges = {end.edges[way]};
                end.left.clear();
                end.right.clear();
                if (accept(std::move(smaller), again)) break;
            }
        }
    }

    // Blocks that nothing reaches any more; a block with one way in is joined to it.
    void drop_blocks(std::size_t index, bool& again) {
        for (std::size_t block = 1; block < function(program_, index).blocks.size(); ++block) {
            const Function& whole = function(program_, index);
            std::size_t ways = 0;
            std::size_t from = 0;
            for (std::size_t other = 0; other < whole.blocks.size(); ++other) {
                for (const Edge& edge : whole.blocks[other].terminator.edges) {
                    if (edge.target != block) continue;
                    ++ways;
                    from = other;
                }
            }
            RandomProgram smaller = program_;
            Function& changed = function(smaller, index);
            if (ways == 1 && from != block &&
                changed.blocks[from].terminator.kind == Terminator::Kind::jump) {
                Block& before = changed.blocks[from];
                const Block& behind = changed.blocks[block];
                if (!behind.parameters.empty()) continue;
                before.operations.insert(before.operations.end(), behind.operations.begin(),
                                         behind.operations.end());
                before.terminator = behind.terminator;
                ways = 0;
            }
            if (ways != 0) continue;
            changed.blocks.erase(changed.blocks.begin() + static_cast<std::ptrdiff_t>(block));
            for (Block& other : changed.blocks) {
                for (Edge& edge : other.terminator.edges) edge.target -= edge.target > block;
            }
            accept(std::move(smaller), again);
        }
    }

    static void make_constant(Function& of, ByteId byte) {
        of.bytes[byte] = {ByteInfo::Kind::constant, 0};
    }

    void drop_parameters(std::size_t index, bool& again) {
        for (std::size_t block = 1; block < function(program_, index).blocks.size(); ++block) {
            for (std::size_t at = function(program_, index).blocks[block].parameters.size();
                 at-- > 0;) {
                RandomProgram smaller = program_;
                Function& changed = function(smaller, index);
                Bytes& parameters = changed.blocks[block].parameters;
                if (is_address(changed, {parameters[at]})) continue;
                make_constant(changed, parameters[at]);
                const auto place = static_cast<std::ptrdiff_t>(at);
                parameters.erase(parameters.begin() + place);
                std::size_t first = 0;
                for (uint32_t& size : changed.blocks[block].parameter_sizes) {
                    if (at >= first && at < first + size) {
                        --size;
                        break;
                    }
                    first += size;
                }
                std::erase(changed.blocks[block].parameter_sizes, 0U);
                for (Block& other : changed.blocks) {
                    for (Edge& edge : other.terminator.edges) {
                        if (edge.target == block)
                            edge.arguments.erase(edge.arguments.begin() + place);
                    }
                }
                accept(std::move(smaller), again);
            }
        }
    }

    void drop_operations(std::size_t index, bool& again) {
        for (std::size_t block = function(program_, index).blocks.size(); block-- > 0;) {
            for (std::size_t at = function(program_, index).blocks[block].operations.size();
                 at-- > 0;) {
                RandomProgram smaller = program_;
                Function& changed = function(smaller, index);
                std::vector<Operation>& operations = changed.blocks[block].operations;
                if (is_address(changed, operations[at].results)) continue;
                for (const ByteId byte : operations[at].results) make_constant(changed, byte);
                operations.erase(operations.begin() + static_cast<std::ptrdiff_t>(at));
                accept(std::move(smaller), again);
            }
        }
    }

    void replace_operands(std::size_t index, bool& again) {
        Function& whole = function(program_, index);
        const auto zero = static_cast<ByteId>(whole.bytes.size());
        whole.bytes.push_back({ByteInfo::Kind::constant, 0});
        for (std::size_t block = 0; block < function(program_, index).blocks.size(); ++block) {
            const Block now = function(program_, index).blocks[block];
            for (std::size_t way = 0; way < now.terminator.edges.size(); ++way) {
                for (std::size_t i = 0; i < now.terminator.edges[way].arguments.size(); ++i) {
                    RandomProgram smaller = program_;
                    ByteId& byte =
                        function(smaller, index).blocks[block].terminator.edges[way].arguments[i];
                    if (is_number(function(smaller, index), byte)) continue;
                    byte = zero;
                    accept(std::move(smaller), again);
                }
            }
            for (std::size_t at = 0; at < now.operations.size(); ++at) {
                for (std::size_t i = 0; i < now.operations[at].right.size(); ++i) {
                    RandomProgram smaller = program_;
                    ByteId& byte = function(smaller, index).blocks[block].operations[at].right[i];
                    if (is_number(function(smaller, index), byte)) continue;
                    byte = zero;
                    accept(std::move(smaller), again);
                }
            }
        }
    }

    static bool is_number(const Function& of, ByteId byte) {
        return of.bytes[byte].kind == ByteInfo::Kind::constant || is_address(of, {byte});
    }

    // Without a part of it, an address would lie somewhere else in the interpreter than in the
    // machine.
    static bool is_address(const Function& of, const Bytes& bytes) {
        std::vector<bool> address(of.bytes.size());
        for (std::size_t byte = 0; byte < of.bytes.size(); ++byte) {
            address[byte] = of.bytes[byte].kind == ByteInfo::Kind::address_low ||
                            of.bytes[byte].kind == ByteInfo::Kind::address_high;
        }
        const auto any = [&](const Bytes& some) {
            return std::any_of(some.begin(), some.end(), [&](ByteId b) { return address[b]; });
        };
        for (bool changed = true; changed;) {
            changed = false;
            const auto mark = [&](ByteId byte) {
                changed = changed || !address[byte];
                address[byte] = true;
            };
            for (const Block& block : of.blocks) {
                for (const Operation& operation : block.operations) {
                    if (operation.opcode != Opcode::add) continue;
                    if (!any(operation.left) && !any(operation.right)) continue;
                    for (const ByteId byte : operation.results) mark(byte);
                }
                for (const Edge& edge : block.terminator.edges) {
                    for (std::size_t i = 0; i < edge.arguments.size(); ++i) {
                        if (address[edge.arguments[i]]) mark(of.blocks[edge.target].parameters[i]);
                    }
                }
            }
        }
        return any(bytes);
    }

    RandomProgram program_;
    CompareOptions options_;
};

}  // namespace

RandomProgram shrink(RandomProgram program, const CompareOptions& options) {
    return Shrinker(std::move(program), options).run();
}

uint64_t run_small(uint64_t argument, std::size_t argument_size, std::size_t result_size,
                   const Small& body) {
    Module module;
    const auto size = [](std::size_t bytes) { return static_cast<unsigned>(bytes); };
    const auto add_variable = [&](const char* name, std::size_t bytes) {
        Variable variable;
        variable.symbol = module.intern(name);
        variable.size = size(bytes);
        module.variables.push_back(variable);
        return variable.symbol;
    };
    const SymbolId from = add_variable("argument", argument_size);
    const SymbolId to = add_variable("result", result_size);
    Function function;
    function.symbol = module.intern("f");
    function.blocks.emplace_back();
    Builder builder(function);
    const Bytes x = builder.load(builder.address(from, 0), argument_size, false);
    builder.store(builder.address(to, 0), body(builder, x), false);
    Terminator end;
    end.kind = Terminator::Kind::give_back;
    builder.terminate(end);
    module.functions.push_back(function);
    Interpreter expected(module);
    for (unsigned i = 0; i < argument_size; ++i) {
        expected.memory[expected.address("argument") + i] = static_cast<uint8_t>(argument >> 8 * i);
    }
    (void)expected.call("f");
    lower_calls(module);
    for (const unsigned kind : {0U, 1U, 2U, 3U}) {
        GenerateOptions options;
        options.search = kind % 2 != 0;
        options.undocumented = kind > 1;
        GeneratedProgram actual(module, options);
        for (unsigned i = 0; i < argument_size; ++i) {
            actual.machine.memory.bytes[actual.address("argument") + i] =
                static_cast<uint8_t>(argument >> 8 * i);
        }
        (void)actual.call("f");
        if (actual.variable("result", size(result_size)) !=
            expected.variable("result", size(result_size))) {
            throw std::runtime_error("machine code and interpreter differ:\n" + actual.listing());
        }
    }
    return expected.variable("result", size(result_size));
}

}  // namespace codegen_test
