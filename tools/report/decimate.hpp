// decimate.hpp - fewer rows for the page without losing a peak.
// Depends on   the standard library.
// Bounds       one pass over every column; at most rows_max rows (see keep_rows).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace report {

/// Rows to draw, ascending and without repeats: the first and the last row and, in each of equally
/// long buckets of rows, the row of the least and of the greatest value of every column. What is
/// drawn is therefore always a logged row, and no extreme value is lost.
/// @param columns   equally long; NaN is "no value". Where values start or stop inside a bucket,
///                  one row without a value is kept too, so that a gap of a whole bucket stays one
/// @param row_count length of the columns
/// @param rows_max  row_count <= rows_max keeps every row; at least one bucket is always used, so
///                  the result has at most max(rows_max, 3 * columns + 2) rows
std::vector<std::size_t> keep_rows(std::span<const std::vector<double>* const> columns,
                                   std::size_t row_count, std::size_t rows_max);

/// Neighbouring buckets of equal value, as [first row, last row + 1).
struct Run {
    std::size_t begin;
    std::size_t end;
    int value;
};

/// Run lengths of `severity` after cutting it into at most `buckets_max` buckets and keeping the
/// greatest value of each: a raised alarm of one step survives. Exact when the buckets suffice.
std::vector<Run> worst_runs(std::span<const signed char> severity, std::size_t buckets_max);

}  // namespace report
