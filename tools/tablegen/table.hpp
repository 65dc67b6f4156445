// table.hpp - constant tables of the firmware, computed in double precision.
// Adding one   write a function that returns a Table and list it in firmware_tables().
// Tests        tests/tools/tablegen/table_test.cpp
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tablegen {

/// One table and everything its header says.
struct Table {
    std::string folder = "firmware/core/tables";  ///< from the project's root
    std::string file;                             ///< "sine_table.hpp"
    std::string name_space = "rover";
    std::string name;                  ///< "kSineQuarterQ16"
    std::vector<std::string> purpose;  ///< comment lines: contents, use, error bound
    std::string element = "uint16_t";  ///< element type
    bool page = false;  ///< 256 bytes in one page: the index is the low byte of the address
    std::vector<int32_t> values;
};

/// round(65536 sin(i pi / 512)) for i = 0 .. 256, saturated to 65535.
Table sine_table();

/// atan(i / 128) in quarter brads for i = 0 .. 128.
Table arctangent_table();

/// Squares for weighted sums: min(65535, round(scale * i * i)) for i = 0 .. entries - 1.
/// @param name     constant's name, "kSquareQ4"; the file is "square_table.hpp" unless given
/// @param entries  [1, 65536]
/// @param scale    value at i = 1, >= 0; for index step h sigma and result unit u: h * h / u
/// @errors         std::invalid_argument names the argument that is out of range
Table square_table(const std::string& name, int entries, double scale,
                   const std::string& file = "square_table.hpp");

/// Squares of the flying estimator: index 1/8 sigma rounded down, plus 128; entry 1/8 of a squared
/// sigma, that of the middle of the step.
Table match_square_table();

/// Every table of the firmware.
std::vector<Table> firmware_tables();

/// The header that holds `table`; ends in a newline.
std::string render(const Table& table);

/// Largest distance between the real function and the linear interpolation of its rounded table, in
/// units of the table's last place; sampled at 64 points per interval.
double interpolation_error(const std::vector<int32_t>& values, double (*function)(double index));

}  // namespace tablegen
