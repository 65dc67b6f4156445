// The study's kernels, compiled by clang at every level, give their checksums in the interpreter.
// Checksums: the table of shared/kernels/README.md, from a host build.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <llvm/IRReader/IRReader.h>
#include <llvm/Linker/Linker.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <tuple>
#include <utility>

#include "tests/toolchain/ir/ir_program.hpp"

namespace {

namespace fs = std::filesystem;

struct Kernel {
    const char* name;
    uint32_t checksum;
};

class Kernels : public testing::TestWithParam<std::tuple<Kernel, std::string>> {};

std::unique_ptr<llvm::Module> compile(const fs::path& source, const std::string& level,
                                      llvm::LLVMContext& context) {
    const fs::path bitcode =
        fs::temp_directory_path() /
        fmt::format("kernels_test_{}_{}_{}.bc", source.stem().string(), level, getpid());
    const std::string command = fmt::format(
        "clang-19 --target=msp430-none-elf -fpack-struct=1 -ffreestanding -O{} -emit-llvm -c "
        "-I'{}' '{}' -o '{}'",
        level, source.parent_path().string(), source.string(), bitcode.string());
    if (std::system(command.c_str()) != 0) return nullptr;
    llvm::SMDiagnostic problem;
    auto module = llvm::parseIRFile(bitcode.string(), problem, context);
    fs::remove(bitcode);
    return module;
}

TEST_P(Kernels, GivesItsChecksum) {
    const auto& [kernel, level] = GetParam();
    const fs::path folder = fs::path(ROVER_SOURCE_DIR) / "../shared/kernels";
    if (!fs::exists(folder)) GTEST_SKIP() << "shared/kernels is not there";
    ASSERT_EQ(std::system("clang-19 --version >/dev/null 2>&1"), 0)
        << "clang-19 is not installed (tools/setup test)";
    llvm::LLVMContext context;
    auto module = compile(folder / (std::string(kernel.name) + ".c"), level, context);
    ASSERT_NE(module, nullptr);
    auto data = compile(folder / "kdata.c", "1", context);
    ASSERT_NE(data, nullptr);
    ASSERT_FALSE(llvm::Linker::linkModules(*module, std::move(data)));
    const auto mir = ir_test::to_mir(*module);
    codegen_test::Interpreter interpreter(mir);
    interpreter.call("kernel");
    EXPECT_EQ(interpreter.variable("ksum", 4), kernel.checksum);
    const auto lowered = ir_test::lowered(mir);
    codegen_test::Interpreter behind_lowering(lowered);
    behind_lowering.call("kernel");
    EXPECT_EQ(behind_lowering.variable("ksum", 4), kernel.checksum);
}

INSTANTIATE_TEST_SUITE_P(
    All, Kernels,
    testing::Combine(testing::Values(Kernel{"wss", 0x0020926E}, Kernel{"ring", 0x000091FE},
                                     Kernel{"mul16", 0x1ACE7554}, Kernel{"div32", 0xD2C98B07},
                                     Kernel{"fuzzy", 0x00005DDA}, Kernel{"mat", 0x00000A69},
                                     Kernel{"crc16", 0x0000072A}, Kernel{"sieve", 0x13546998},
                                     Kernel{"sort", 0x0000E5EE}, Kernel{"isqrt", 0x7413ACFC},
                                     Kernel{"crc32", 0xC80FE36C}),
                     testing::Values("0", "1", "2", "s")),
    [](const auto& test) {
        return fmt::format("{}_O{}", std::get<0>(test.param).name, std::get<1>(test.param));
    });

}  // namespace
