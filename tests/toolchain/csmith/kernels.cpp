// kernels.cpp - see kernels.hpp.
#include "tests/toolchain/csmith/kernels.hpp"

#include <fmt/format.h>

#include <array>
#include <random>
#include <vector>

namespace csmith_test {

namespace {

struct Type {
    const char* name;
    const char* wide;  ///< unsigned, not narrower than int: arithmetic in it wraps
    unsigned bits;
    bool is_signed;
};
constexpr std::array<Type, 8> kTypes = {{{"uint8_t", "uint16_t", 8, false},
                                         {"int8_t", "uint16_t", 8, true},
                                         {"uint16_t", "uint16_t", 16, false},
                                         {"int16_t", "uint16_t", 16, true},
                                         {"uint32_t", "uint32_t", 32, false},
                                         {"int32_t", "uint32_t", 32, true},
                                         {"uint64_t", "uint64_t", 64, false},
                                         {"int64_t", "uint64_t", 64, true}}};
constexpr unsigned kLength = 16;  ///< of the arrays; a power of two, so that a mask keeps inside
constexpr unsigned kMostTurns = 200;

struct Variable {
    std::string name;
    const Type* type;
};

class KernelWriter {
public:
    explicit KernelWriter(uint64_t seed) : source_(seed) {
        types_ = below(4) == 0 ? kTypes.size() : kTypes.size() - 2;  // 64 bits: rarely
    }

    std::string run() {
        text_ = "#include \"csmith.h\"\n";
        for (std::size_t i = 0; i < types_; ++i) array(kTypes.at(i), i);
        const auto functions = 3 + static_cast<unsigned>(below(6));
        for (unsigned i = 0; i < functions; ++i) function(i);
        main();
        return text_;
    }

private:
    uint64_t below(uint64_t limit) { return source_() % limit; }
    const Type& type() { return kTypes.at(below(types_)); }
    void line(const std::string& text) { text_ += std::string(depth_ * 4, ' ') + text + "\n"; }

    std::string literal(const Type& type) {
        static constexpr std::array<uint64_t, 12> kCorners = {0,   1,   2,   3,     7,     8,
                                                              127, 128, 255, 32767, 65535, 65536};
        const uint64_t value = below(2) == 0 ? kCorners.at(below(kCorners.size())) : source_();
        const uint64_t mask = type.bits == 64 ? ~uint64_t{0} : (uint64_t{1} << type.bits) - 1;
        return fmt::format("({}){}u{}", type.name, value & mask,
                           type.bits == 64   ? "ll"
                           : type.bits == 32 ? "l"
                                             : "");
    }

    void array(const Type& type, std::size_t index) {
        std::string values;
        for (unsigned i = 0; i < kLength; ++i) values += literal(type) + ", ";
        line(fmt::format("static {} g_{}[{}] = {{{}}};", type.name, index, kLength, values));
    }

    // -- Expressions ------------------------------------------------------------------------------

    std::string element() {
        const auto which = below(types_);
        const auto& index = variables_.at(below(variables_.size()));
        switch (below(3)) {
            case 0:
                return fmt::format("g_{}[{}]", which, below(kLength));
            case 1:
                return fmt::format("g_{}[(uint8_t){} & {}]", which, index.name, kLength - 1);
            default:
                return fmt::format("g_{}[(uint8_t)({} + {}) & {}]", which, index.name,
                                   below(kLength), kLength - 1);
        }
    }

    std::string leaf(const Type& type) {
        switch (below(4)) {
            case 0:
                return literal(type);
            case 1:
                return fmt::format("({}){}", type.name, element());
            default:
                return fmt::format("({}){}", type.name,
                                   variables_.at(below(variables_.size())).name);
        }
    }

    std::string division(const Type& type, unsigned depth) {
        const std::string left = expression(type, depth - 1);
        const std::string right = leaf(type);
        const char* operation = below(2) == 0 ? "/" : "%";
        if (!type.is_signed)
            return fmt::format("({})({} {} ({} | 1))", type.name, left, operation, right);
        return fmt::format("safe_{}_func_{}_s_s({}, {})", *operation == '/' ? "div" : "mod",
                           type.name, left, right);
    }

    std::string condition(unsigned depth) {
        static constexpr std::array<const char*, 6> kCompare = {"==", "!=", "<", "<=", ">", ">="};
        const Type& operands = type();
        const std::string one = fmt::format("{} {} {}", expression(operands, depth),
                                            kCompare.at(below(kCompare.size())), leaf(operands));
        if (below(4) != 0) return one;
        return fmt::format("({}) {} ({} != 0)", one, below(2) == 0 ? "&&" : "||", leaf(type()));
    }

