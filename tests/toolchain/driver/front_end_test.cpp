// Sources to bitcode: what clang is told, and what is said when it cannot.
#include "toolchain/driver/front_end.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "tests/toolchain/driver/compile.hpp"
#include "toolchain/driver/work_folder.hpp"

namespace {

namespace fs = std::filesystem;
using driver_test::failure_of;
using driver_test::request_for;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;
using toolchain::driver::Request;
using toolchain::driver::run_front_end;
using toolchain::driver::Source;
using toolchain::driver::WorkFolder;

std::vector<std::string> arguments_for(const std::string& name, std::vector<std::string> options) {
    Request request = request_for("", name);
    request.front_end = std::move(options);
    return toolchain::driver::clang_arguments(request, name, name, "out.bc", "inc");
}

/// A variable of the environment for one test.
class Setting {
public:
    Setting(const char* name, const char* value) : name_(name) { setenv(name, value, 1); }
    ~Setting() { unsetenv(name_); }
    Setting(const Setting&) = delete;
    Setting& operator=(const Setting&) = delete;

private:
    const char* name_;
};

TEST(FrontEnd, TellsCFromCpp) {
    EXPECT_THAT(arguments_for("a.c", {}), Contains("c"));
    for (const char* name : {"a.cpp", "a.cc", "a.cxx", "a.C"}) {
        EXPECT_THAT(arguments_for(name, {}), Contains("c++"));
    }
}

TEST(FrontEnd, GivesEachLanguageItsStandard) {
    const std::vector<std::string> both = {"-std=c99", "-std=c++17", "-DX=1"};
    EXPECT_THAT(arguments_for("a.c", both), Contains("-std=c99"));
    EXPECT_THAT(arguments_for("a.c", both), Not(Contains("-std=c++17")));
    EXPECT_THAT(arguments_for("a.cpp", both), Contains("-std=c++17"));
    EXPECT_THAT(arguments_for("a.cpp", both), Not(Contains("-std=c99")));
    EXPECT_THAT(arguments_for("a.c", both), Contains("-DX=1"));
}

TEST(FrontEnd, MakesAFileForEachSourceInTheirOrder) {
    const WorkFolder work;
    Request request = request_for("int one() { return 1; }", "one.cpp");
    request.sources.push_back({"two.ll", "define i16 @two() { ret i16 2 }"});
    request.sources.push_back({"three.c", "int three(void) { return 3; }"});
    const auto files = run_front_end(request, work.path());
    ASSERT_EQ(files.size(), 3U);
    EXPECT_EQ(files[0].extension(), ".bc");
    EXPECT_EQ(files[1].extension(), ".ll");
    for (const fs::path& file : files) EXPECT_GT(fs::file_size(file), 0U);
}

TEST(FrontEnd, PassesMessagesOnAndNamesTheFailingSource) {
    const WorkFolder work;
    Request request = request_for("int f() { return 1 }\n", "dir/broken.cpp");
    std::string messages;
    request.messages = [&](std::string_view text) { messages += text; };
    EXPECT_EQ(failure_of([&] { (void)run_front_end(request, work.path()); }),
              "dir/broken.cpp: not compiled: see the messages above");
    EXPECT_THAT(messages, HasSubstr("dir/broken.cpp:1:19: error: expected ';'"));
}

TEST(FrontEnd, PassesWarningsOnThoughAllIsWell) {
    const WorkFolder work;
    Request request = request_for("int f() {\n    int unused;\n    return 1;\n}\n", "warn.cpp");
    request.front_end = {"-Wall"};
    std::string messages;
    request.messages = [&](std::string_view text) { messages += text; };
    EXPECT_EQ(run_front_end(request, work.path()).size(), 1U);
    EXPECT_THAT(messages, HasSubstr("warn.cpp:2:9: warning: unused variable"));
}

TEST(FrontEnd, RefusesInterruptFunctionsThatWouldNotBe) {
    const WorkFolder work;
    Request request = request_for(
        "#include <i85.h>\n"
        "I85_INTERRUPT(I85_RST_75) int tick(int a) { return a; }\n");
    EXPECT_THAT(failure_of([&] { (void)run_front_end(request, work.path()); }),
                HasSubstr("not compiled"));
}

TEST(FrontEnd, FindsItsOwnHeadersAndNoOthers) {
    const WorkFolder work;
    const Request own = request_for(
        "#include <i85.h>\n#include <string.h>\n#include <stdint.h>\n"
        "#include <stddef.h>\n#include <limits.h>\n");
    EXPECT_EQ(failure_of([&] { (void)run_front_end(own, work.path()); }), "");
    const Request other = request_for("#include <stdio.h>\n", "io.cpp");
    EXPECT_THAT(failure_of([&] { (void)run_front_end(other, work.path()); }),
                StartsWith("io.cpp: not compiled"));
}

TEST(FrontEnd, HeadersWorkInCAndCpp) {
    const WorkFolder work;
    const std::string text =
        "#include <i85.h>\n#include <string.h>\n"
        "I85_INTERRUPT(I85_RST_75) void tick(void) { __i85_out(1, __i85_in(2)); }\n"
        "int f(int n) { int i; for (i = 0; i < n; i++) { I85_LOOP_BOUND(9); __i85_nop(); }\n"
        "__i85_sim(__i85_rim()); __i85_di(); __i85_ei(); __i85_hlt(); return i; }\n";
    for (const char* name : {"a.c", "a.cpp"}) {
        Request request = request_for(text, name);
        std::string messages;
        request.messages = [&](std::string_view said) { messages += said; };
        request.front_end = {"-Wall", "-Wextra", "-Wpedantic", "-Werror", "-std=c89"};
        if (name == std::string("a.c")) request.front_end.back() = "-std=c99";
        EXPECT_EQ(failure_of([&] { (void)run_front_end(request, work.path()); }), "") << messages;
    }
}

TEST(FrontEnd, SaysThatClangIsMissing) {
    const Setting setting("I85CC_CLANG", "no-such-clang");
    const WorkFolder work;
    const Request request = request_for("int a;");
    EXPECT_EQ(failure_of([&] { (void)run_front_end(request, work.path()); }),
              "no-such-clang: cannot be started: No such file or directory: install clang-19 "
              "(tools/setup run), or set I85CC_CLANG to its path");
}

TEST(FrontEnd, TakesTheClangThatIsChosen) {
    const WorkFolder tools;
    const fs::path script = tools.path() / "my-clang";
    std::ofstream(script) << "#!/bin/sh\nkill -SEGV $$\n";
    fs::permissions(script, fs::perms::owner_all);
    const Setting setting("I85CC_CLANG", script.c_str());
    const WorkFolder work;
    const Request request = request_for("int a;", "a.cpp");
    EXPECT_EQ(failure_of([&] { (void)run_front_end(request, work.path()); }),
              fmt::format("a.cpp: {} crashed; its message is above", script.string()));
}

TEST(FrontEnd, SaysWhichSourceCannotBeRead) {
    const WorkFolder work;
    Request request = request_for("int a;");
    request.sources.push_back({"no/such.c"});
    EXPECT_EQ(failure_of([&] { (void)run_front_end(request, work.path()); }),
              "no/such.c: cannot be read: No such file or directory: check the path");
    request.sources[1].path = work.path().string();
    EXPECT_EQ(failure_of([&] { (void)run_front_end(request, work.path()); }),
              work.path().string() + ": cannot be read: it is a folder: check the path");
}

}  // namespace
