// session.hpp - one run of the monitor: asks, listens, shows, records, until it is told to end.
// Depends on   receiver.hpp, display.hpp, recorder.hpp, host_sim/link/serial_port.hpp.
// Asks         only a rover that sends telemetry: a program that waits for an image on the same
//              line is left alone. One question at a time, repeated after a second.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <ostream>
#include <stdexcept>
#include <string>

#include "host_sim/link/serial_port.hpp"
#include "tools/monitor/display.hpp"
#include "tools/monitor/receiver.hpp"
#include "tools/monitor/recorder.hpp"

namespace monitor {

/// Nothing that can be read comes from the port. One line: port, what, what to check.
class MonitorError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

struct SessionOptions {
    std::string name;               ///< of the port, for people
    std::string record;             ///< .rlog or .csv; empty: none
    std::optional<double> seconds;  ///< ends by itself
    double wait_s = 3;              ///< for the first telemetry frame
    bool in_place = false;          ///< the output is a terminal
    std::function<bool()> ended;    ///< asked twenty times a second
};

class Session {
public:
    /// @errors  host_sim::LogError: the recording cannot be written
    Session(host_sim::SerialPort& port, SessionOptions options, std::ostream& out);

    /// Runs to its end and says what there was; the recording is whole then, also after an error.
    /// @errors  MonitorError; host_sim::SerialError: unplugged; host_sim::LogError
    void run();

    [[nodiscard]] const Known& known() const { return known_; }

private:
    using Clock = std::chrono::steady_clock;
    enum class Question : uint8_t { none, identity, status };

    [[nodiscard]] Elapsed now() const;
    [[nodiscard]] bool is_over() const;
    void listen();
    void ask();
    void watch_silence();
    void handle(const Message& message);
    void handle_telemetry(const Telemetry& telemetry);
    void finish();
    [[noreturn]] void fail_without_telemetry() const;

    host_sim::SerialPort& port_;
    SessionOptions options_;
    Display display_;
    std::ostream& out_;
    Receiver receiver_;
    std::optional<Recorder> recorder_;
    Known known_;

    Clock::time_point begin_;
    Question asked_ = Question::none;
    Elapsed asked_at_{0};
    Elapsed status_due_{0};
    bool identity_due_ = true;
    std::optional<Elapsed> telemetry_at_;  ///< of the last frame
    bool silent_ = false;                  ///< that telemetry has stopped has been said
};

}  // namespace monitor
