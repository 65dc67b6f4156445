// console.hpp - the terminal: what a CP/M program prints, and a line of progress behind it.
// Depends on   run.hpp; POSIX (isatty).
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "tools/i85run/cpm.hpp"
#include "tools/i85run/machine.hpp"

namespace i85run {

/// Standard output for the program, standard error for warnings and, on a terminal only, progress:
/// emulated seconds and the speed of the last second.
class Console {
public:
    Console();
    ~Console() { clear_progress(); }
    Console(const Console&) = delete;
    Console& operator=(const Console&) = delete;

    /// A console for a CP/M machine. It refers to this object.
    [[nodiscard]] CpmConsole for_cpm();

    /// Shows what has been printed so far, and once a second the progress.
    void update(const Machine& machine);

    /// Ends the program's output: clears progress, begins a new line.
    void finish();

private:
    using Clock = std::chrono::steady_clock;

    void put(char character);
    void warn(const std::string& line);
    void clear_progress();

    bool terminal_;
    bool progress_shown_ = false;
    bool at_line_start_ = true;
    Clock::time_point shown_at_ = Clock::now();
    uint64_t shown_instructions_ = 0;
};

}  // namespace i85run
