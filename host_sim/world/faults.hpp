// faults.hpp - sensor faults switched on and off by a plan.
// Channels  bogie_left bogie_right differential pitch roll
//           tach_front_left ... tach_rear_right, tach (all six)
//           range_0 ... range_7 (one look-ahead sample), range (the module with its scan counter)
//
// | kind    | angle channel           | tachometer                  | look-ahead                  |
// |---------|-------------------------|-----------------------------|-----------------------------|
// | stuck   | repeats its last value  | repeats, then jumps to true | sample repeats; module stale|
// | dropped | absent with chance p    | a pulse is lost, chance p   | sample unseen; scan skipped |
// | offset  | + value in degrees      | + value in pulses           | + value in mm               |
// | absent  | absent                  | not present, counts 0       | unseen; module stale        |
//
// Depends   hal/io.hpp, host_sim/world/vehicle.hpp, random.hpp.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "hal/calibration.hpp"
#include "hal/io.hpp"
#include "host_sim/world/random.hpp"
#include "host_sim/world/vehicle.hpp"

namespace host_sim {

enum class FaultKind : std::uint8_t { stuck, dropped, offset, absent };

inline constexpr std::uint8_t kEveryWheel = 0xFF;

/// A place in RawInputs that can fail.
struct FaultChannel {
    enum class Group : std::uint8_t { angle, tachometer, range_sample, range_module };
    Group group = Group::angle;
    std::uint8_t index = 0;  ///< hal::AngleChannel, hal::Wheel (kEveryWheel: all six) or sample
};

struct Fault {
    FaultChannel channel;
    FaultKind kind = FaultKind::stuck;
    double from_s = 0;
    double to_s = std::numeric_limits<double>::infinity();  ///< active while from_s <= t < to_s
    double value = 0;  ///< dropped: chance p in [0, 1]; offset: see the table; otherwise 0
};

using FaultPlan = std::vector<Fault>;

/// Reads `channel:kind[=value]@from-[to]` (seconds), several separated by commas:
/// "bogie_left:stuck@120-180,pitch:offset=2@60-". `dropped` alone means chance 0.5.
/// An empty text is an empty plan.
/// @errors  InputError: which entry, what is wrong, what is allowed
FaultPlan parse_faults(std::string_view text);

/// Reads TOML: [[fault]] tables with channel, kind, from_s, and optional to_s and value.
/// @errors  InputError with file and line
FaultPlan parse_faults_toml(std::string_view toml_text, const std::string& file_name);

/// Applies a plan to the inputs of consecutive steps.
class FaultInjector {
public:
    FaultInjector(FaultPlan plan, const Vehicle& vehicle, std::uint64_t seed);

    /// Changes the inputs of the step at time_s. Faults act in the plan's order.
    void apply(double time_s, hal::RawInputs& inputs);

private:
    struct Active {
        Fault fault;
        Random random;
        bool started = false;  // `last` and `seen` hold something
        hal::RawInputs last;   // as of the last step that this fault left alone
        std::array<std::uint16_t, hal::kWheelCount> seen = {};  // true counts of the last step
        std::array<std::uint16_t, hal::kWheelCount> lost = {};  // pulses lost so far, for good
    };
    void apply_angle(Active& active, hal::RawInputs& inputs) const;
    static void apply_tachometer(Active& active, bool on, hal::RawInputs& inputs);
    static void apply_range(Active& active, hal::RawInputs& inputs);

    std::vector<Active> plan_;
    std::array<double, hal::kAngleChannelCount> q4_count_per_degree_ = {};
};

}  // namespace host_sim
