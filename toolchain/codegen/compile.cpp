// compile.cpp - see compile.hpp: compile_with() and the real generator.
#include "toolchain/codegen/compile.hpp"

#include <utility>

namespace toolchain::codegen {

Compiled compile(Module module, std::span<const assembly::Module> runtime,
                 const CompileOptions& options) {
    return compile_with(generate, std::move(module), runtime, options);
}

}  // namespace toolchain::codegen
