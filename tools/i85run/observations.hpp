// observations.hpp - trace, profile and coverage of a run, as far as the user asked for them.
// Depends on   host_sim/trace, options.hpp, output_file.hpp, program.hpp, run.hpp.
// Formats      docs/design/trace.md
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "host_sim/trace/call_profile.hpp"
#include "host_sim/trace/coverage.hpp"
#include "host_sim/trace/execution_trace.hpp"
#include "tools/i85run/machine.hpp"
#include "tools/i85run/options.hpp"
#include "tools/i85run/output_file.hpp"
#include "tools/i85run/program.hpp"
#include "tools/i85run/run.hpp"

namespace i85run {

/// Opens the files at the beginning, watches the run, writes at the end.
class Observations {
public:
    /// @param machine, program, options  must outlive it
    /// @errors  host_sim::ImageError for a file that cannot be opened
    Observations(const Machine& machine, const Program& program, const Options& options);

    /// Has `request` call the observers that are needed; none if nothing is asked for.
    void attach(RunRequest& request);

    /// Writes the files.
    /// @return  the text to print: the profile's table and the opcodes that were executed
    /// @errors  host_sim::ImageError
    std::string finish();

private:
    void open_coverage();
    void write_coverage();

    const Program& program_;
    const Options& options_;
    const host_sim::Symbols* symbols_;  ///< nullptr: there is no symbol file
    std::optional<OutputFile> trace_file_, profile_file_, coverage_file_, listing_file_;
    std::string listing_name_;
    std::optional<host_sim::ExecutionTrace> trace_;
    std::unique_ptr<host_sim::CallProfile> profile_;
    std::optional<host_sim::Coverage> coverage_;
};

}  // namespace i85run
