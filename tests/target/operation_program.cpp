// operation_program.cpp - the program around the cases.
#include <fmt/format.h>

#include "tests/target/operation_table.hpp"

namespace target_test {

namespace {

/// The text with the case's number for every @ that does not begin a name of IR.
std::string numbered(const std::string& text, std::size_t number) {
    std::string result;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool stands_for_number = text[i] == '@' && i > 0 && text[i - 1] == '_';
        if (stands_for_number) {
            result += std::to_string(number);
        } else {
            result += text[i];
        }
    }
    return result;
}

std::string join(const std::vector<Case>& cases) {
    std::string text;
    for (std::size_t i = 0; i < cases.size(); ++i) text += numbered(cases[i].text, i);
    return text;
}

std::string c_types() {
    return fmt::format(R"(#include <stdbool.h>
#include <stdint.h>
typedef uint8_t u8; typedef uint16_t u16; typedef uint32_t u32; typedef uint64_t u64;
typedef int8_t s8; typedef int16_t s16; typedef int32_t s32; typedef int64_t s64;
union Slot {{ u8 u8; u16 u16; u32 u32; u64 u64; s8 s8; s16 s16; s32 s32; s64 s64; }};
extern volatile union Slot in_a, in_b, out[{}];
)",
                       kOutputSlots);
}

}  // namespace

std::string c_functions(const std::vector<Case>& cases) {
    return c_types() + join(cases);
}

std::string ir_functions(const std::vector<Case>& cases) {
    return "target datalayout = \"e-m:e-p:16:16-i32:16-i64:16-f32:16-f64:16-a:8-n8:16-S16\"\n"
           "target triple = \"msp430-none-unknown-elf\"\n"
           "@in_a = external global [8 x i8]\n@in_b = external global [8 x i8]\n"
           "@out = external global i8\n" +
           join(cases);
}

std::string c_main(std::size_t count) {
    std::string text = c_types();
    text += "volatile union Slot in_a, in_b, out[" + std::to_string(kOutputSlots) +
            "];\nvolatile u16 request;\nvoid __i85_hlt(void);\n";
    for (std::size_t i = 0; i < count; ++i) text += fmt::format("void case_{}(void);\n", i);
    text += "static void (*const table[])(void) = {";
    for (std::size_t i = 0; i < count; ++i) text += fmt::format("case_{}, ", i);
    return text + "};\nint main(void) { for (;;) { __i85_hlt(); table[request](); } }\n";
}

}  // namespace target_test
