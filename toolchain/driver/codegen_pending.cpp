// codegen_pending.cpp - stands in for codegen::compile() until it is there.
#include "toolchain/codegen/compile.hpp"

namespace toolchain::codegen {

Compiled compile(Module /*module*/, std::span<const assembly::Module> /*runtime*/,
                 const CompileOptions& /*options*/) {
    throw Refused("code generation is not there yet: --emit=mir shows what it will be given");
}

}  // namespace toolchain::codegen
