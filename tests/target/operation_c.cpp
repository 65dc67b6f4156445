// operation_c.cpp - the cases in C, and the program around them.
#include <fmt/format.h>

#include <array>
#include <bit>

#include "tests/target/operation_table.hpp"

namespace target_test {

namespace {

using Maybe = std::optional<uint64_t>;

struct Form {
    const char* name;
    const char* c;  ///< {0} and {1} are the operands
};

/// Written as people write them; clang makes minimum, rotation and so on of some.
constexpr std::array kBinary = {
    Form{"add", "{0} + {1}"},
    Form{"sub", "{0} - {1}"},
    Form{"mul", "{0} * {1}"},
    Form{"div", "{0} / {1}"},
    Form{"rem", "{0} % {1}"},
    Form{"and", "{0} & {1}"},
    Form{"or", "{0} | {1}"},
    Form{"xor", "{0} ^ {1}"},
    Form{"shl", "{0} << {1}"},
    Form{"shr", "{0} >> {1}"},
    Form{"min", "{0} < {1} ? {0} : {1}"},
    Form{"max", "__builtin_elementwise_max({0}, {1})"},
    Form{"addsat", "__builtin_elementwise_add_sat({0}, {1})"},
    Form{"subsat", "__builtin_elementwise_sub_sat({0}, {1})"},
};

constexpr const char* kComparisons =
    "({0} == {1} ? 1 : 0) | ({0} != {1} ? 2 : 0) | ({0} < {1} ? 4 : 0) | ({0} <= {1} ? 8 : 0) | "
    "({0} > {1} ? 16 : 0) | ({0} >= {1} ? 32 : 0)";
constexpr const char* kBranches =
    "u8 r = 0; if ({0} == {1}) r |= 1; if ({0} != {1}) r |= 2; if ({0} < {1}) r |= 4; "
    "if ({0} <= {1}) r |= 8; if ({0} > {1}) r |= 16; if ({0} >= {1}) r |= 32; return r;";

constexpr IntType kByte{8, false};

std::string constant(IntType type, uint64_t value) {
    return fmt::format("(({})0x{:X}ULL)", type.c_name(), value);
}

std::string input(char slot, IntType type) {
    return fmt::format("in_{}.{}", slot, type.c_name());
}

std::string insert(const char* form, const std::string& a, const std::string& b) {
    return fmt::format(fmt::runtime(form), a, b);
}

std::string result_of(IntType type, const Form& form, const std::string& a, const std::string& b) {
    return fmt::format("({})({})", type.c_name(), insert(form.c, a, b));
}

Expected evaluation(const std::string& name, IntType type) {
    return [=](uint64_t a, uint64_t b) { return evaluate(name, type, a, b); };
}

/// A function of its own with the operation, called by the case with operands from memory.
/// @param body  of that function; its parameters are a and b
Case at_run_time(const std::string& name, IntType type, IntType result, const std::string& body,
                 Expected expected) {
    Case made{.name = name + " " + type.c_name(), .left = type, .right = type};
    made.text = fmt::format(
        "static __attribute__((noinline)) {0} op_@({1} a, {1} b) {{ {2} }}\n"
        "void case_@(void) {{ out[0].{0} = op_@({3}, {4}); }}\n",
        result.c_name(), type.c_name(), body, input('a', type), input('b', type));
    made.outputs = {{result, std::move(expected), name}};
    return made;
}

/// Constants that selection treats differently: all shift counts, else corners.
std::vector<uint64_t> constants_for(const std::string& name, IntType type) {
    std::vector<uint64_t> values;
    if (name == "shl" || name == "shr") {
        for (unsigned count = 0; count < type.bits; ++count) values.push_back(count);
        return values;
    }
    const std::vector<uint64_t> all = corners(type);
    // Wide ones take much room: every second, every third, an odd step to meet all kinds.
    const std::size_t step = type.bits <= 16 ? 1 : type.bits == 32 ? 2 : 3;
    for (std::size_t i = 0; i < all.size(); i += step) {
        const bool by_zero = (name == "div" || name == "rem") && all[i] == 0;
        if (!by_zero) values.push_back(all[i]);
    }
    if (values.back() != type.mask()) values.push_back(type.mask());
    return values;
}

/// Many results in one function: a OP constant, or constant OP b.
Case with_constants(const Form& form, IntType type, bool on_the_left) {
    const std::string name = form.name;
    const bool divides = name == "div" || name == "rem";
    const uint64_t least = uint64_t{1} << (type.bits - 1);
    const std::string variable = on_the_left ? "b" : "a";
    Case made{.name = fmt::format("{} {} constant {}", name, type.c_name(),
                                  on_the_left ? "left" : "right"),
              .left = type,
              .right = type,
              .unary = !on_the_left};
    made.text = fmt::format("void case_@(void) {{ {} {} = {};\n", type.c_name(), variable,
                            input(variable[0], type));
    for (const uint64_t value : constants_for(on_the_left ? "add" : name, type)) {
        // The least number divided by -1 is undefined: not computed.
        const uint64_t excluded = on_the_left ? type.mask() : least;
        const bool guarded =
            divides && type.is_signed && value == (on_the_left ? least : type.mask());
        const std::string number = constant(type, value);
        made.text += fmt::format(
            "{}out[{}].{} = {};\n",
            guarded ? fmt::format("if ({} != {}) ", variable, constant(type, excluded)) : "",
            made.outputs.size(), type.c_name(),
            on_the_left ? result_of(type, form, number, "b") : result_of(type, form, "a", number));
        made.outputs.push_back({type,
                                [=](uint64_t a, uint64_t b) -> Maybe {
                                    if (guarded && (on_the_left ? b : a) == excluded) return {};
                                    return on_the_left ? evaluate(name, type, value, b)
                                                       : evaluate(name, type, a, value);
                                },
                                fmt::format("{}, constant {:X}", name, value)});
    }
    made.text += "}\n";
    return made;
}

void add_binary(std::vector<Case>& cases, IntType type) {
    for (const Form& form : kBinary) {
        const std::string name = form.name;
        // C computes 8 bits in int, which does not saturate there; the table in IR has them.
        if (type.bits == 8 && name.ends_with("sat")) continue;
        cases.push_back(at_run_time(name, type, type,
                                    "return " + result_of(type, form, "a", "b") + ";",
                                    evaluation(name, type)));
        cases.push_back(with_constants(form, type, false));
        if (name == "sub" || name == "div" || name == "rem" || name == "shl" || name == "shr") {
            cases.push_back(with_constants(form, type, true));
        }
    }
    for (const char* name : {"add", "sub", "mul"}) {
        cases.push_back(at_run_time(
            std::string(name) + "ov", type, type,
            fmt::format(
                "{0} r; bool o = __builtin_{1}_overflow(a, b, &r); return ({0})(r ^ ({0})o);",
                type.c_name(), name),
            evaluation(std::string(name) + "ov", type)));
    }
}

void add_comparisons(std::vector<Case>& cases, IntType type) {
    cases.push_back(at_run_time("cmp", type, kByte,
                                "return " + insert(kComparisons, "a", "b") + ";",
                                evaluation("cmp", type)));
    cases.push_back(
        at_run_time("cmpbr", type, kByte, insert(kBranches, "a", "b"), evaluation("cmp", type)));
    Case constants{
        .name = "cmp " + type.c_name() + " constant", .left = type, .right = type, .unary = true};
    std::string functions;
    constants.text =
        fmt::format("void case_@(void) {{ {} a = {};\n", type.c_name(), input('a', type));
    for (const uint64_t value : constants_for("cmp", type)) {
        const std::size_t index = constants.outputs.size();
        functions +=
            fmt::format("static __attribute__((noinline)) u8 op{}_@({} a) {{ {} }}\n", index,
                        type.c_name(), insert(kBranches, "a", constant(type, value)));
        constants.text += fmt::format("out[{0}].u8 = op{0}_@(a);\n", index);
        constants.outputs.push_back(
            {kByte, [=](uint64_t a, uint64_t) { return evaluate("cmp", type, a, value); },
             fmt::format("compare with {:X}", value)});
    }
    constants.text = functions + constants.text + "}\n";
    cases.push_back(std::move(constants));
}

/// Result of the same type from one operand.
void add_unary(std::vector<Case>& cases, IntType type) {
    Case made{.name = "unary " + type.c_name(), .left = type, .right = type, .unary = true};
    made.text = fmt::format("void case_@(void) {{ {} a = {};\n", type.c_name(), input('a', type));
    const auto add = [&](IntType result, const std::string& text,
                         std::function<uint64_t(uint64_t)> give) {
        made.text += fmt::format("out[{}].{} = ({})({});\n", made.outputs.size(), result.c_name(),
                                 result.c_name(), text);
        made.outputs.push_back(
            {result, [=](uint64_t a, uint64_t) -> Maybe { return give(a) & result.mask(); }, text});
    };
    const unsigned bits = type.bits;
    add(type, "-a", [](uint64_t a) { return -a; });
    add(type, "~a", [](uint64_t a) { return ~a; });
    add(kByte, "!a", [](uint64_t a) { return a == 0 ? 1U : 0U; });
    add(kByte, "(bool)a", [](uint64_t a) { return a != 0 ? 1U : 0U; });
    if (type.is_signed) {
        add(type, "a < 0 ? -a : a", [=](uint64_t a) { return type.number(a) < 0 ? -a : a; });
        add(type, "__builtin_elementwise_abs(a)",
            [=](uint64_t a) { return type.number(a) < 0 ? -a : a; });
    } else {
        const auto wide = [=](uint64_t a) { return a & type.mask(); };
        add(kByte, "__builtin_popcountg(a)",
            [=](uint64_t a) { return static_cast<uint64_t>(std::popcount(wide(a))); });
        add(kByte, fmt::format("__builtin_clzg(a, {})", bits), [=](uint64_t a) {
            return static_cast<uint64_t>(std::countl_zero(wide(a))) - (64 - bits);
        });
        add(kByte, fmt::format("__builtin_ctzg(a, {})", bits), [=](uint64_t a) {
            return wide(a) == 0 ? bits : static_cast<uint64_t>(std::countr_zero(a));
        });
        add(type, fmt::format("__builtin_bitreverse{}(a)", bits), [=](uint64_t a) {
            uint64_t reversed = 0;
            for (unsigned i = 0; i < bits; ++i) reversed |= (a >> i & 1) << (bits - 1 - i);
            return reversed;
        });
        if (bits > 8) {
            add(type, fmt::format("__builtin_bswap{}(a)", bits), [=](uint64_t a) {
                uint64_t swapped = 0;
                for (unsigned i = 0; i < bits; i += 8) swapped |= (a >> i & 0xFF) << (bits - 8 - i);
                return swapped;
            });
        }
        for (unsigned count = 1; count < bits; count += bits / 8 + 1) {
            add(type, fmt::format("a << {} | a >> {}", count, bits - count),
                [=](uint64_t a) { return *evaluate("rotl", type, a, count); });
        }
    }
    made.text += "}\n";
    cases.push_back(std::move(made));
    if (type.is_signed) return;
    for (const char* way : {"left", "right"}) {
        const std::string name = std::string("rot") + way[0];
        cases.push_back(at_run_time(name, type, type,
                                    fmt::format("return __builtin_rotate{}{}(a, b);", way, bits),
                                    evaluation(name, type)));
    }
}

/// To every C type.
void add_casts(std::vector<Case>& cases, IntType type) {
    Case made{.name = "casts " + type.c_name(), .left = type, .right = type, .unary = true};
    made.text = fmt::format("void case_@(void) {{ {} a = {};\n", type.c_name(), input('a', type));
    for (const unsigned bits : {8U, 16U, 32U, 64U}) {
        for (const bool is_signed : {false, true}) {
            const IntType to{bits, is_signed};
            made.text +=
                fmt::format("out[{}].{} = ({})a;\n", made.outputs.size(), to.c_name(), to.c_name());
            made.outputs.push_back({to,
                                    [=](uint64_t a, uint64_t) -> Maybe {
                                        return static_cast<uint64_t>(type.number(a)) & to.mask();
                                    },
                                    "to " + to.c_name()});
        }
    }
    made.text += "}\n";
    cases.push_back(std::move(made));
}

}  // namespace

std::vector<Case> c_cases(const std::vector<unsigned>& widths) {
    std::vector<Case> cases;
    for (const unsigned bits : widths) {
        for (const bool is_signed : {false, true}) {
            const IntType type{bits, is_signed};
            add_binary(cases, type);
            add_comparisons(cases, type);
            add_unary(cases, type);
            add_casts(cases, type);
        }
    }
    return cases;
}

}  // namespace target_test
