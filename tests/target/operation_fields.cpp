// operation_fields.cpp - the cases with bit-fields: random structs whose fields are set, read,
// changed and copied.
#include <fmt/format.h>

#include <array>
#include <random>

#include "tests/target/operation_table.hpp"

namespace target_test {

namespace {

using Maybe = std::optional<uint64_t>;

struct Field {
    IntType declared{};  ///< the type that stands in the declaration
    IntType value{};     ///< width of the field, with its sign
    unsigned from = 0;   ///< takes operand a from this bit on
};

struct Change {
    std::size_t field = 0;
    const char* operation = "";  ///< "+=" and so on, with operand b
};

constexpr std::array kChanges = {"+=", "-=", "^=", "&=", "|=", "*="};

uint64_t changed(const std::string& operation, uint64_t old, uint64_t by) {
    if (operation == "+=") return old + by;
    if (operation == "-=") return old - by;
    if (operation == "^=") return old ^ by;
    if (operation == "&=") return old & by;
    if (operation == "|=") return old | by;
    return old * by;
}

class FieldCase {
public:
    explicit FieldCase(uint64_t seed) : random_(seed) {
        const unsigned count = 3 + below(6);
        for (unsigned i = 0; i < count; ++i) {
            const unsigned declared = 8U << below(4);
            const bool is_signed = below(2) == 0;
            // A signed field of one bit holds 0 and -1.
            const unsigned bits = 1 + below(declared);
            fields_.push_back({{declared, is_signed}, {bits, is_signed}, below(40)});
        }
        for (unsigned i = 0; i < 4; ++i) changes_.push_back({below(count), kChanges[below(6)]});
    }

    [[nodiscard]] Case make(uint64_t seed) {
        const IntType operand{64, false};
        Case made{
            .name = fmt::format("bit-fields of seed {}", seed), .left = operand, .right = operand};
        made.text = structure() +
                    "static struct Fields_@ fields_@[2];\n"
                    "void case_@(void) {\n u64 a = in_a.u64, b = in_b.u64;\n"
                    " struct Fields_@ *p = &fields_@[b & 1];\n";
        for (std::size_t i = 0; i < fields_.size(); ++i) {
            made.text += fmt::format(" p->f{} = ({})(a >> {});\n", i, fields_[i].declared.c_name(),
                                     fields_[i].from);
        }
        for (const Change& change : changes_) {
            made.text += fmt::format(" p->f{} {} ({})b;\n", change.field, change.operation,
                                     fields_[change.field].declared.c_name());
        }
        made.text += " struct Fields_@ copy = *p;\n";
        for (std::size_t i = 0; i < fields_.size(); ++i) {
            const IntType type = fields_[i].declared;
            made.text += fmt::format(" out[{}].{} = copy.f{};\n", i, type.c_name(), i);
            made.outputs.push_back(
                {type,
                 [self = *this, i](uint64_t a, uint64_t b) -> Maybe { return self.after(i, a, b); },
                 fmt::format("field {} of {} bits", i, fields_[i].value.bits)});
        }
        made.text += "}\n";
        return made;
    }

private:
    unsigned below(unsigned limit) { return static_cast<unsigned>(random_() >> 33) % limit; }

    std::string structure() {
        std::string text = "struct Fields_@ {\n";
        unsigned run = 0;
        for (std::size_t i = 0; i < fields_.size(); ++i) {
            const Field& field = fields_[i];
            // Neighbours are packed into one number; of more than 128 bits it is refused.
            run += field.value.bits;
            const unsigned kind = run > 128 ? 0 : below(8);
            if (kind == 0) run = field.value.bits;
            if (kind == 0) text += " u8 between" + std::to_string(i) + ";\n";
            if (kind == 1) text += fmt::format(" {} : 0;\n", field.declared.c_name());
            text += fmt::format(" {} f{} : {};\n", field.declared.c_name(), i, field.value.bits);
        }
        return text + "};\n";
    }

    /// The field's value in its declared type. Arithmetic is modulo the field's width: whatever
    /// type C computes in is at least as wide.
    [[nodiscard]] uint64_t after(std::size_t index, uint64_t a, uint64_t b) const {
        const Field& field = fields_[index];
        uint64_t value = (a >> field.from) & field.declared.mask() & field.value.mask();
        for (const Change& change : changes_) {
            if (change.field != index) continue;
            value = static_cast<uint64_t>(field.value.number(value));
            value =
                changed(change.operation, value, b & field.declared.mask()) & field.value.mask();
        }
        return static_cast<uint64_t>(field.value.number(value)) & field.declared.mask();
    }

    std::mt19937_64 random_;
    std::vector<Field> fields_;
    std::vector<Change> changes_;
};

}  // namespace

std::vector<Case> field_cases(uint64_t first_seed, unsigned count) {
    std::vector<Case> cases;
    for (uint64_t seed = first_seed; seed < first_seed + count; ++seed) {
        cases.push_back(FieldCase(seed).make(seed));
    }
    return cases;
}

}  // namespace target_test
