// driver.hpp - C and C++ sources to a linked 8085 program: the compiler as a function.
// Runs         clang-19 (found on PATH, or $I85CC_CLANG), then everything else in process:
//              join, ir::optimise, ir::prepare, ir::select, codegen::compile, assembly::link.
// Depends on   toolchain/ir, toolchain/codegen, toolchain/asm; no header of LLVM is needed here.
// Guide        docs/guides/compiling.md
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "toolchain/asm/link.hpp"
#include "toolchain/asm/program.hpp"
#include "toolchain/codegen/compile.hpp"
#include "toolchain/codegen/mir.hpp"
#include "toolchain/ir/prepare.hpp"

namespace toolchain::driver {

/// Why there is no program: one line or more, "file:line: what: what to do".
class Failed : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// A source file, or its text.
struct Source {
    std::string path{};  ///< as messages show it; .c is C, .ll and .bc are LLVM's, the rest C++
    std::optional<std::string> text{};  ///< instead of what the file contains
    /// Optimised as a module of its own; the optimiser does not see across. All others are one
    /// module, of which only main, interrupt functions and `keep` are visible from outside.
    bool separate = false;
};

struct Request {
    std::vector<Source> sources{};
    ir::Optimisation level = ir::Optimisation::size;
    std::vector<std::string> front_end{};  ///< -I -D -U -include -std= -W -f, for clang
    /// Functions and variables that stay though main does not reach them: by symbol, or demangled
    /// with or without parameters. Functions among them may be called by people (i85run --entry).
    std::vector<std::string> keep{};
    bool undocumented = false;  ///< the ten instructions that Intel left out may be used
    bool allow_recursion = false;
    bool allow_constructors = true;  ///< of static objects, at start-up
    bool small_runtime = false;      ///< products and quotients of words by loops
    bool table_multiply = false;     ///< products of bytes by a table of 512 bytes
    Steps steps{};                   ///< to be taken
    uint64_t search_budget = 0;      ///< for register homes: GenerateOptions; 0: by size
    double byte_cost = 1;            ///< T-states per execution that a byte of code is worth
    assembly::AddressRange rom = assembly::LinkOptions{}.rom;
    assembly::AddressRange ram = assembly::LinkOptions{}.ram;
    uint16_t vector_base = 0;               ///< LinkOptions: where the vectors stand
    std::optional<uint16_t> forward_to{};   ///< LinkOptions: the base of the program behind
    std::optional<uint32_t> stack_bytes{};  ///< nothing: the worst depth, see below
    bool verbose = false;                   ///< tells the commands that are run
    unsigned jobs = 2;                      ///< front ends at a time
    /// Takes clang's messages and our warnings; default: standard error.
    std::function<void(std::string_view)> messages{};
};

/// With recursion the worst depth is not known; this is kept then.
inline constexpr uint32_t kStackBytesOfRecursion = 512;

struct PhaseTime {
    std::string name{};
    double seconds = 0;
};

struct Result {
    assembly::Program program{};
    codegen::Compiled compiled{};  ///< call graph, frames, stack; `module` has been moved away
    std::vector<PhaseTime> times{};
};

/// @errors Failed. Nothing is written but a folder for temporary files, which is removed.
[[nodiscard]] Result compile_program(const Request& request);

/// The first half: what code generation is given. Needs no main.
/// @errors Failed
[[nodiscard]] codegen::Module compile_to_mir(const Request& request);

enum class Text : uint8_t {
    llvm,      ///< behind optimise() and prepare()
    mir,       ///< codegen::print
    assembly,  ///< the module before it is linked
};

/// The program at an inner stage, for people.
/// @errors Failed
[[nodiscard]] std::string compile_to_text(const Request& request, Text stage);

}  // namespace toolchain::driver
