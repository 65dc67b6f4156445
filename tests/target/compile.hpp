// compile.hpp - how the tests of this folder compile: in memory, every message a failure.
// Depends on   toolchain/driver.
#pragma once

#include <array>
#include <ostream>
#include <string>
#include <string_view>

#include "toolchain/driver/driver.hpp"

namespace target_test {

using toolchain::ir::Optimisation;

/// Built without optimisation or with sanitizers: the compiler takes several times as long.
#if defined(__SANITIZE_ADDRESS__) || !defined(NDEBUG)
inline constexpr bool kSlowBuild = true;
#else
inline constexpr bool kSlowBuild = false;
#endif

struct Level {
    Optimisation level = Optimisation::size;
    const char* name = "Os";
    bool undocumented = false;  ///< --cpu=8085u
};
inline void PrintTo(const Level& level, std::ostream* stream) {  // name from GoogleTest
    *stream << level.name;
}
inline constexpr std::array kLevels = {
    Level{Optimisation::none, "O0"}, Level{Optimisation::less, "O1"},
    Level{Optimisation::more, "O2"}, Level{Optimisation::size, "Os"}};

/// Every level, and the undocumented instructions too.
inline constexpr std::array kSettings = {kLevels[0], kLevels[1], kLevels[2], kLevels[3],
                                         Level{Optimisation::size, "Os_8085u", true}};

/// Test programs may be larger than the rover's ROM: code below E000H, data behind it.
[[nodiscard]] inline toolchain::driver::Request request(Optimisation level) {
    toolchain::driver::Request made;
    made.level = level;
    made.rom = {0x0000, 0xDFFF};
    made.ram = {0xE000, 0xFEFF};
    return made;
}
[[nodiscard]] inline toolchain::driver::Request request(const Level& level) {
    toolchain::driver::Request made = request(level.level);
    made.undocumented = level.undocumented;
    return made;
}

}  // namespace target_test
