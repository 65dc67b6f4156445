// operation_ir.cpp - the cases in LLVM IR: widths that C does not have, which LLVM's own passes and
// bit-fields make.
#include <fmt/format.h>

#include <array>
#include <bit>

#include "tests/target/operation_table.hpp"

namespace target_test {

namespace {

using Maybe = std::optional<uint64_t>;

struct Form {
    const char* ir;    ///< instruction or intrinsic
    const char* name;  ///< for evaluate()
    bool is_signed;
    bool intrinsic = false;
};

constexpr std::array kForms = {
    Form{"add", "add", false},
    Form{"sub", "sub", false},
    Form{"mul", "mul", false},
    Form{"udiv", "div", false},
    Form{"sdiv", "div", true},
    Form{"urem", "rem", false},
    Form{"srem", "rem", true},
    Form{"and", "and", false},
    Form{"or", "or", false},
    Form{"xor", "xor", false},
    Form{"shl", "shl", false},
    Form{"lshr", "shr", false},
    Form{"ashr", "shr", true},
    Form{"umin", "min", false, true},
    Form{"umax", "max", false, true},
    Form{"smin", "min", true, true},
    Form{"smax", "max", true, true},
    Form{"uadd.sat", "addsat", false, true},
    Form{"sadd.sat", "addsat", true, true},
    Form{"usub.sat", "subsat", false, true},
    Form{"ssub.sat", "subsat", true, true},
};

struct Predicate {
    const char* name;
    unsigned bit;  ///< of evaluate("cmp")
    bool is_signed;
};
constexpr std::array kPredicates = {
    Predicate{"eq", 0, false},  Predicate{"ne", 1, false},  Predicate{"ult", 2, false},
    Predicate{"ule", 3, false}, Predicate{"ugt", 4, false}, Predicate{"uge", 5, false},
    Predicate{"slt", 2, true},  Predicate{"sle", 3, true},  Predicate{"sgt", 4, true},
    Predicate{"sge", 5, true},
};

constexpr IntType kByte{8, false};

/// A function's lines; values are numbered as they are made.
class Lines {
public:
    explicit Lines(const std::string& head) : text_(head) {}
    std::string value(const std::string& text) {
        const std::string name = fmt::format("%v{}", next_++);
        text_ += fmt::format("  {} = {}\n", name, text);
        return name;
    }
    void line(const std::string& text) { text_ += "  " + text + "\n"; }
    void label(const std::string& name) { text_ += name + ":\n"; }
    std::string load(IntType type, char slot) {
        return value(fmt::format("load volatile {}, ptr @in_{}", type.ir_name(), slot));
    }
    void store(IntType type, const std::string& what, std::size_t slot) {
        line(fmt::format("store volatile {} {}, ptr getelementptr (i8, ptr @out, i16 {})",
                         type.ir_name(), what, 8 * slot));
    }
    [[nodiscard]] std::string finish() const { return text_ + "  ret void\n}\n"; }

private:
    std::string text_;
    unsigned next_ = 0;
};

std::string instruction(const Form& form, IntType type, const std::string& a,
                        const std::string& b) {
    if (!form.intrinsic) return fmt::format("{} {} {}, {}", form.ir, type.ir_name(), a, b);
    return fmt::format("call {0} @llvm.{1}.{0}({0} {2}, {0} {3})", type.ir_name(), form.ir, a, b);
}

Case blank(const std::string& name, IntType type) {
    return {.name = name + " " + type.ir_name(), .left = type, .right = type};
}

/// The operation in a function that gets its operands as arguments.
Case at_run_time(const Form& form, IntType type) {
    const IntType with_sign{type.bits, form.is_signed};
    const std::string name = form.name;
    Case made = blank(form.ir, type);
    Lines lines("define void @case_@() {\n");
    const std::string a = lines.load(type, 'a');
    const std::string b = lines.load(type, 'b');
    const std::string result =
        lines.value(fmt::format("call {0} @op_@({0} {1}, {0} {2})", type.ir_name(), a, b));
    lines.store(type, result, 0);
    made.text = lines.finish() + fmt::format(
                                     "define internal {0} @op_@({0} %a, {0} %b) noinline {{\n"
                                     "  %r = {1}\n  ret {0} %r\n}}\n",
                                     type.ir_name(), instruction(form, type, "%a", "%b"));
    made.outputs = {
        {with_sign, [=](uint64_t x, uint64_t y) { return evaluate(name, with_sign, x, y); }, name}};
    return made;
}

/// a OP constant. For -1 as signed divisor the operand is kept off the least number.
Case with_constants(const Form& form, IntType type) {
    const IntType with_sign{type.bits, form.is_signed};
    const std::string name = form.name;
    const bool divides = name == "div" || name == "rem";
    const bool shifts = name == "shl" || name == "shr";
    Case made = blank(std::string(form.ir) + " constant", type);
    made.unary = true;
    Lines lines("define void @case_@() {\n");
    const std::string a = lines.load(type, 'a');
    const std::vector<uint64_t> all = corners(type);
    for (std::size_t i = 0; i < all.size(); i += all.size() / 6 + 1) {
        const uint64_t value = shifts ? i % type.bits : all[i];
        if (divides && (value == 0 || (form.is_signed && value == type.mask()))) continue;
        const std::string number =
            type.bits == 1 ? (value == 0 ? "false" : "true") : fmt::format("{}", value);
        lines.store(type, lines.value(instruction(form, type, a, number)), made.outputs.size());
        made.outputs.push_back(
            {with_sign, [=](uint64_t x, uint64_t) { return evaluate(name, with_sign, x, value); },
             fmt::format("{} {:X}", form.ir, value)});
    }
    made.text = lines.finish();
    return made;
}

/// Every predicate as a value and as a branch.
Case comparisons(IntType type) {
    Case made = blank("icmp", type);
    Lines lines("define void @case_@() {\n");
    const std::string a = lines.load(type, 'a');
    const std::string b = lines.load(type, 'b');
    for (const Predicate& predicate : kPredicates) {
        const std::string bit =
            lines.value(fmt::format("icmp {} {} {}, {}", predicate.name, type.ir_name(), a, b));
        lines.store(kByte, lines.value("zext i1 " + bit + " to i8"), made.outputs.size());
        const Expected expected = [=](uint64_t x, uint64_t y) -> Maybe {
            const IntType with_sign{type.bits, predicate.is_signed};
            return *evaluate("cmp", with_sign, x, y) >> predicate.bit & 1;
        };
        made.outputs.push_back({kByte, expected, predicate.name});
        const std::size_t slot = made.outputs.size();
        const std::string again =
            lines.value(fmt::format("icmp {} {} {}, {}", predicate.name, type.ir_name(), a, b));
        lines.line(fmt::format("br i1 {0}, label %yes{1}, label %no{1}", again, slot));
        for (const char* way : {"yes", "no"}) {
            lines.label(fmt::format("{}{}", way, slot));
            lines.store(kByte, way[0] == 'y' ? "1" : "0", slot);
            lines.line(fmt::format("br label %end{}", slot));
        }
        lines.label(fmt::format("end{}", slot));
        made.outputs.push_back({kByte, expected, std::string("branch on ") + predicate.name});
    }
    made.text = lines.finish();
    return made;
}

Case casts(IntType type, const std::vector<unsigned>& widths) {
    Case made = blank("casts", type);
    made.unary = true;
    Lines lines("define void @case_@() {\n");
    const std::string a = lines.load(type, 'a');
    const auto add = [&](const char* cast, IntType to, bool is_signed) {
        lines.store(
            to, lines.value(fmt::format("{} {} {} to {}", cast, type.ir_name(), a, to.ir_name())),
            made.outputs.size());
        const IntType from{type.bits, is_signed};
        made.outputs.push_back({to,
                                [=](uint64_t x, uint64_t) -> Maybe {
                                    return static_cast<uint64_t>(from.number(x)) & to.mask();
                                },
                                fmt::format("{} to {}", cast, to.ir_name())});
    };
    for (const unsigned bits : widths) {
        if (bits < type.bits) add("trunc", {bits, false}, false);
        if (bits > type.bits) add("zext", {bits, false}, false);
        if (bits > type.bits) add("sext", {bits, false}, true);
    }
    made.text = lines.finish();
    return made;
}

/// Counts of bits and the absolute value.
Case unary(IntType type) {
    Case made = blank("bit counts", type);
    made.unary = true;
    Lines lines("define void @case_@() {\n");
    const std::string a = lines.load(type, 'a');
    const auto add = [&](const std::string& intrinsic, const char* flag,
                         std::function<uint64_t(uint64_t)> give) {
        lines.store(type,
                    lines.value(fmt::format("call {0} @llvm.{1}.{0}({0} {2}{3})", type.ir_name(),
                                            intrinsic, a, flag)),
                    made.outputs.size());
        made.outputs.push_back(
            {type, [=](uint64_t x, uint64_t) -> Maybe { return give(x) & type.mask(); },
             intrinsic});
    };
    const unsigned bits = type.bits;
    add("ctpop", "", [](uint64_t x) { return static_cast<uint64_t>(std::popcount(x)); });
    add("ctlz", ", i1 false",
        [=](uint64_t x) { return static_cast<uint64_t>(std::countl_zero(x)) - (64 - bits); });
    add("cttz", ", i1 false",
        [=](uint64_t x) { return x == 0 ? bits : static_cast<uint64_t>(std::countr_zero(x)); });
    add("abs", ", i1 false",
        [=](uint64_t x) { return (x >> (bits - 1) & 1) != 0 ? uint64_t{0} - x : x; });
    made.text = lines.finish();
    return made;
}

}  // namespace

std::vector<Case> ir_cases(const std::vector<unsigned>& widths) {
    std::vector<Case> cases;
    for (const unsigned bits : widths) {
        const IntType type{bits, false};
        for (const Form& form : kForms) {
            cases.push_back(at_run_time(form, type));
            cases.push_back(with_constants(form, type));
        }
        cases.push_back(comparisons(type));
        std::vector<unsigned> others = {8, 16, 32, 64};
        others.insert(others.end(), widths.begin(), widths.end());
        cases.push_back(casts(type, others));
        cases.push_back(unary(type));
    }
    return cases;
}

}  // namespace target_test
