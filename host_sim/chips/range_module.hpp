// range_module.hpp - look-ahead range module: up to eight ground heights a scan, read byte by byte.
// Source       own interface, specified bit by bit in docs/chips/range-module.md.
// Depends on   host_sim/chips/chip.hpp.
// Wiring       eight data lines to one 82C55A port (input); SELECT and STROBE from, ACKNOWLEDGE to
//              port C. Pull-ups: a module that is absent reads FFh and never acknowledges.
// Not modelled the ranging itself (host_sim/world supplies the heights).
#pragma once

#include <array>
#include <cstdint>

#include "host_sim/chips/chip.hpp"

namespace host_sim::chips {

struct RangeModule {
    static constexpr unsigned kSampleCount = 8;
    static constexpr unsigned kFrameSize = 19;      ///< counter, presence, 8 heights, checksum
    static constexpr uint8_t kFrameSum = 0xA5;      ///< of all bytes of a frame, modulo 256
    static constexpr uint64_t kServiceNs = 20'000;  ///< from SELECT or a STROBE edge to ACKNOWLEDGE

    using Heights = std::array<int16_t, kSampleCount>;

    explicit RangeModule(uint64_t clock_hz) : service_t(t_states_from_ns(kServiceNs, clock_hz)) {}

    /// A new scan is complete. The scan counter goes up by one, modulo 256. A frame that is being
    /// read stays as it was.
    /// @param present        bit i: heights_q1_mm[i] was measured; others are sent as 0
    /// @param heights_q1_mm  s16 Q1 mm (0.5 mm), ground in the body frame
    void set_scan(uint8_t present, const Heights& heights_q1_mm);
    /// The same with a scan counter of its own, to replay a recorded scan: an unchanged counter is
    /// no new scan.
    void set_scan(uint8_t counter, uint8_t present, const Heights& heights_q1_mm);
    /// Plugs the module in or out.
    void set_connected(bool plugged, uint64_t now_t);
    /// Lines from the processor. The rising edge of SELECT takes the newest scan and serves its
    /// first byte; each STROBE edge asks for the next one.
    void set_lines(bool select, bool strobe, uint64_t now_t);
    void advance(uint64_t now_t);
    [[nodiscard]] uint64_t next_event_t() const { return serving ? ready_t : kNever; }

    /// Data lines; valid after advance.
    [[nodiscard]] uint8_t data() const { return lines; }
    /// ACKNOWLEDGE; equals STROBE when the data lines are valid.
    [[nodiscard]] bool acknowledge() const { return acknowledge_line; }
    [[nodiscard]] Properties properties() const;

    uint64_t service_t = 0;
    bool connected = true;
    uint8_t scan_counter = 0;  ///< 0 until the first scan
    uint8_t scan_present = 0;
    Heights scan_q1_mm{};

    bool select_line = false;
    bool strobe_line = false;
    bool acknowledge_line = true;
    uint8_t lines = kOpenBus;
    std::array<uint8_t, kFrameSize> frame{};  ///< being read
    uint8_t served_count = 0;                 ///< bytes of it, counts on at kFrameSize
    bool serving = false;
    bool serving_level = false;  ///< STROBE as it was when the byte was asked for
    uint64_t ready_t = 0;

    uint64_t early_strobe_count = 0;  ///< STROBE edges before the byte before was acknowledged
    uint64_t overread_count = 0;      ///< bytes asked for behind the checksum

    bool operator==(const RangeModule&) const = default;

private:
    void release();
    void serve(uint64_t from_t);
    void take_frame();
};

}  // namespace host_sim::chips