    /// Of exactly that type; arithmetic happens in the unsigned type, where it wraps.
    std::string expression(const Type& type, unsigned depth) {
        static constexpr std::array<const char*, 6> kWrapping = {"+", "-", "*", "&", "|", "^"};
        if (depth == 0) return leaf(type);
        switch (below(10)) {
            case 0:
                return division(type, depth);
            case 1: {
                const char* way = below(2) == 0 ? "<<" : ">>";
                const std::string operand = expression(type, depth - 1);
                const std::string count =
                    below(2) == 0 ? std::to_string(below(type.bits))
                                  : fmt::format("({} & {})", leaf(kTypes[0]), type.bits - 1);
                const char* as = *way == '<' ? type.wide : type.name;
                return fmt::format("({})(({}){} {} {})", type.name, as, operand, way, count);
            }
            case 2:
                return fmt::format("({} ? {} : {})", condition(depth - 1),
                                   expression(type, depth - 1), leaf(type));
            case 3:
                return fmt::format("({}){}", type.name, expression(this->type(), depth - 1));
            case 4:
                return fmt::format("({})({})", type.name, condition(depth - 1));
            default:
                return fmt::format("({})(({}){} {} ({}){})", type.name, type.wide,
                                   expression(type, depth - 1),
                                   kWrapping.at(below(kWrapping.size())), type.wide, leaf(type));
        }
    }

    // -- Statements -------------------------------------------------------------------------------

    /// Variables before `writable_` are counters: only their loop changes them.
    void assignment() {
        const uint64_t which = below(3);
        if (which == 0 || writable_.empty()) {
            const auto array = below(types_);
            line(fmt::format("g_{}[(uint8_t){} & {}] = {};", array,
                             variables_.at(below(variables_.size())).name, kLength - 1,
                             expression(kTypes.at(array), 2)));
            return;
        }
        const Variable& target = writable_.at(below(writable_.size()));
        line(fmt::format("{} = {};", target.name,
                         expression(*target.type, 1 + static_cast<unsigned>(below(3)))));
    }

    void body(unsigned statements) {
        ++depth_;
        for (unsigned i = 0; i < statements; ++i) statement();
        --depth_;
    }

    void loop() {
        static constexpr std::array<unsigned, 7> kTurns = {1, 2, 3, 4, 5, 8, 16};
        const unsigned turns = kTurns.at(below(kTurns.size()));
        if (turns_ * turns > kMostTurns) return assignment();
        turns_ *= turns;
        const std::size_t before = variables_.size();
        const Type& counter = kTypes.at(below(4));
        const std::string name = fmt::format("i{}", next_++);
        const unsigned step = 1 + static_cast<unsigned>(below(3));
        switch (below(5)) {
            case 0:  // upwards
                line(fmt::format("for ({0} {1} = 0; {1} < {2}; {1} += {3}) {{", counter.name, name,
                                 turns * step, step));
                break;
            case 1:  // downwards to 0
                line(fmt::format("for ({0} {1} = {2}; {1} > 0; --{1}) {{", counter.name, name,
                                 turns));
                break;
            case 2:  // downwards through 0: an unsigned counter wraps
                line(fmt::format("for ({0} {1} = {2}; {1} != ({0})-1; --{1}) {{", counter.name,
                                 name, turns - 1));
                break;
            case 3: {  // a pointer that walks
                const auto array = below(types_);
                line(fmt::format("for ({0}* p{1} = g_{2}; p{1} != g_{2} + {3}; ++p{1}) {{",
                                 kTypes.at(array).name, name, array, turns));
                line(fmt::format("    {} {} = *p{};", kTypes.at(array).name, name, name));
                if (below(2) == 0) {
                    variables_.push_back({name, &kTypes.at(array)});
                    line(fmt::format("    *p{} = {};", name, expression(kTypes.at(array), 2)));
                    variables_.pop_back();
                }
                break;
            }
            default:  // to a bound known at run time only
                line(fmt::format("for ({0} {1} = 0, end = ({0})({2} & {3}); {1} < end; ++{1}) {{",
                                 counter.name, name, leaf(kTypes[0]), turns - 1));
        }
        variables_.push_back({name, &counter});
        body(1 + static_cast<unsigned>(below(3)));
        if (below(4) == 0) line(fmt::format("    if ({}) break;", condition(1)));
        variables_.resize(before);
        line("}");
        turns_ /= turns;
    }

