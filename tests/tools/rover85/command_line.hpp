// command_line.hpp - runs one command of the program in a test: arguments in, exit code and both
// streams out. Arguments that the parser itself refuses give 2, as in the program.
#pragma once

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

namespace rover85_test {

struct Outcome {
    int exit_code = -1;
    std::string out, err;
};

/// Swaps a stream's buffer for its lifetime.
class Capture {
public:
    explicit Capture(std::ostream& stream) : stream_(stream), old_(stream.rdbuf(text_.rdbuf())) {}
    ~Capture() { stream_.rdbuf(old_); }
    Capture(const Capture&) = delete;
    Capture& operator=(const Capture&) = delete;
    [[nodiscard]] std::string text() const { return text_.str(); }

private:
    std::ostringstream text_;
    std::ostream& stream_;
    std::streambuf* old_;
};

template <class AddCommand>
Outcome run_command(const AddCommand& add_command, std::vector<std::string> arguments) {
    Outcome outcome;
    CLI::App app;
    add_command(app, outcome.exit_code);
    std::ranges::reverse(arguments);
    const Capture out(std::cout);
    const Capture err(std::cerr);
    try {
        app.parse(arguments);
    } catch (const CLI::ParseError&) {
        outcome.exit_code = 2;
    }
    outcome.out = out.text();
    outcome.err = err.text();
    return outcome;
}

/// A folder of one test, removed with it.
class TestFolder {
public:
    explicit TestFolder(const std::string& name)
        : path_(std::filesystem::temp_directory_path() / ("rover85_" + name)) {
        std::filesystem::remove_all(path_);
        std::filesystem::create_directories(path_);
    }
    ~TestFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TestFolder(const TestFolder&) = delete;
    TestFolder& operator=(const TestFolder&) = delete;
    [[nodiscard]] std::string file(const std::string& name) const {
        return (path_ / name).string();
    }

private:
    std::filesystem::path path_;
};

}  // namespace rover85_test
