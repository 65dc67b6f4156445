// end_signal.hpp - Ctrl-C and its relatives as a wish to end, for commands that run until then.
// Depends on   POSIX signals.
#pragma once

/// While one exists, SIGINT, SIGTERM and SIGHUP do not kill the program but show here. At most one
/// at a time.
class EndSignal {
public:
    EndSignal();
    ~EndSignal();  ///< signals are what they were
    EndSignal(const EndSignal&) = delete;
    EndSignal& operator=(const EndSignal&) = delete;

    /// One has come since this object was made. Any thread may ask.
    [[nodiscard]] bool came() const;
};
