// compile.hpp - a module of the back end's representation to sections that can be linked.
// Does         lower_calls, call graph, code of every function from the leaves up, static frames
//              overlaid by the call graph, copies for interrupts, worst stack depth.
// Depends on   mir.hpp, toolchain/asm.
#pragma once

#include <functional>
#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "toolchain/asm/object.hpp"
#include "toolchain/codegen/generate.hpp"
#include "toolchain/codegen/mir.hpp"

namespace toolchain::codegen {

/// A program that cannot be compiled: "file:line: what: what to do", a line each.
class Refused : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

struct CompileOptions {
    bool allow_recursion = false;
    bool search = true;          ///< look for register homes (off at -O0)
    uint64_t search_budget = 0;  ///< operations to translate at most for a function; 0: by size
    double byte_cost = 1;        ///< T-states per execution that a byte of code is worth
    bool undocumented = false;   ///< the instructions that Intel left out may be used
    Steps steps{};               ///< to be taken
    std::string main = "main";
    /// Called by people from outside (i85run --entry): kept, and roots beside main.
    std::vector<std::string> roots{};
};

/// What the call graph says about a function.
struct FunctionReport {
    std::string name{};
    uint32_t frame_bytes = 0;   ///< static frame, overlaid
    uint32_t frame_offset = 0;  ///< from the start of the overlay region
    uint32_t stack_bytes = 0;   ///< most that a call takes, callees included, return address not
    bool recursive = false;     ///< then stack_bytes holds for one activation
    std::vector<std::string> callees{};
};

struct Compiled {
    assembly::Module module{};  ///< code, data, frames; interrupt copies of runtime routines too
    std::vector<std::string> constructors{};    ///< in the order of their calls
    std::map<uint16_t, std::string> vectors{};  ///< of interrupt functions
    std::vector<FunctionReport> functions{};
    uint32_t stack_bytes = 0;  ///< worst depth: main (its return address included) plus interrupts
    bool stack_known = true;   ///< false: recursion
};

/// @param runtime  the library's modules: their calls and stack notes belong to the graph
/// @errors Refused: recursion (naming the cycle and its lines), a function with a frame that both
///         the main program and an interrupt reach through a pointer, a call of an interrupt
///         function, two of them for one vector
[[nodiscard]] Compiled compile(Module module, std::span<const assembly::Module> runtime,
                               const CompileOptions& options = {});

/// What makes code of one function: generate(), or a stand-in for tests.
using Generator =
    std::function<FunctionCode(const Module&, const Function&, const GenerateOptions&)>;

/// The same with another generator.
[[nodiscard]] Compiled compile_with(const Generator& generator, Module module,
                                    std::span<const assembly::Module> runtime,
                                    const CompileOptions& options = {});

}  // namespace toolchain::codegen
