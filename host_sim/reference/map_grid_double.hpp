// map_grid_double.hpp - double-precision model of the flying slip-and-sinkage estimator.
// Purpose      the reference that the integer estimator is compared with; written from the
//              derivation in docs/design/slip-and-sinkage.md, not from the integer code.
// Depends on   the standard library only.
// Units        cm throughout; places are distances along the track from the start.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace host_sim {

/// Tuning of the estimator. The defaults are what the firmware flies.
struct MapGridTuning {
    double bin_cm = 2.5;
    double prior_mean_cm = 6.0;      ///< advance of a wheel that does not slip
    double prior_sigma_cm = 1.25;    ///< spread of the advance in one cycle
    double sigma_per_rough = 0.25;   ///< residual sigma over mean second difference
    double sigma_max_cm = 1.6;       ///< ... rounded to this by powers of two,
    double sigma_floor_cm = 0.0125;  ///< ... and not below this
    double sigma_per_cost = 0.7;     ///< residual sigma widens with the running match cost ...
    double sigma_widen_max = 3.0;    ///< ... by at most this factor
    double cost_cap = 16;            ///< cost of one cycle in the running mean
    double credible_fit = 25;        ///< a squared residual above this is no match: dead reckon
    double reacquire_cost = 4;       ///< running cost above this: matching has failed
    double tracking_cost = 1.5;      ///< below this: lock is back
    double reacquire_mean_cm = 5;    ///< prior mean is raised to this when it has
    double slip_alarm_cost = 3.75;   ///< slip alarm above this running match cost ...
    double slip_alarm_percent = 30;  ///< ... or above this slip of the learned mean
    double look_sigma_cm = 0.2;      ///< look-ahead noise that the sinkage shrinkage assumes
    double look_per_rough = 0.3;     ///< interpolation error of the look-ahead surface over rho
    double look_merge_cm = 2.0;      ///< samples nearer than this are averaged
    double sinkage_alarm_cm = 3.0;
};

/// What the vehicle did in one cycle.
enum class CycleMotion : std::uint8_t { forward, reverse, turn, moved };

/// One cycle's measurements. Heights relative to the rear contact, distances ahead of it.
struct MapGridInput {
    double odometer_cm = 6.0;  ///< signed rim travel since the last cycle
    double z1_cm = 0, z2_cm = 0;
    double d1_cm = 25, d2_cm = 50;
    bool linkage = true;  ///< z1, z2, d1, d2 are valid
    std::array<double, 8> ahead_height_cm{}, ahead_distance_cm{};
    int ahead_count = 0;
    CycleMotion motion = CycleMotion::forward;
};

enum class MapGridMode : std::uint8_t {
    odometry_only,
    tracking,
    reacquiring,
    reversing,
    turning,
    moved
};

class MapGridDouble {
public:
    explicit MapGridDouble(const MapGridTuning& tuning = {});

    /// Starts on ground whose load-bearing surface is known from 0 to 50 cm ahead of the rear
    /// wheel.
    template <class Surface>
    void start_on_known_ground(Surface&& surface_cm) {
        drop_map();
        lowest_ = 0;
        for (long node = 0; node <= 20; ++node)
            at(node) = surface_cm(static_cast<double>(node) * tuning_.bin_cm);
        front_place_cm_ = 50;
        front_height_cm_ = at(20);
        at(21) = front_height_cm_;
        front_height_before_cm_ = front_height_cm_;
        has_map_ = true;
        measured_from_cm_ = 0;
    }

    /// What the estimator has learned of the advance of a 6 cm cycle, [1, 6] cm.
    void set_learned_mean_cm(double mean_cm) { prior_mean_cm_ = mean_cm; }

    void step(const MapGridInput& input);

    double position_cm() const { return position_cm_; }
    double advance_cm() const { return advance_cm_; }
    double sinkage_cm() const { return sinkage_cm_; }
    bool sinkage_valid() const { return sinkage_valid_; }
    double sigma_cm() const;
    double match_cost() const { return match_cost_; }
    double prior_mean_cm() const { return prior_mean_cm_; }
    MapGridMode mode() const { return mode_; }
    bool slip_alarm() const { return slip_alarm_; }
    bool sinkage_alarm() const { return sinkage_alarm_; }
    std::uint32_t lost_lock_count() const { return lost_lock_count_; }
    double rough_cm() const { return rough_cm_; }
    double variance_cm2() const { return variance_cm2_; }
    double drift_cm() const { return drift_cm_; }

private:
    static constexpr long kNodes = 32;
    struct Sample {
        double place_cm, height_cm;
    };

    double& at(long node) { return surface_cm_[static_cast<std::size_t>(node & (kNodes - 1))]; }
    double surface_at(double place_cm);
    void move(const MapGridInput& input);
    void drop_map();
    void begin_map(const MapGridInput& input);
    bool can_match(const MapGridInput& input) const;
    double match(const MapGridInput& input);
    [[nodiscard]] double nearest_octave(double sigma_cm) const;
    double residual(long node, const MapGridInput& input);
    void learn(double advance_cm);
    void extend(const MapGridInput& input);
    void look_ahead(const MapGridInput& input, double rear_height_cm);
    void insert(double place_cm, double height_cm);
    void judge(double cost);

    MapGridTuning tuning_;
    std::array<double, kNodes> surface_cm_{};
    bool has_map_ = false;
    long lowest_ = 0;
    double position_cm_ = 0, advance_cm_ = 0;
    double front_place_cm_ = 0, front_height_cm_ = 0, front_height_before_cm_ = 0;
    double measured_from_cm_ = 0;  ///< nodes before this place are interpolated, not measured
    double prior_mean_cm_, rough_cm_ = 0.3, match_cost_ = 1;
    int learned_ = 0, rough_count_ = 0;
    double variance_cm2_ = 0, drift_cm_ = 0;
    MapGridMode mode_ = MapGridMode::odometry_only;
    std::vector<Sample> samples_;
    double sinkage_smooth_cm_ = 0, sinkage_size_cm_ = 0, sinkage_cm_ = 0;
    int sinkage_count_ = 0;
    bool sinkage_valid_ = false, slip_alarm_ = false, sinkage_alarm_ = false;
    std::uint32_t lost_lock_count_ = 0;
};

}  // namespace host_sim
