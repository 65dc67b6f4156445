// soil.hpp - sinkage that grows with slip, fitted to single-wheel measurements in sand.
// Source   steady_state.csv of the single-wheel data set (docs/design/world.md says where from).
// Law      depth below the height of rolling = a * slip^b, slip in [0, 1], side angle 0.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "host_sim/world/input_error.hpp"

namespace host_sim {

struct SinkageLaw {
    double scale_mm = 0;  ///< a
    double exponent = 1;  ///< b
    /// Depth at `slip`; slips outside [0, 1] count as 0 and 1.
    [[nodiscard]] double depth_mm(double slip) const;
};

enum class WheelKind { grouser, smooth };

/// The fits of 2026 to the data set, for programs that run without it
/// (SinkageLaw.BuiltInEqualsTheFit).
SinkageLaw built_in_sinkage_law(WheelKind kind);

/// One steady trial: slip and depth below the mean height at rolling.
struct SinkageTrial {
    double slip = 0;
    double depth_mm = 0;
};

struct SinkageFit {
    SinkageLaw law;
    double rms_mm = 0;  ///< residual
    std::vector<SinkageTrial> trials;
};

/// Reads the trials with side angle 0 and slip >= 0 and fits the law by least squares in mm.
/// Rolling is a commanded rim speed equal to the carriage's 10 mm/s; its trials (|slip| < 0.01)
/// give the reference height and enter the fit as slip 0.
/// @errors  InputError with file and line; also when a wheel kind has no rolling or fewer than
/// three
///          other trials
SinkageFit fit_sinkage(std::string_view csv_text, const std::string& file_name, WheelKind kind);

/// As above, from a file.
SinkageFit fit_sinkage_file(const std::string& path, WheelKind kind);

}  // namespace host_sim
