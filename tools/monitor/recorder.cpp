// recorder.cpp - see recorder.hpp.
#include "tools/monitor/recorder.hpp"

#include <algorithm>
#include <utility>

#include "host_sim/world/vehicle.hpp"

namespace monitor {
namespace {

using host_sim::LogHead;
using host_sim::LogStep;

constexpr uint32_t kStepMs = 100;

LogHead head_of(const std::optional<host_sim::ImageIdentity>& identity, const std::string& source) {
    LogHead head;
    head.image_identity = identity ? host_sim::describe_sources(*identity) + " telemetry"
                                   : "unknown: no identity frame came";
    // The frame has a name of eight letters; the description is that of the reference vehicle.
    if (identity && identity->vehicle == "Rocky3.2") head.vehicle = host_sim::rocky32().toml_text;
    head.notes["source"] = "telemetry of " + source;
    head.notes["calibration"] = "not known; nominal values stand in this log";
    head.notes["inputs"] = "not known, but for the tick count";
    return head;
}

}  // namespace

Recorder::Recorder(std::filesystem::path path, std::string source)
    : path_(std::move(path)), source_(std::move(source)) {
    open();  // here, so that a file that cannot be written is heard of at once
}

/// Begins the file anew, with what is known of the firmware.
void Recorder::open() {
    const LogHead head = head_of(identity_, source_);
    rlog_.reset();
    csv_.reset();
    if (path_.extension() == ".csv") {
        csv_ = std::make_unique<host_sim::EstimatesCsvWriter>(path_, head);
    } else {
        rlog_ = std::make_unique<host_sim::RlogWriter>(path_, head, 0);  // every record at once
    }
}

void Recorder::take(const host_sim::ImageIdentity& identity) {
    if (begun_) return;  // the head is written
    identity_ = identity;
    begin();
}

void Recorder::begin() {
    open();
    begun_ = true;
    for (const LogStep& step : waiting_) write(step);
    waiting_.clear();
}

void Recorder::take(const Telemetry& telemetry, Elapsed now) {
    if (!first_at_) {
        first_at_ = now;
    } else if (telemetry.restart == host_sim::Restart::none) {
        time_ms_ += kStepMs * static_cast<uint32_t>(telemetry.missing + 1);
    } else {
        const auto steps = static_cast<uint32_t>((now - last_at_) / Elapsed(kStepMs));
        time_ms_ += kStepMs * std::max(steps, 1U);
    }
    last_at_ = now;
    LogStep step;
    step.time_ms = time_ms_;
    step.restart = telemetry.restart;
    for (uint16_t& channel : step.inputs.adc_q4_count) channel = hal::kAdcAbsent;
    step.inputs.tick_count = telemetry.estimates.tick_count;
    step.estimates = telemetry.estimates;
    ++rows_;
    if (begun_) {
        write(step);
        return;
    }
    waiting_.push_back(step);
    if (now - *first_at_ >= kIdentityWait) begin();
}

void Recorder::write(const LogStep& step) {
    if (rlog_) {
        rlog_->append(step);
    } else {
        csv_->append(step);
    }
}

void Recorder::close() {
    if (!begun_) begin();
    if (rlog_) rlog_->close();
    if (csv_) csv_->close();
}

}  // namespace monitor
