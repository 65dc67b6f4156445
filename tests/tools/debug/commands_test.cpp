// commands_test.cpp - the table of commands: names, help, and examples that are understood.
#include "tools/debug/commands.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <set>
#include <sstream>

#include "tests/tools/debug/bench.hpp"

namespace debug_console {
namespace {

/// A new current folder, removed with it.
class InFolder {
public:
    InFolder() : before_(std::filesystem::current_path()) {
        std::string name = (std::filesystem::temp_directory_path() / "debug_XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("mkdtemp failed");
        folder_ = name;
        std::filesystem::current_path(folder_);
    }
    ~InFolder() {
        std::filesystem::current_path(before_);
        std::filesystem::remove_all(folder_);
    }
    InFolder(const InFolder&) = delete;
    InFolder& operator=(const InFolder&) = delete;

private:
    std::filesystem::path before_, folder_;
};

TEST(Commands, HaveNamesThatDifferAndHelpThatShowsThem) {
    std::set<std::string_view> names;
    std::size_t count = 0;
    for (const Command& command : all_commands()) {
        EXPECT_TRUE(names.insert(command.name).second) << command.name;
        if (!command.alias.empty()) {
            EXPECT_TRUE(names.insert(command.alias).second) << command.alias;
        }
        EXPECT_TRUE(command.syntax.starts_with(command.name)) << command.name;
        EXPECT_FALSE(command.summary.empty()) << command.name;
        EXPECT_TRUE(command.help.ends_with('\n')) << command.name;
        EXPECT_NE(fmt::format("\n{}", command.help).find(fmt::format("\n  {}", command.name)),
                  std::string::npos)
            << command.name << " has no example";
        EXPECT_NE(command.run, nullptr);
        ++count;
    }
    EXPECT_EQ(count, run_commands().size() + break_commands().size() + show_commands().size() +
                         chip_commands().size() + stimulus_commands().size() +
                         snapshot_commands().size() + observe_commands().size() +
                         script_commands().size());
}

// Symbols that the examples name.
constexpr std::string_view kProgram = R"(
main:     JMP main
read_adc: RET
mode      EQU 8000H
buffer    EQU 8010H
)";

/// What an example needs before it can be done.
void prepare(debug_test::Bench& bench) {
    for (const char* line : {"break 100H", "break 200H", "break 300H", "snapshot before",
                             "profile on", "coverage on", "step"}) {
        bench(line);
    }
    bench.session.interrupted = [asked = 0]() mutable { return ++asked > 1; };
}

TEST(Commands, ExamplesInTheHelpAreUnderstood) {
    const InFolder folder;  // some of them write files
    unsigned count = 0;
    for (const Command& command : all_commands()) {
        std::istringstream help{std::string(command.help)};
        for (std::string line; std::getline(help, line);) {
            const std::string start = fmt::format("  {}", command.name);
            if (!line.starts_with(start) || command.name == "source") continue;
            debug_test::Bench bench(kProgram);
            prepare(bench);
            const std::string output = bench(line);
            EXPECT_EQ(output.find("refused"), std::string::npos) << line << ": " << output;
            ++count;
        }
    }
    EXPECT_GT(count, 60u);
}

}  // namespace
}  // namespace debug_console
