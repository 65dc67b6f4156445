// controller_state.hpp - everything the controller remembers, and its state after reset.
// Depends on   firmware/inputs, firmware/estimation; hal/calibration.hpp.
// Bounds       one plain value; no pointers.
// Tests        tests/firmware/executive/controller_state_test.cpp
#pragma once

#include "firmware/estimation/map_grid_state.hpp"
#include "firmware/executive/estimates.hpp"
#include "firmware/inputs/angles.hpp"
#include "firmware/inputs/linkage.hpp"
#include "firmware/inputs/odometer.hpp"
#include "hal/calibration.hpp"

namespace rover {

inline constexpr uint8_t kNoScanYet = 255;

/// Range scans as they arrive.
struct ScanWatch {
    uint8_t last_scan_count = 0;
    uint8_t age_steps = kNoScanYet;  ///< since the last new scan, up to kScanStaleSteps
};

inline constexpr uint16_t kNoSlipShareQ15 = 32768;

/// What the next step does for the slip-and-sinkage cycle that has begun: one part of it a step.
enum class CycleStage : uint8_t {
    none,    ///< nothing: the next cycle may begin
    match,   ///< how far the vehicle got
    extend,  ///< what that says about slip, and the map
    close,   ///< sinkage; sensors are compared, results reported
};

/// Everything the controller remembers.
struct Controller {
    MapGrid map;  ///< first: its rings then lie within a page of memory, see there
    hal::Calibration calibration;
    uint16_t calibration_fault = 0;  ///< kFaultCalibration when nominal values are in use
    Estimates estimates;
    StuckWatch stuck;
    Angles angles;  ///< of this step
    LinkagePose pose;
    OdometerStep travel;
    Odometer odometer;
    ScanWatch scan;
    bool started = false;
    uint16_t sensor_faults = 0;                  ///< tachometer fault of the last cycle
    int16_t past_due_q4_mm = -kCycleTravelQ4Mm;  ///< travel past the next forward cycle's due point
    int16_t since_cycle_q4_mm = 0;               ///< travel that no match has measured yet
    int16_t in_cycle_q4_mm = 0;                  ///< the part of it that the begun cycle measures
    CycleStage stage = CycleStage::none;
    bool changed_side = false;  ///< the begun cycle's linkage is not the one that made the map
    MapGridInput cycle{.middle_distance_q6_bin = U16{0},
                       .front_distance_q6_bin = U16{0}};  ///< measurements of the begun cycle
    uint8_t odometer_rest_q6 = 0;          ///< remainder of the conversion to 1/64 bin, [0, 24]
    int32_t cycle_position_q4_mm = 0;      ///< position at the last cycle
    uint16_t share_q15 = kNoSlipShareQ15;  ///< learned advance of a rim travel, [5460, 32768]
    Side side = Side::none;                ///< side whose linkage made the map
    bool resting = false;
    int16_t rest_middle_q4_mm = 0, rest_front_q4_mm = 0;  ///< heights when the wheels stopped
};

/// Turns a controller whose bytes are all 0 into Controller{} but for the calibration, which
/// use_calibration() gives: an image then needs no copy of it.
constexpr void set_initial_values(Controller& controller) {
    controller.scan.age_steps = kNoScanYet;
    controller.map.mean_q12_bin = slip::kMeanNoSlipQ12Bin;
    controller.map.format = kPoseFormat;
    controller.map.rough_q8_mm = slip::kInitialRoughQ8Mm;
    controller.map.match_cost_q10 = slip::kInitialCostQ10;
    controller.past_due_q4_mm = -kCycleTravelQ4Mm;
    controller.share_q15 = kNoSlipShareQ15;
}

/// Copied as a whole: assigning field by field is longer than the copy.
inline constexpr Controller kControllerAtReset{};

/// Can the record be used? Its version is known and no value makes a computation meaningless.
constexpr bool is_valid(const hal::Calibration& calibration) {
    return calibration.version == hal::kCalibrationVersion &&
           calibration.tach_q16_mm_per_count != 0 && calibration.tach_counts_per_turn != 0 &&
           calibration.wheel_radius_q4_mm != 0;
}

inline constexpr hal::Calibration kNominalCalibration{};

/// Gives a controller that has not run yet its calibration record.
/// @param valid  false: it takes the nominal one, and reports kFaultCalibration in every step
constexpr void use_calibration(Controller& controller, const hal::Calibration& calibration,
                               bool valid) {
    const hal::Calibration* used = &calibration;
    controller.calibration_fault = 0;
    if (!valid) {
        used = &kNominalCalibration;
        controller.calibration_fault = kFaultCalibration;
    }
    controller.calibration = *used;
}

/// Puts the controller into its state after reset, with a record if that is valid.
constexpr void controller_reset(Controller& controller, const hal::Calibration& calibration) {
    controller = kControllerAtReset;
    use_calibration(controller, calibration, is_valid(calibration));
}

}  // namespace rover
