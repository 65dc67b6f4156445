// print.hpp - items and modules as assembly source that parse() reads.
// Depends on   toolchain/isa.
#pragma once

#include <string>

#include "toolchain/asm/object.hpp"

namespace toolchain::assembly {

/// An item without label and address: "LDA   state+1", "DB    01H,02H". Empty for labels and notes.
[[nodiscard]] std::string item_text(const Item& item);

/// A module as source. Not said in source are: where things come from, and kinds and sizes of
/// labels.
[[nodiscard]] std::string source_text(const Module& module);

}  // namespace toolchain::assembly
