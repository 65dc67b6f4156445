// page_table.hpp - tables of the documentation's pages, for tests that compare them with the code.
#pragma once

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace test_support {

using Row = std::vector<std::string>;

/// Cells of the first table after `heading`, without head and rule.
/// @param page  from the root of the repository
inline std::vector<Row> table_of(const std::string& page, const std::string& heading) {
    std::ifstream file(ROVER_SOURCE_DIR "/" + page);
    std::vector<Row> rows;
    std::string line;
    while (std::getline(file, line) && line != heading) {
    }
    while (std::getline(file, line)) {
        if (!line.starts_with("|")) {
            if (!rows.empty() || line.starts_with("#")) break;
            continue;
        }
        Row cells;
        std::stringstream text(line.substr(1));
        for (std::string cell; std::getline(text, cell, '|');) {
            const std::size_t begin = cell.find_first_not_of(" `");
            const std::size_t end = cell.find_last_not_of(" `");
            cells.push_back(begin == std::string::npos ? "" : cell.substr(begin, end - begin + 1));
        }
        rows.push_back(cells);
    }
    if (rows.size() >= 2) rows.erase(rows.begin(), rows.begin() + 2);
    return rows;
}

}  // namespace test_support
