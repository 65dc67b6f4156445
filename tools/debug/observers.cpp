// observers.cpp - see observers.hpp.
#include "tools/debug/observers.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>

#include "tools/debug/debug_error.hpp"

namespace debug_console {

using host_sim::BoardState;
using host_sim::StepRecord;

namespace {

[[noreturn]] void fail(const std::filesystem::path& file) {
    throw DebugError(fmt::format("{}: cannot be written: {}; choose another file", file.string(),
                                 std::strerror(errno)));
}

void write_file(const std::filesystem::path& file, const std::string& text) {
    std::ofstream out(file, std::ios::binary);
    if (!(out << text).flush()) fail(file);
}

}  // namespace

const host_sim::Symbols* Observers::symbols() const {
    const host_sim::Symbols& known = session_.names.symbols();
    return known.all().empty() ? nullptr : &known;
}

Observers::~Observers() {
    try {
        close();
    } catch (const std::exception&) {  // close() was there for those who want to know
        session_.observer = nullptr;
    }
}

void Observers::close() {
    stop_profile();
    stop_coverage();
    stop_vcd();
    stop_trace();
}

void Observers::attach() {
    if (!trace_ && !profile_ && !coverage_ && !vcd_) {
        session_.observer = nullptr;
        return;
    }
    session_.observer = [this](const StepRecord& record, const BoardState& state) {
        if (trace_) trace_->observe(record, state.cpu);
        if (profile_) profile_->observe(record);
        if (coverage_) coverage_->observe(record);
        if (vcd_) vcd_->observe(record, state);
    };
}

// -- Trace
// ------------------------------------------------------------------------------------------------

void Observers::start_trace(const std::filesystem::path& file) {
    stop_trace();
    auto stream = std::make_unique<std::ofstream>(file, std::ios::binary);
    if (!*stream) fail(file);
    trace_name_ = file;
    trace_file_ = std::move(stream);
    host_sim::ExecutionTraceOptions options;
    options.symbols = symbols();
    options.peek = [this](uint16_t address) { return session_.board.state.memory.bytes[address]; };
    trace_ = std::make_unique<host_sim::ExecutionTrace>(*trace_file_, options);
    attach();
}

void Observers::stop_trace() {
    if (!trace_) return;
    trace_.reset();
    attach();
    const bool complete = static_cast<bool>(trace_file_->flush());
    trace_file_.reset();
    if (!complete) fail(trace_name_);
}

// -- Profile
// ------------------------------------------------------------------------------------------------

void Observers::start_profile() {
    profile_ = std::make_unique<host_sim::CallProfile>(symbols());
    attach();
}

void Observers::stop_profile() {
    profile_.reset();
    attach();
}

host_sim::ProfileReport Observers::profile() const {
    if (!profile_) throw DebugError("the profile is off; `profile on` begins one");
    return profile_->report();
}

// -- Coverage
// ------------------------------------------------------------------------------------------------

void Observers::start_coverage() {
    coverage_ = std::make_unique<host_sim::Coverage>();
    attach();
}

void Observers::stop_coverage() {
    coverage_.reset();
    attach();
}

std::string Observers::coverage_text() const {
    if (!coverage_) throw DebugError("coverage is off; `coverage on` begins it");
    return coverage_->opcode_text();
}

std::vector<std::string> Observers::write_coverage(const std::filesystem::path& file) const {
    if (!coverage_) throw DebugError("coverage is off; `coverage on` begins it");
    const std::string sources = host_sim::lcov_of_sources(session_.names.symbols(), *coverage_);
    if (!sources.empty()) {
        write_file(file, sources);
        return {file.string()};
    }
    const std::string listing_file = file.string() + ".lst";
    const host_sim::Listing listing = host_sim::make_listing(image, symbols(), *coverage_);
    write_file(listing_file, listing.text);
    write_file(file, host_sim::lcov_of_listing(listing, listing_file, symbols(), *coverage_));
    return {file.string(), listing_file};
}

// -- Signals
// ------------------------------------------------------------------------------------------------

void Observers::start_vcd(const std::filesystem::path& file,
                          const std::vector<host_sim::VcdVariable>& variables) {
    stop_vcd();
    vcd_ = std::make_unique<host_sim::BoardVcd>(file, session_.board.state, variables);
    attach();
}

void Observers::stop_vcd() {
    if (!vcd_) return;
    const std::unique_ptr<host_sim::BoardVcd> ended = std::move(vcd_);
    attach();
    ended->close();
}

}  // namespace debug_console
