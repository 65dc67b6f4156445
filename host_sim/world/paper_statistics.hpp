// paper_statistics.hpp - Wilcox 1994, bottom of Table 1: statistics of the paper's terrain at
// roughness 1, by bin size.
// Depends  host_sim/world/terrain.hpp.      Tests  Wilcox1994Terrain.*
#pragma once

#include <array>

#include "host_sim/world/terrain.hpp"

namespace host_sim {

/// Row i belongs to a bin of 0.25 * (i + 1) cm.
inline constexpr std::array<TerrainStatistics, 31> kPaperTerrainStatistics = {{
    {2.40, 1.29},   {4.62, 4.07},   {6.58, 6.38},   {8.30, 7.47},   {9.90, 7.85},   {11.50, 8.12},
    {13.14, 8.74},  {14.81, 9.40},  {16.50, 10.14}, {18.18, 10.82}, {19.86, 11.50}, {21.52, 12.51},
    {23.16, 13.81}, {24.77, 14.78}, {26.40, 15.74}, {27.87, 16.84}, {29.73, 18.87}, {31.38, 20.58},
    {33.06, 22.26}, {34.70, 24.27}, {36.33, 26.42}, {38.02, 28.56}, {39.60, 30.45}, {41.24, 32.49},
    {42.69, 33.57}, {44.22, 35.31}, {45.69, 37.22}, {47.24, 39.24}, {48.90, 41.42}, {50.43, 43.60},
    {51.91, 45.52},
}};

}  // namespace host_sim
