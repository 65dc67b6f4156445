// generate_pending.cpp - stands in for codegen::generate() until it is there.
#include "toolchain/codegen/compile.hpp"

namespace toolchain::codegen {

FunctionCode generate(const Module& /*module*/, const Function& /*function*/,
                      const GenerateOptions& /*options*/) {
    throw Refused("code generation is not there yet: --emit=mir shows what it will be given");
}

}  // namespace toolchain::codegen
