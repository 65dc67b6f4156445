// generate.cpp - see generate.hpp.
#include "tests/toolchain/csmith/generate.hpp"

#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <regex>
#include <stdexcept>

#include "tests/toolchain/csmith/kernels.hpp"
#include "tests/toolchain/csmith/process.hpp"
#include "tests/toolchain/csmith/profile.hpp"

namespace csmith_test {

namespace {

constexpr unsigned kSeconds = 10;

}  // namespace

std::string escapes_of(const std::string& program) {
    static const std::regex kVariable(R"((^|\n)static [^\n=;(]*\b(g_\d+)(\[\d+\])*( =|;))");
    std::string table;
    for (auto at = std::sregex_iterator(program.begin(), program.end(), kVariable);
         at != std::sregex_iterator(); ++at) {
        table += fmt::format("(void*)&{}, ", (*at)[2].str());
    }
    if (table.empty()) return {};
    return fmt::format("\n__attribute__((used)) void* rover_escape[] = {{{}0}};\n", table);
}

std::optional<Program> generate(uint64_t seed, const std::filesystem::path& folder,
                                Generator kind) {
    if (kind == Generator::kernels) {
        const Program program{std::filesystem::absolute(folder) / fmt::format("{}.c", seed),
                              {"-DROVER_OPAQUE"}};
        const std::string text = kernel_program(seed);
        std::ofstream(program.source) << text << escapes_of(text);
        return program;
    }
    const Profile profile = profile_of(seed);
    std::ofstream(folder / "platform.info") << "integer size = 2\npointer size = 2\n";
    const auto source = std::filesystem::absolute(folder) / fmt::format("{}.c", seed);
    std::vector<std::string> command = {"csmith", "--output", source.string()};
    command.insert(command.end(), profile.csmith.begin(), profile.csmith.end());
    const Ran ran = run_program(command, kSeconds, folder);
    if (ran.end == Ran::End::failed && ran.status == 127)
        throw std::runtime_error("csmith is not installed: tools/setup test");
    if (ran.end == Ran::End::failed) throw std::runtime_error(fmt::format("csmith: {}", ran.text));
    if (ran.end != Ran::End::finished) return {};
    if (profile.opaque) {
        std::ifstream in(source);
        const std::string text{std::istreambuf_iterator<char>(in), {}};
        std::ofstream(source, std::ios::app) << escapes_of(text);
    }
    Program result{source, profile.compiler};
    if (profile.opaque) result.options.emplace_back("-DROVER_OPAQUE");
    return result;
}

}  // namespace csmith_test
