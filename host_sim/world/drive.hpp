// drive.hpp - the simulated vehicle: commands in, raw inputs and truth out, ten times a second.
// Model         position along a straight line; both sides stand on their own ground by the true
//               linkage; the advance follows the odometer through an advance model.
// Not modelled  heading (turning on the spot holds the position), dynamics, wheel load, stalls.
// Determinism   everything follows from one seed, by named sub-streams.
// Depends       every other part of host_sim/world, host_sim/log/log.hpp (Truth).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "hal/io.hpp"
#include "host_sim/log/log.hpp"
#include "host_sim/world/advance.hpp"
#include "host_sim/world/faults.hpp"
#include "host_sim/world/linkage.hpp"
#include "host_sim/world/sensors.hpp"
#include "host_sim/world/soil.hpp"
#include "host_sim/world/terrain.hpp"
#include "host_sim/world/track.hpp"
#include "host_sim/world/vehicle.hpp"

namespace host_sim {

inline constexpr double kStepSeconds = 0.1;

/// The vehicle is picked up and put down by_cm further on, its wheels at rest.
struct HandMove {
    double at_s = 0;
    double by_cm = 0;
};

struct DriveOptions {
    Vehicle vehicle;
    Track left;
    std::optional<Track> right;  ///< none: the same ground as the left, the paper's planar model
    AdvanceModel advance;
    SensorModel sensors;
    FaultPlan faults;
    std::vector<HandMove> hand_moves;
    std::uint64_t seed = 1;
    double start_cm = 0;    ///< rear contact at the start
    double length_cm = 0;   ///< the course ends when the rear contact has come this far, > 0
    double ramp_cm = 0;     ///< before x = 0 the ground is firm and nothing slips: an exit ramp
    double max_time_s = 0;  ///< gives up then; 0: twenty times the time at full speed without slip
};

enum class DriveEnd : std::uint8_t {
    running,
    reached,  ///< the end of the course
    out_of_time,
    left_course  ///< more than 1 m behind the start
};

/// The true state after a step.
struct DriveState {
    double time_s = 0;
    double position_cm = 0;  ///< rear contact, from start_cm
    double odometer_cm = 0;  ///< mean rim travel of the six wheels, backwards counts down
    double pitch_rad = 0;
    double roll_rad = 0;  ///< right side down positive
    LinkagePose left;
    LinkagePose right;
    double sinkage_front_cm = 0;  ///< left front wheel
    double last_slip = 0;         ///< of the last whole cycle; NaN before the first
    std::array<double, hal::kWheelCount> rim_travel_cm = {};
};

struct DriveStep {
    hal::RawInputs inputs;
    Truth truth;
};

class Drive {
public:
    /// @errors  InputError when an option is out of its range
    explicit Drive(DriveOptions options);

    /// Carries out the commands for 0.1 s and reads the sensors. The first call only reads them, at
    /// time 0; after the end the vehicle keeps standing.
    DriveStep step(const hal::Commands& commands);

    [[nodiscard]] DriveEnd end() const { return end_; }
    [[nodiscard]] bool finished() const { return end_ != DriveEnd::running; }
    [[nodiscard]] const DriveState& state() const { return state_; }
    [[nodiscard]] const DriveOptions& options() const { return options_; }

private:
    void turn_wheels(const hal::Commands& commands);
    void travel(double odometer_cm);
    void begin_cycle(bool backwards);
    void move_by_hand();
    void stand();
    [[nodiscard]] SensedState sense() const;
    [[nodiscard]] Truth truth() const;
    [[nodiscard]] double rear_x_cm() const { return options_.start_cm + state_.position_cm; }

    DriveOptions options_;
    Sensors sensors_;
    FaultInjector faults_;
    Random advance_random_;
    DriveState state_;
    DriveEnd end_ = DriveEnd::running;
    std::int64_t step_count_ = 0;
    double cycle_travel_cm_ = 0;   // odometer within the cycle, either direction
    double cycle_advance_cm_ = 0;  // drawn for the whole cycle
    std::size_t next_move_ = 0;
};

/// Full speed ahead for the first steps until a controller commands otherwise.
hal::Commands full_speed_ahead();

/// The longest course on which every look-ahead sample still has ground, cm; 0 if there is none.
double drivable_length_cm(const Vehicle& vehicle, const Terrain& ground, double start_cm);

}  // namespace host_sim
