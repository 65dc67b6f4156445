// guide_commands_test.cpp - the commands that README.md and the getting-started guide show are run
// as printed: every line of a fenced `sh` block that starts with build/bin/rover85, in order, in
// one folder.
#include <gtest/gtest.h>

#include <sstream>

#include "tests/system/program.hpp"

namespace {

constexpr std::string_view kProgram = "build/bin/rover85";

/// Lines of the fenced blocks marked `sh` that start with the program, without its name.
std::vector<std::string> shown_commands(const std::string& file) {
    std::istringstream text(
        system_test::read_bytes(std::filesystem::path(ROVER_SOURCE_DIR) / file));
    std::vector<std::string> commands;
    bool shell = false, fenced = false;
    for (std::string line; std::getline(text, line);) {
        if (line.starts_with("```")) {
            fenced = !fenced;
            shell = fenced && line == "```sh";
        } else if (shell && line.starts_with(kProgram)) {
            commands.push_back(line.substr(kProgram.size()));
        }
    }
    return commands;
}

std::vector<std::string> words(const std::string& command) {
    std::istringstream text(command);
    std::vector<std::string> list;
    for (std::string word; text >> word;) list.push_back(word);
    return list;
}

void run_all(const std::string& file) {
    const system_test::Folder folder;
    for (const std::string& command : shown_commands(file)) {
        const system_test::Outcome run = system_test::rover85(words(command), folder.path());
        EXPECT_EQ(run.exit_code, 0) << file << ": " << kProgram << command << "\n" << run.err;
    }
}

TEST(GuideCommands, OfTheReadmeRunAsPrinted) {
    EXPECT_GE(shown_commands("README.md").size(), 2u);
    run_all("README.md");
}

TEST(GuideCommands, OfTheGettingStartedGuideRunAsPrinted) {
    EXPECT_GE(shown_commands("docs/guides/getting-started.md").size(), 6u);
    run_all("docs/guides/getting-started.md");
}

}  // namespace
