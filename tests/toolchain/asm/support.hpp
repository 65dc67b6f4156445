// support.hpp - what the assembler's tests share.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "toolchain/asm/link.hpp"
#include "toolchain/asm/parse.hpp"

namespace asm_test {

using toolchain::assembly::Error;
using toolchain::assembly::LinkOptions;
using toolchain::assembly::Module;
using toolchain::assembly::Program;
using toolchain::assembly::Symbol;
using Bytes = std::vector<uint8_t>;

/// The messages of the Error that `step` throws, or "accepted".
template <typename Step>
std::string errors_of(Step step) {
    try {
        step();
    } catch (const Error& error) {
        return error.what();
    }
    return "accepted";
}

/// A source as file t.s85.
inline Module module_of(std::string_view source) {
    return toolchain::assembly::parse(source, {"t.s85"});
}

inline Program linked(std::string_view source, const LinkOptions& options = {}) {
    return toolchain::assembly::link({module_of(source)}, options);
}

inline LinkOptions rooted(std::initializer_list<std::string> roots) {
    LinkOptions options;
    options.roots = roots;
    return options;
}

inline Bytes bytes_at(const Program& program, std::size_t address, std::size_t size) {
    const auto first = program.image.bytes.begin() + static_cast<std::ptrdiff_t>(address);
    return {first, first + static_cast<std::ptrdiff_t>(size)};
}

/// The value of a name, or -1.
inline int value_of(const Program& program, std::string_view name) {
    const Symbol* symbol = program.find(name);
    return symbol == nullptr ? -1 : symbol->value;
}

}  // namespace asm_test
