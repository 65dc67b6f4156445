// target_option_test.cpp - which target and image the options name.
#include "tools/rover85/target_option.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "host_sim/bind/host_target.hpp"
#include "tests/tools/rover85/command_line.hpp"
#include "tools/rover85/command_errors.hpp"

namespace {

int parse(TargetOptions& options, std::vector<std::string> arguments) {
    CLI::App app;
    add_target_options(app, options);
    std::ranges::reverse(arguments);
    try {
        app.parse(arguments);
    } catch (const CLI::ParseError&) {
        return kExitUsage;
    }
    return kExitPass;
}

TEST(TargetOption, HostIsTheDefaultAndOthersAreRefused) {
    TargetOptions options;
    ASSERT_EQ(parse(options, {}), kExitPass);
    const auto target = make_target(options);
    target->begin({});
    EXPECT_EQ(target->identity(), host_sim::host_image_identity());
    EXPECT_EQ(machine_of(*target), std::nullopt) << "only the board is measured";
    EXPECT_EQ(parse(options, {"--target", "moon"}), kExitUsage);
}

TEST(TargetOption, TheImageIsTheNamedOneAndHasToExist) {
    const rover85_test::TestFolder folder("target_" + std::to_string(getpid()));
    TargetOptions options;
    ASSERT_EQ(parse(options, {"--target", "board", "--image", folder.file("a.hex")}), kExitPass);
    EXPECT_THROW(image_file(options), std::runtime_error);
    EXPECT_THROW(make_target(options), std::runtime_error);
    std::ofstream(folder.file("a.hex")) << "no image\n";
    EXPECT_EQ(image_file(options), std::filesystem::path(folder.file("a.hex")));
    EXPECT_THROW(make_target(options), std::runtime_error) << "it is none";
}

TEST(GuardedOnTarget, ABoardThatFailsIsARegressionAndOtherErrorsAreBadInput) {
    EXPECT_EQ(guarded_on_target([]() -> int { throw host_sim::BoardError("late"); }),
              kExitDifference);
    EXPECT_EQ(guarded_on_target([]() -> int { throw std::runtime_error("bad"); }), kExitBadInput);
    EXPECT_EQ(guarded_on_target([] { return int{kExitPass}; }), kExitPass);
}

}  // namespace
