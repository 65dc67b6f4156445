// map_paper_double.hpp - the paper's slip and sinkage procedure in double precision.
// Purpose      the reference that the integer map_paper is compared with, and the model whose sweep
//              stands beside the paper's Table 1. Written from the paper's five steps.
// Source       Wilcox 1994; the reading is docs/design/slip-and-sinkage-paper.md.
// Depends on   the standard library only.
// Units        cm throughout; heights are relative to the rear wheel's contact.
#pragma once

#include <span>
#include <vector>

namespace host_sim {

struct MapPaperOptions {
    double bin_cm = 2.5;            ///< (0, 8]
    double prior_mean_cm = 6.0;     ///< expected advance of one cycle, >= 0
    double prior_sigma_cm = 0.05;   ///< its standard deviation as the estimator is told, > 0
    double vehicle_sigma_cm = 1.0;  ///< its real one: the search reaches four of it past the mean
    bool look_ahead_term = true;    ///< the 60 cm sample takes part in the matching
};

/// One cycle's heights above the rear contact.
struct MapPaperHeightsCm {
    double middle = 0;      ///< z(1), wheel at 25 cm
    double front = 0;       ///< z(2), wheel at 50 cm
    double near_ahead = 0;  ///< z(3), look-ahead sample at 60 cm
    double far_ahead = 0;   ///< z(4), look-ahead sample at 80 cm
};

class MapPaperDouble {
public:
    /// @errors  std::invalid_argument when an option is outside its range
    explicit MapPaperDouble(const MapPaperOptions& options);

    /// Highest bin of the ground histogram: floor(80 cm / bin), and of the sinkage: 50 cm.
    [[nodiscard]] int ground_last() const { return far_ahead_; }
    [[nodiscard]] int sinkage_last() const { return front_; }

    /// Starts on known ground.
    /// @param ground_cm   y at bins 0 to ground_last(), above any level
    /// @param sinkage_cm  s at bins 0 to sinkage_last()
    /// @errors  std::invalid_argument when a size is wrong
    void reset(std::span<const double> ground_cm, std::span<const double> sinkage_cm);

    /// One cycle. @return advance in cm, >= 0
    double step(const MapPaperHeightsCm& heights);

    /// Estimated sinkage under the front wheel, cm; noise can make it negative.
    [[nodiscard]] double sinkage_cm() const { return sinkage_.back(); }
    /// Weighted sum of squares of the last match, in squared sigmas.
    [[nodiscard]] double least_cost() const { return least_cost_; }
    /// Last candidate that the next cycle looks at.
    [[nodiscard]] int search_last() const;
    /// The load-bearing surface at a bin, above the rear contact; bin in [0, sinkage_last()].
    [[nodiscard]] double surface_cm(int bin) const { return ground_at(bin) - sinkage_at(bin); }

private:
    [[nodiscard]] double ground_at(int bin) const { return ground_[static_cast<std::size_t>(bin)]; }
    [[nodiscard]] double sinkage_at(int bin) const {
        return sinkage_[static_cast<std::size_t>(bin)];
    }
    [[nodiscard]] double cost(int bin, const MapPaperHeightsCm& heights) const;
    double find_advance_bins(const MapPaperHeightsCm& heights);
    void extend_search(int best, int last);
    void translate(double advance_bins, const MapPaperHeightsCm& heights);
    void split_the_difference(const MapPaperHeightsCm& heights);

    MapPaperOptions options_;
    int middle_, front_, near_ahead_, far_ahead_, limit_, search_last_;
    int search_more_ = 0;
    double least_cost_ = 0;
    std::vector<double> ground_, sinkage_, costs_, resampled_;
};

}  // namespace host_sim
