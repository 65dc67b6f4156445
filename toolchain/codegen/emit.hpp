// emit.hpp - functions and variables as sections of the assembler.
// Depends on   machine.hpp, names.hpp, toolchain/asm/object.hpp.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "toolchain/asm/object.hpp"
#include "toolchain/codegen/machine.hpp"
#include "toolchain/codegen/mir.hpp"
#include "toolchain/codegen/names.hpp"

namespace toolchain::codegen {

/// Label of a function's slots.
[[nodiscard]] std::string frame_label(const std::string& function);

/// The code of a function, jump tables included.
[[nodiscard]] assembly::Section code_section(const Module& module, const SafeNames& names,
                                             const Function& function, const FunctionCode& code);

/// Where the parts of a static frame are: FrameObjects, the most aligned ones first, then slots.
struct FrameLayout {
    std::vector<const FrameObject*> objects{};
    std::vector<uint32_t> offsets{};  ///< of the objects
    uint32_t alignment = 1;
    uint32_t size = 0;
};

[[nodiscard]] FrameLayout frame_layout(const Function& function, const FunctionCode& code);

/// Its static frame. May have no bytes.
[[nodiscard]] assembly::Section frame_section(const SafeNames& names, const Function& function,
                                              const FunctionCode& code);

/// Constants in ROM, initialised and cleared variables in RAM.
[[nodiscard]] assembly::Section variable_section(const Module& module, const SafeNames& names,
                                                 const Variable& variable);

}  // namespace toolchain::codegen
