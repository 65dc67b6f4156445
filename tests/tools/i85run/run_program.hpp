// run_program.hpp - runs the real i85run as a user would, in a folder of the test's own.
// Needs   I85RUN_PROGRAM, the path of the program that the build made.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace i85run_test {

struct Outcome {
    int exit_code = -1;  ///< -1: killed by a signal
    std::string out, err;
};

/// A folder of one test, removed with it.
class Folder {
public:
    Folder();
    ~Folder();
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;

    [[nodiscard]] std::string path(const std::string& name) const {
        return (path_ / name).string();
    }
    void write(const std::string& name, std::string_view bytes) const;
    void write(const std::string& name, const std::vector<uint8_t>& bytes) const;
    [[nodiscard]] std::string read(const std::string& name) const;

    /// Runs i85run in this folder with `input` as its standard input.
    [[nodiscard]] Outcome run(const std::vector<std::string>& arguments,
                              std::string_view input = {}) const;

private:
    std::filesystem::path path_;
};

}  // namespace i85run_test
