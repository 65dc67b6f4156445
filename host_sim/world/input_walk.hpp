// input_walk.hpp - random inputs for the controller that reach what it can do: drives in the
// simulated world with sensor faults and moves by hand, wandering counts, noise.
// Depends on   host_sim/world.
// Determinism  everything follows from the seed and the commands given back.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "hal/calibration.hpp"
#include "hal/io.hpp"
#include "host_sim/world/drive.hpp"
#include "host_sim/world/random.hpp"

namespace host_sim {

/// Segments of 40 to 300 steps; each begins with a reset and a calibration record of its own.
class InputWalk {
public:
    explicit InputWalk(uint64_t seed) : random_(stream(seed, "walk")) {}

    struct Next {
        bool reset = false;  ///< reset with `calibration` before the step
        hal::Calibration calibration{};
        hal::RawInputs inputs{};
    };
    /// @param commands  what the controller asked for in the step before
    [[nodiscard]] Next next(const hal::Commands& commands);

private:
    enum class Kind : uint8_t { drive, wander, noise };

    [[nodiscard]] uint32_t below(uint32_t limit);
    [[nodiscard]] bool chance(double share) { return random_.uniform() < share; }
    [[nodiscard]] uint16_t word() { return static_cast<uint16_t>(random_.bits() >> 48); }
    void begin();
    [[nodiscard]] DriveOptions course();
    [[nodiscard]] hal::Calibration calibration();
    void wander();
    [[nodiscard]] hal::RawInputs noise();
    void corrupt(hal::RawInputs& inputs);

    Random random_;
    Kind kind_ = Kind::drive;
    uint32_t steps_left_ = 0;
    std::optional<Drive> drive_;
    hal::Calibration calibration_;
    hal::RawInputs wandering_;
    int slope_ = 0;
    int pulses_ = 0;
    bool turning_ = false;
    int stuck_ = -1;  ///< angle channel whose counts do not change
    double corruption_ = 0;
};

}  // namespace host_sim
