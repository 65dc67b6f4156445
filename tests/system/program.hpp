// program.hpp - runs the real rover85 as a user would: a process of its own, both streams caught.
// Needs   ROVER85_PROGRAM, the path of the program that the build made.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

#include "host_sim/log/log.hpp"

namespace system_test {

struct Outcome {
    int exit_code = -1;  ///< -1: killed by a signal
    std::string out, err;
    double cpu_s = 0;  ///< user and system time of the process
};

/// A folder of one test, removed with it.
class Folder {
public:
    Folder();
    ~Folder();
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    [[nodiscard]] std::string operator/(const std::string& name) const {
        return (path_ / name).string();
    }
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

/// rover85 in a process of its own, beside the test.
class Process {
public:
    /// Starts it in the folder `cwd` (the current one when empty).
    explicit Process(const std::vector<std::string>& arguments,
                     const std::filesystem::path& cwd = {});
    ~Process();  ///< kills it, unless wait() has come back
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;

    /// Sends it a signal.
    void signal(int number) const;
    /// What it has written so far to standard output.
    [[nodiscard]] std::string out() const;
    /// Waits until `text` stands on its standard output. @return false: not within 20 s
    [[nodiscard]] bool says(const std::string& text) const;
    /// Waits for its end.
    Outcome wait();

private:
    Folder folder_;
    pid_t child_ = -1;
};

/// Runs rover85 with these arguments in the folder `cwd` (the current one when empty).
Outcome rover85(const std::vector<std::string>& arguments, const std::filesystem::path& cwd = {});

std::string read_bytes(const std::filesystem::path& file);
void write_bytes(const std::filesystem::path& file, const std::string& bytes);

/// Empty when both logs hold the same steps: time, inputs, estimates and commands, bit for bit;
/// else the first step and field group that differ.
std::string first_difference(const host_sim::Log& a, const host_sim::Log& b);

/// ROVER_SOURCE_DIR/../shared/data/NAME, the study data beside the repository; may not exist.
std::filesystem::path study_data(const std::string& name);

}  // namespace system_test
