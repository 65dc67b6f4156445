// session.cpp - see session.hpp.
#include "tools/monitor/session.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>

namespace monitor {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kListen{50};
constexpr milliseconds kWrite{1000};
constexpr Elapsed kRepeat{1000};
constexpr Elapsed kStatusEvery{5000};
constexpr Elapsed kSilence{3000};

}  // namespace

Session::Session(host_sim::SerialPort& port, SessionOptions options, std::ostream& out)
    : port_(port),
      options_(std::move(options)),
      display_(out, options_.in_place),
      out_(out),
      begin_(Clock::now()) {
    known_.port = options_.name;
    if (!options_.record.empty()) recorder_.emplace(options_.record, options_.name);
}

Elapsed Session::now() const {
    return std::chrono::duration_cast<Elapsed>(Clock::now() - begin_);
}

bool Session::is_over() const {
    if (options_.ended && options_.ended()) return true;
    return options_.seconds && now() >= std::chrono::duration<double>(*options_.seconds);
}

void Session::run() {
    try {
        while (!is_over()) {
            ask();
            listen();
            watch_silence();
        }
    } catch (...) {
        if (receiver_.counts().telemetry != 0) finish();
        throw;
    }
    finish();
}

void Session::listen() {
    std::array<uint8_t, 512> buffer{};
    const std::size_t count = port_.read(buffer, kListen);
    for (const uint8_t byte : std::span(buffer).first(count)) {
        if (const auto message = receiver_.take(byte, now())) handle(*message);
    }
}

/// Identity first, then the status every few seconds.
void Session::ask() {
    if (!telemetry_at_ || silent_) return;
    if (asked_ != Question::none && now() - asked_at_ < kRepeat) return;
    if (identity_due_) {
        asked_ = Question::identity;
    } else if (now() >= status_due_) {
        asked_ = Question::status;
    } else {
        asked_ = Question::none;
        return;
    }
    asked_at_ = now();
    const bool identity = asked_ == Question::identity;
    port_.write(host_sim::uplink_frame(identity ? host_sim::UplinkType::identity
                                                : host_sim::UplinkType::status),
                kWrite);
}

void Session::watch_silence() {
    if (!telemetry_at_) {
        if (now() >= std::chrono::duration<double>(options_.wait_s)) fail_without_telemetry();
        return;
    }
    if (silent_ || now() - *telemetry_at_ < kSilence) return;
    silent_ = true;
    display_.note(fmt::format("no telemetry for {} s; still listening", kSilence.count() / 1000));
}

void Session::handle(const Message& message) {
    known_.counts = receiver_.counts();
    if (const auto* telemetry = std::get_if<Telemetry>(&message)) {
        handle_telemetry(*telemetry);
    } else if (const auto* identity = std::get_if<host_sim::ImageIdentity>(&message)) {
        known_.identity = *identity;
        identity_due_ = false;
        asked_ = Question::none;
        if (recorder_) recorder_->take(*identity);
        display_.show(known_, identity_line(*identity));
    } else if (const auto* status = std::get_if<rover::BoardStatus>(&message)) {
        known_.status = *status;
        status_due_ = now() + kStatusEvery;
        asked_ = Question::none;
        display_.show(known_, status_line(*status));
    } else {
        display_.note(fmt::format("a frame of kind {:02X}H, which is not asked for here",
                                  std::get<OtherFrame>(message).kind));
    }
}

void Session::handle_telemetry(const Telemetry& telemetry) {
    known_.telemetry = telemetry;
    telemetry_at_ = now();
    silent_ = false;
    const std::string notice = monitor::notice(telemetry);
    if (!notice.empty()) display_.note(notice);
    if (telemetry.restart != host_sim::Restart::none) {
        identity_due_ = true;  // perhaps another image
        status_due_ = Elapsed(0);
    }
    if (recorder_) recorder_->take(telemetry, now());
    display_.show(known_, telemetry_line(telemetry));
}

/// The last lines: how long, what came, what was recorded.
void Session::finish() {
    known_.counts = receiver_.counts();
    out_ << fmt::format("{:.1f} s: {}\n", static_cast<double>(now().count()) / 1000,
                        link_words(known_.counts));
    if (recorder_) {
        recorder_->close();
        out_ << fmt::format("recorded: {} steps in {}\n", recorder_->rows(),
                            recorder_->path().string());
    }
    out_ << std::flush;
}

void Session::fail_without_telemetry() const {
    const uint64_t bytes = receiver_.counts().bytes;
    if (bytes == 0) {
        throw MonitorError(fmt::format(
            "{}: no telemetry within {} s, not a single byte; check that the rover has power, that "
            "TX and RX are not swapped and ground is connected, and that an image runs: a board "
            "without one waits for `rover85 flash`",
            options_.name, options_.wait_s));
    }
    throw MonitorError(fmt::format(
        "{}: {} bytes came within {} s, but no telemetry frame; check that the other side sends at "
        "19,200 baud, 8N1, and is a rover85: its loader or another program may be speaking",
        options_.name, bytes, options_.wait_s));
}

}  // namespace monitor
