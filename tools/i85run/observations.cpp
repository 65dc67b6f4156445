#include "tools/i85run/observations.hpp"

#include <algorithm>
#include <filesystem>

namespace i85run {
namespace {

using host_sim::CpuState;
using host_sim::StepRecord;

host_sim::ExecutionTraceOptions trace_options(const Machine& machine, const Options& options,
                                              const host_sim::Symbols* symbols) {
    host_sim::ExecutionTraceOptions trace;
    trace.t_first = options.trace_from_t;
    trace.t_last = options.trace_to_t;
    trace.documented_only = options.instruction_set == host_sim::InstructionSet::documented;
    trace.symbols = symbols;
    trace.peek = [&machine](uint16_t address) { return machine.memory.bytes[address]; };
    return trace;
}

bool has_sources(const host_sim::Symbols& symbols) {
    return std::ranges::any_of(
        symbols.all(), [](const host_sim::Symbol& symbol) { return symbol.source_line != 0; });
}

}  // namespace

Observations::Observations(const Machine& machine, const Program& program, const Options& options)
    : program_(program),
      options_(options),
      symbols_(program.symbols_file.empty() ? nullptr : &program.symbols) {
    if (!options.trace.empty()) {
        trace_file_.emplace(options.trace);
        trace_.emplace(trace_file_->stream(), trace_options(machine, options, symbols_));
    }
    if (!options.profile_json.empty()) profile_file_.emplace(options.profile_json);
    if (options.profile || profile_file_) {
        profile_ = std::make_unique<host_sim::CallProfile>(symbols_);
    }
    if (!options.coverage.empty()) open_coverage();
}

void Observations::open_coverage() {
    coverage_.emplace();
    coverage_file_.emplace(options_.coverage);
    if (has_sources(program_.symbols)) return;
    listing_name_ = std::filesystem::path(options_.coverage).replace_extension(".lst").string();
    if (listing_name_ == options_.coverage) listing_name_ += ".lst";
    listing_file_.emplace(listing_name_);
}

void Observations::attach(RunRequest& request) {
    if (trace_) {
        request.observers.emplace_back([this](const StepRecord& step, const CpuState& after) {
            trace_->observe(step, after);
        });
    }
    if (profile_) {
        request.observers.emplace_back(
            [this](const StepRecord& step, const CpuState&) { profile_->observe(step); });
    }
    if (coverage_) {
        request.observers.emplace_back(
            [this](const StepRecord& step, const CpuState&) { coverage_->observe(step); });
    }
}

std::string Observations::finish() {
    std::string text;
    if (trace_file_) trace_file_->close();
    if (profile_) {
        const host_sim::ProfileReport report = profile_->report();
        if (options_.profile) text.append(1, '\n').append(host_sim::profile_text(report));
        if (profile_file_) {
            profile_file_->stream() << host_sim::profile_json(report);
            profile_file_->close();
        }
    }
    if (coverage_) {
        write_coverage();
        text.append(1, '\n').append(coverage_->opcode_text());
    }
    if (!text.empty() && text.back() != '\n') text.append(1, '\n');
    return text;
}

void Observations::write_coverage() {
    if (listing_file_) {
        const host_sim::Listing listing =
            host_sim::make_listing(program_.image, symbols_, *coverage_);
        listing_file_->stream() << listing.text;
        listing_file_->close();
        coverage_file_->stream() << host_sim::lcov_of_listing(listing, listing_name_, symbols_,
                                                              *coverage_);
    } else {
        coverage_file_->stream() << host_sim::lcov_of_sources(program_.symbols, *coverage_);
    }
    coverage_file_->close();
}

}  // namespace i85run
