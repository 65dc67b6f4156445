// process.hpp - work in a process of its own, so that a crash, an endless loop or a growing heap
// ends only that piece of work. Depends on   POSIX.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace csmith_test {

/// How a piece of work ended and what it said.
struct Ran {
    enum class End { finished, failed, crashed, out_of_time };
    End end = End::failed;
    int status = 0;      ///< exit status, or number of the signal
    std::string text{};  ///< a program's standard output and error; what a function said
};

/// Runs a program found in PATH, at most so many seconds of processor time.
/// finished: exit status 0; failed: another one, 127 when there is no such program.
[[nodiscard]] Ran run_program(const std::vector<std::string>& arguments, unsigned seconds,
                              const std::filesystem::path& folder = ".");

/// Passes text on at once: what has been said stays when the work ends badly.
using Say = std::function<void(const std::string&)>;

/// Runs a function in a copy of this process. failed: it threw, and the text ends with what().
[[nodiscard]] Ran run_apart(const std::function<void(const Say&)>& work, unsigned seconds);

/// A folder of its own that goes away with the object, unless it is kept.
class WorkFolder {
public:
    WorkFolder();
    ~WorkFolder();
    WorkFolder(const WorkFolder&) = delete;
    WorkFolder& operator=(const WorkFolder&) = delete;
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

}  // namespace csmith_test
