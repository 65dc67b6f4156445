// ir_program.cpp - see ir_program.hpp.
#include "tests/toolchain/ir/ir_program.hpp"

#include <fmt/format.h>
#include <llvm/IRReader/IRReader.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "toolchain/ir/loop_bounds.hpp"

namespace ir_test {

std::unique_ptr<llvm::Module> compile(const std::string& source, const std::string& level,
                                      llvm::LLVMContext& context) {
    static int number = 0;
    namespace fs = std::filesystem;
    const fs::path base =
        fs::temp_directory_path() / fmt::format("ir_program_{}_{}", getpid(), number++);
    const std::string code = base.string() + ".cpp";
    const std::string bitcode = base.string() + ".bc";
    std::ofstream(code) << source;
    // Optimisable, but not yet optimised, code is what -O2 gives without LLVM's passes.
    const std::string command = fmt::format(
        "clang++-19 --target=msp430-none-elf -std=c++20 -fpack-struct=1 -ffreestanding "
        "-fno-exceptions -fno-rtti -fno-threadsafe-statics -fno-c++-static-destructors -g -O{} "
        "-Xclang -disable-llvm-passes "
        "-emit-llvm -c '{}' -o '{}'",
        level, code, bitcode);
    const int status = std::system(command.c_str());
    fs::remove(code);
    if (status != 0) {
        throw std::runtime_error("clang++-19 failed; is it installed (tools/setup test)?");
    }
    llvm::SMDiagnostic problem;
    auto module = llvm::parseIRFile(bitcode, problem, context);
    fs::remove(bitcode);
    if (!module) throw std::runtime_error(problem.getMessage().str());
    using toolchain::ir::Optimisation;
    toolchain::ir::take_loop_bounds(*module);
    toolchain::ir::optimise(*module, level == "0"   ? Optimisation::none
                                     : level == "1" ? Optimisation::less
                                     : level == "2" ? Optimisation::more
                                                    : Optimisation::size);
    return module;
}

}  // namespace ir_test
