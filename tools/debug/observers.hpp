// observers.hpp - trace, profile, coverage and signals of what runs under the console.
// Depends on   session.hpp, host_sim/trace, host_sim/board/board_vcd.hpp.
// Use          one beside a Session; as long as something is on, every step is recorded.
#pragma once

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "host_sim/board/board_vcd.hpp"
#include "host_sim/image/image.hpp"
#include "host_sim/trace/call_profile.hpp"
#include "host_sim/trace/coverage.hpp"
#include "host_sim/trace/execution_trace.hpp"
#include "tools/debug/session.hpp"

namespace debug_console {

/// Each is started and stopped by itself. What is off is silent about stop. Errors of files:
/// DebugError or host_sim::VcdError, "FILE: what; what to do".
class Observers {
public:
    explicit Observers(Session& session) : session_(session) {}
    ~Observers();  ///< close(), without its errors
    Observers(const Observers&) = delete;
    Observers& operator=(const Observers&) = delete;

    /// Ends what is on and completes its files.
    void close();

    /// The program, for the coverage of its listing.
    host_sim::Image image;

    void start_trace(const std::filesystem::path& file);
    /// @errors DebugError when the file could not be written completely
    void stop_trace();

    void start_profile();
    void stop_profile();
    /// @errors DebugError when the profile is off
    [[nodiscard]] host_sim::ProfileReport profile() const;

    void start_coverage();
    void stop_coverage();
    /// How many opcodes were executed, and which not. @errors DebugError when coverage is off
    [[nodiscard]] std::string coverage_text() const;
    /// Writes the coverage of the sources when the symbols name some, else of the listing, which
    /// then goes to FILE.lst. @return names of the files
    std::vector<std::string> write_coverage(const std::filesystem::path& file) const;

    void start_vcd(const std::filesystem::path& file,
                   const std::vector<host_sim::VcdVariable>& variables);
    void stop_vcd();
    /// A VCD cannot go back in time.
    [[nodiscard]] bool vcd_on() const { return vcd_ != nullptr; }

private:
    void attach();
    [[nodiscard]] const host_sim::Symbols* symbols() const;

    Session& session_;
    std::filesystem::path trace_name_;
    std::unique_ptr<std::ofstream> trace_file_;
    std::unique_ptr<host_sim::ExecutionTrace> trace_;
    std::unique_ptr<host_sim::CallProfile> profile_;
    std::unique_ptr<host_sim::Coverage> coverage_;
    std::unique_ptr<host_sim::BoardVcd> vcd_;
};

}  // namespace debug_console
