// Random programs of functions that call one another by name, through pointers and recursively,
// with arguments and results of all sizes: the processor gives what the interpreter gives for the
// module before calls are lowered. Seeds are fixed; ROVER_CALL_SEED tries another one.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "tests/toolchain/codegen/compiled_program.hpp"
#include "tests/toolchain/codegen/interpreter.hpp"
#include "tests/toolchain/ir/ir_program.hpp"
#include "toolchain/codegen/compile.hpp"

namespace {

using namespace toolchain::codegen;

struct Value {
    std::string name;
    unsigned bits;
};

struct Declared {
    std::string name;
    std::vector<unsigned> parameters;
    unsigned result;
    bool recursive;  ///< first parameter is the depth
};

/// LLVM IR, valid by construction, that computes something of everything it has.
class RandomProgram {
public:
    explicit RandomProgram(uint64_t seed) : random_(seed) {}

    std::string text() {
        const unsigned functions = 3 + below(6);
        for (unsigned i = 0; i < functions; ++i) add_function(i);
        std::string table;
        for (const Declared& function : functions_) {
            globals_ += fmt::format("@p_{0} = global ptr @{0}\n", function.name);
        }
        add_main();
        return globals_ + table + code_;
    }

    /// Names of the variables that hold results.
    std::vector<std::string> results;

private:
    unsigned below(unsigned bound) { return static_cast<unsigned>(random_() % bound); }

    unsigned width() {
        constexpr unsigned kWidths[] = {8, 8, 16, 16, 16, 24, 32, 32, 40, 64};
        return kWidths[below(10)];
    }
    std::string fresh() { return fmt::format("%v{}", next_++); }
    void line(const std::string& text) { code_ += "  " + text + "\n"; }

    /// Some value as a value of that width.
    std::string as(unsigned bits) {
        if (values_.empty() || below(5) == 0) {
            const uint64_t number = random_() >> below(60);
            return fmt::format("{}", bits == 64 ? number : number & ((uint64_t{1} << bits) - 1));
        }
        const Value value = values_[below(static_cast<unsigned>(values_.size()))];
        if (value.bits == bits) return value.name;
        const char* how = value.bits > bits ? "trunc" : below(2) == 0 ? "zext" : "sext";
        const std::string name = fresh();
        line(fmt::format("{} = {} i{} {} to i{}", name, how, value.bits, value.name, bits));
        return name;
    }

    void compute() {
        constexpr const char* kOperations[] = {"add", "sub", "xor", "and", "or", "mul"};
        const unsigned bits = width();
        const std::string left = as(bits);
        const std::string right = as(bits);
        const std::string name = fresh();
        line(fmt::format("{} = {} i{} {}, {}", name, kOperations[below(6)], bits, left, right));
        values_.push_back({name, bits});
    }

    void call(const Declared& callee, bool through_pointer, const std::string& depth) {
        std::vector<std::string> arguments;
        for (std::size_t i = 0; i < callee.parameters.size(); ++i) {
            const unsigned bits = callee.parameters[i];
            const bool is_depth = callee.recursive && i == 0;
            arguments.push_back(fmt::format("i{} {}", bits, is_depth ? depth : as(bits)));
        }
        std::string target = "@" + callee.name;
        if (through_pointer) {
            target = fresh();
            line(fmt::format("{} = load ptr, ptr @p_{}", target, callee.name));
        }
        const std::string name = fresh();
        line(fmt::format("{} = call i{} {}({})", name, callee.result, target,
                         fmt::join(arguments, ", ")));
        values_.push_back({name, callee.result});
    }

    void some_work(unsigned count) {
        for (unsigned i = 0; i < count; ++i) {
            if (!functions_.empty() && below(3) == 0) {
                const auto which = below(static_cast<unsigned>(functions_.size()));
                call(functions_[which], below(3) == 0, fmt::format("{}", below(4)));
            } else {
                compute();
            }
        }
    }

    /// A variable in the frame whose address is used, now and then.
    void keep_in_memory() {
        if (below(2) == 0) return;
        const unsigned bits = width();
        const std::string slot = fresh();
        const std::string back = fresh();
        code_.insert(entry_, fmt::format("  {} = alloca i{}\n", slot, bits));
        line(fmt::format("store volatile i{} {}, ptr {}", bits, as(bits), slot));
        some_work(1);
        line(fmt::format("{} = load volatile i{}, ptr {}", back, bits, slot));
        values_.push_back({back, bits});
    }

