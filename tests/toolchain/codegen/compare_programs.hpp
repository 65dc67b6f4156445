// compare_programs.hpp - a module by the interpreter and as machine code, and what differs; makes
// a failing module small.
// Depends on   random_functions.hpp, generated_program.hpp, interpreter.hpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

#include "tests/toolchain/codegen/random_functions.hpp"
#include "toolchain/codegen/builder.hpp"
#include "toolchain/codegen/generate.hpp"

namespace codegen_test {

struct CompareOptions {
    uint64_t seed = 1;  ///< of the contents of memory
    unsigned runs = 4;  ///< of each entry, with other contents each time
    bool search = true;
    double byte_cost = 1;
    uint64_t budget = 0;           ///< of the search
    uint64_t homes_by_chance = 0;  ///< a seed
    bool undocumented = false;     ///< instructions too
    bool ask_clobbers = true;      ///< callees' registers are known; else a call changes all
};

/// Empty if machine code and interpreter leave the same in memory; else what is different, or what
/// could not be translated.
[[nodiscard]] std::string difference(const RandomProgram& program, const CompareOptions& options);

/// Its code with addresses and T-states; empty if there is none.
[[nodiscard]] std::string listing(const RandomProgram& program, const CompareOptions& options);

/// A smaller program that is also different.
[[nodiscard]] RandomProgram shrink(RandomProgram program, const CompareOptions& options);

/// Makes a value of another in the first block of a function.
using Small = std::function<toolchain::codegen::Bytes(toolchain::codegen::Builder&,
                                                      const toolchain::codegen::Bytes&)>;

/// The machine's result, with and without search for registers, with and without undocumented
/// instructions. @errors std::runtime_error if these or the interpreter do not agree
[[nodiscard]] uint64_t run_small(uint64_t argument, std::size_t argument_size,
                                 std::size_t result_size, const Small& body);

}  // namespace codegen_test
