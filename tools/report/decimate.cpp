#include "tools/report/decimate.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace report {
namespace {

/// Adds the extreme rows of one column in [begin, end), and a row without value if there is one.
void add_extremes(const std::vector<double>& column, std::size_t begin, std::size_t end,
                  std::vector<std::size_t>& rows) {
    std::size_t least = end;
    std::size_t greatest = end;
    std::size_t absent = end;
    for (std::size_t row = begin; row < end; ++row) {
        const double value = column[row];
        if (!std::isfinite(value)) {
            absent = row;
        } else if (least == end) {
            least = greatest = row;
        } else {
            if (value < column[least]) least = row;
            if (value > column[greatest]) greatest = row;
        }
    }
    for (const std::size_t row : {least, greatest, absent}) {
        if (row != end) rows.push_back(row);
    }
}

}  // namespace

std::vector<std::size_t> keep_rows(std::span<const std::vector<double>* const> columns,
                                   std::size_t row_count, std::size_t rows_max) {
    std::vector<std::size_t> rows;
    if (row_count <= rows_max) {
        rows.resize(row_count);
        std::iota(rows.begin(), rows.end(), std::size_t{0});
        return rows;
    }
    const std::size_t rows_per_bucket = std::max<std::size_t>(1, 3 * columns.size());
    const std::size_t budget = rows_max > 2 ? rows_max - 2 : 1;
    const std::size_t buckets = std::max<std::size_t>(1, budget / rows_per_bucket);
    rows.reserve(buckets * rows_per_bucket + 2);
    rows.push_back(0);
    for (std::size_t bucket = 0; bucket < buckets; ++bucket) {
        const std::size_t begin = bucket * row_count / buckets;
        const std::size_t end = (bucket + 1) * row_count / buckets;
        for (const std::vector<double>* column : columns) add_extremes(*column, begin, end, rows);
    }
    rows.push_back(row_count - 1);
    std::sort(rows.begin(), rows.end());
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    return rows;
}

std::vector<Run> worst_runs(std::span<const signed char> severity, std::size_t buckets_max) {
    std::vector<Run> runs;
    const std::size_t buckets = std::min(severity.size(), std::max<std::size_t>(1, buckets_max));
    for (std::size_t bucket = 0; bucket < buckets; ++bucket) {
        const std::size_t begin = bucket * severity.size() / buckets;
        const std::size_t end = (bucket + 1) * severity.size() / buckets;
        signed char worst = severity[begin];
        for (std::size_t row = begin; row < end; ++row) worst = std::max(worst, severity[row]);
        if (!runs.empty() && runs.back().value == worst) {
            runs.back().end = end;
        } else {
            runs.push_back({begin, end, worst});
        }
    }
    return runs;
}

}  // namespace report