    void add_function(unsigned number) {
        Declared function;
        function.name = fmt::format("f{}", number);
        function.recursive = below(3) == 0;
        function.result = width();
        if (function.recursive) function.parameters.push_back(16);
        const unsigned count = below(6);
        for (unsigned i = 0; i < count; ++i) function.parameters.push_back(width());
        std::vector<std::string> parameters;
        values_.clear();
        for (std::size_t i = 0; i < function.parameters.size(); ++i) {
            const std::string name = fmt::format("%a{}", i);
            parameters.push_back(fmt::format("i{} {}", function.parameters[i], name));
            values_.push_back({name, function.parameters[i]});
        }
        code_ += fmt::format("define i{} @{}({}) noinline {{\n", function.result, function.name,
                             fmt::join(parameters, ", "));
        entry_ = code_.size();
        keep_in_memory();
        some_work(2 + below(5));
        if (function.recursive) recurse(function);
        some_work(below(3));
        line(fmt::format("ret i{} {}", function.result, as(function.result)));
        code_ += "}\n";
        functions_.push_back(function);
    }

    /// Goes on to the rest of the function by itself, or by way of a call of itself.
    void recurse(const Declared& function) {
        const std::string done = fresh();
        const std::string less = fresh();
        const unsigned label = next_++;
        const std::vector<Value> before = values_;
        line(fmt::format("{} = icmp eq i16 %a0, 0", done));
        line(fmt::format("br i1 {0}, label %leaf{1}, label %again{1}", done, label));
        code_ += fmt::format("again{}:\n", label);
        line(fmt::format("{} = sub i16 %a0, 1", less));
        call(function, false, less);
        const std::string result = values_.back().name;
        line(fmt::format("br label %join{}", label));
        code_ += fmt::format("leaf{}:\n", label);
        line(fmt::format("br label %join{}", label));
        code_ += fmt::format("join{}:\n", label);
        values_ = before;
        const std::string merged = fresh();
        line(fmt::format("{0} = phi i{1} [ {2}, %again{3} ], [ 77, %leaf{3} ]", merged,
                         function.result, result, label));
        values_.push_back({merged, function.result});
    }

    void add_main() {
        code_ += "define void @main() {\n";
        values_.clear();
        for (const Declared& function : functions_) {
            for (const bool through_pointer : {false, true}) {
                call(function, through_pointer, fmt::format("{}", below(5)));
                const Value result = values_.back();
                const std::string name = fmt::format("r{}", results.size());
                globals_ += fmt::format("@{} = global i{} 0\n", name, result.bits);
                line(fmt::format("store i{} {}, ptr @{}", result.bits, result.name, name));
                results.push_back(name);
            }
        }
        code_ += "  ret void\n}\n";
    }

    std::mt19937_64 random_;
    std::string globals_;
    std::string code_;
    std::size_t entry_ = 0;  ///< in code_: where variables of the function are declared
    std::vector<Value> values_;
    std::vector<Declared> functions_;
    unsigned next_ = 0;
};

class RandomCalls : public testing::TestWithParam<codegen_test::NamedGenerator> {};

TEST_P(RandomCalls, AgreeWithTheInterpreter) {
    const char* wish = std::getenv("ROVER_CALL_SEED");
    const uint64_t first = wish == nullptr ? 1 : std::strtoull(wish, nullptr, 10);
    const uint64_t count = wish == nullptr ? 40 : 1;
    for (uint64_t seed = first; seed < first + count; ++seed) {
        SCOPED_TRACE(fmt::format("ROVER_CALL_SEED={}", seed));
        RandomProgram program(seed);
        const std::string text = program.text();
        const Module mir = ir_test::to_mir(text);
        codegen_test::Interpreter interpreter(mir);
        interpreter.call("main");
        CompileOptions options;
        options.allow_recursion = true;
        codegen_test::CompiledProgram compiled(GetParam().generator, mir, options);
        compiled.run();
        if (compiled.compiled().stack_known) {
            EXPECT_LE(compiled.deepest_stack(), compiled.compiled().stack_bytes);
        }
        for (const std::string& result : program.results) {
            const auto size = static_cast<unsigned>(compiled.program().find(result)->size);
            ASSERT_EQ(compiled.variable(result, size), interpreter.variable(result, size))
                << result << "\n"
                << text;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Generators, RandomCalls, testing::ValuesIn(codegen_test::generators()),
                         codegen_test::generator_name);

}  // namespace
