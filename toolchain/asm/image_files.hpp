// image_files.hpp - a program's bytes as Intel HEX and BIN.
// Source       Intel Hexadecimal Object File Format Specification, revision A (1988).
#pragma once

#include <string>

#include "toolchain/asm/program.hpp"

namespace toolchain::assembly {

/// Records 00 of up to 16 bytes, a record 05 with the start address if there is one, record 01.
[[nodiscard]] std::string write_hex(const Program& program);

/// From the start of ROM to its highest byte, FF in between. Bytes outside of ROM are left out.
[[nodiscard]] std::string write_bin(const Program& program);

}  // namespace toolchain::assembly
