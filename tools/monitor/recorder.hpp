// recorder.hpp - telemetry to a log, while it comes.
// Depends on   host_sim/log, receiver.hpp.
// Recorded     of each frame: time, restart, tick count, estimates. Sensors, truth and motors are
//              not on the link and stay absent.
// Crash        a log whose program is killed is whole up to its last frame: an .rlog reads as it
//              is, a CSV lacks its checksum line and reads as unverified.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "host_sim/log/log_io.hpp"
#include "tools/monitor/receiver.hpp"

namespace monitor {

class Recorder {
public:
    /// @param source  where the telemetry comes from, for the log's notes
    /// @errors        host_sim::LogError: the file cannot be written
    Recorder(std::filesystem::path path, std::string source);

    /// Which firmware speaks goes into the head of the log: rows wait for it, but no longer than
    /// kIdentityWait.
    void take(const host_sim::ImageIdentity& identity);
    /// A row. Its time is that of the rover's step counter; over a restart, that of this PC.
    /// @errors  host_sim::LogError: the file cannot be written
    void take(const Telemetry& telemetry, Elapsed now);
    /// Writes what has waited and ends the log. @errors  host_sim::LogError
    void close();

    [[nodiscard]] uint64_t rows() const { return rows_; }
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

    static constexpr Elapsed kIdentityWait{3000};

private:
    void open();
    void begin();
    void write(const host_sim::LogStep& step);

    std::filesystem::path path_;
    std::string source_;
    std::optional<host_sim::ImageIdentity> identity_;
    bool begun_ = false;                      ///< the head is final
    std::vector<host_sim::LogStep> waiting_;  ///< for it
    std::optional<Elapsed> first_at_;
    Elapsed last_at_{0};
    uint32_t time_ms_ = 0;
    uint64_t rows_ = 0;
    std::unique_ptr<host_sim::RlogWriter> rlog_;  ///< this or the other
    std::unique_ptr<host_sim::EstimatesCsvWriter> csv_;
};

}  // namespace monitor