    void choice() {
        if (below(3) != 0) {
            line(fmt::format("if ({}) {{", condition(2)));
            body(1 + static_cast<unsigned>(below(2)));
            if (below(2) == 0) {
                line("} else {");
                body(1 + static_cast<unsigned>(below(2)));
            }
            line("}");
            return;
        }
        line(fmt::format("switch ((uint8_t){} & 7) {{", expression(type(), 1)));
        const unsigned cases = 2 + static_cast<unsigned>(below(6));
        for (unsigned i = 0; i < cases; ++i) {
            line(fmt::format("case {}:", i));
            body(1);
            if (below(4) != 0) line("    break;");
        }
        line("default:");
        body(1);
        line("}");
    }

    void statement() {
        const uint64_t which = depth_ > 4 ? 9 : below(10);
        if (which < 2) {
            loop();
        } else if (which < 4) {
            choice();
        } else if (which == 4 && !functions_.empty()) {
            const std::string call = call_of(below(functions_.size()));
            if (writable_.empty() || turns_ > 4) return assignment();
            const Variable& target = writable_.at(below(writable_.size()));
            line(fmt::format("{} = ({}){};", target.name, target.type->name, call));
        } else {
            assignment();
        }
    }

    // -- Functions --------------------------------------------------------------------------------

    struct Signature {
        std::vector<const Type*> parameters;
    };

    std::string call_of(std::size_t which) {
        std::string arguments;
        for (const Type* parameter : functions_.at(which).parameters) {
            if (!arguments.empty()) arguments += ", ";
            arguments += leaf(*parameter);
        }
        return fmt::format("f_{}({})", which, arguments);
    }

    void function(unsigned index) {
        variables_.clear();
        writable_.clear();
        Signature signature;
        std::string parameters;
        const unsigned count = 1 + static_cast<unsigned>(below(4));
        for (unsigned i = 0; i < count; ++i) {
            const Type& chosen = type();
            signature.parameters.push_back(&chosen);
            variables_.push_back({fmt::format("a{}", i), &chosen});
            parameters += fmt::format("{}{} a{}", i == 0 ? "" : ", ", chosen.name, i);
        }
        const Type& result = type();
        const bool apart = below(2) == 0;
        line(fmt::format("{}static {} f_{}({}) {{", apart ? "__attribute__((noinline)) " : "",
                         result.name, index, parameters));
        ++depth_;
        const unsigned locals = 1 + static_cast<unsigned>(below(4));
        for (unsigned i = 0; i < locals; ++i) {
            const Type& chosen = type();
            line(fmt::format("{} v{} = {};", chosen.name, i, leaf(chosen)));
            variables_.push_back({fmt::format("v{}", i), &chosen});
        }
        writable_ = variables_;
        --depth_;
        body(2 + static_cast<unsigned>(below(5)));
        line(fmt::format("    return {};", expression(result, 2)));
        line("}");
        functions_.push_back(signature);
    }

    void main() {
        text_ += "int main(void) {\n    int i;\n    platform_main_begin();\n    crc32_gentab();\n";
        variables_ = {{"i", &kTypes[3]}};
        depth_ = 2;
        text_ += fmt::format("    for (i = 0; i < {}; ++i) {{\n", kRounds);
        for (std::size_t i = 0; i < functions_.size(); ++i) {
            line(fmt::format("transparent_crc((uint64_t){}, \"f_{}\", 0);", call_of(i), i));
        }
        text_ += "    }\n";
        for (std::size_t i = 0; i < types_; ++i) {
            line(
                fmt::format("for (i = 0; i < {}; ++i) transparent_crc((uint64_t)g_{}[i], \"\", 0);",
                            kLength, i));
        }
        text_ += "    platform_main_end(crc32_context ^ 0xFFFFFFFFUL, 0);\n    return 0;\n}\n";
    }

    static constexpr unsigned kRounds = 3;  ///< calls of each function from main

    std::mt19937_64 source_;
    std::size_t types_ = 0;
    std::string text_;
    std::size_t depth_ = 0;
    unsigned turns_ = 1;
    unsigned next_ = 0;
    std::vector<Variable> variables_;  ///< readable
    std::vector<Variable> writable_;
    std::vector<Signature> functions_;
};

}  // namespace

std::string kernel_program(uint64_t seed) {
    return KernelWriter(seed).run();
}

}  // namespace csmith_test
