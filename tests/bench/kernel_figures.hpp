// kernel_figures.hpp - what the study's kernels cost when this compiler compiles them.
// Depends on   toolchain/driver, tests/target/machine.hpp; the kernels' sources, given as a folder.
// Counted      T-states from the first opcode of kernel() to the end of its RET; code bytes of the
//              kernel's own source, and of it with every runtime routine it is linked with. Tables,
//              data and start-up are left out. Every source is a module of its own, so that nobody
//              sees the data's values while the kernel is compiled.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "toolchain/driver/driver.hpp"

namespace bench {

/// A line of kernels.csv.
struct Kernel {
    std::string name{};
    std::string work{};
    uint32_t checksum = 0;
    uint64_t best_t = 0;  ///< of another compiler; 0: not known
    std::string best_by{};
    uint64_t z80_t = 0;
};

struct Figure {
    std::string kernel{};
    std::string level{};
    uint64_t t_states = 0;
    uint32_t own_bytes = 0;
    uint32_t total_bytes = 0;

    bool operator==(const Figure&) const = default;
};

/// Figures and the front end that they hold for.
struct Figures {
    std::string clang{};
    std::vector<Figure> rows{};
};

struct LevelName {
    toolchain::ir::Optimisation level;
    const char* name;
    bool undocumented = false;    ///< --cpu=8085u
    bool table_multiply = false;  ///< --table-multiply
    toolchain::Steps steps{};     ///< --without
};
inline constexpr LevelName kLevels[] = {{toolchain::ir::Optimisation::none, "O0"},
                                        {toolchain::ir::Optimisation::less, "O1"},
                                        {toolchain::ir::Optimisation::more, "O2"},
                                        {toolchain::ir::Optimisation::size, "Os"},
                                        {toolchain::ir::Optimisation::more, "O2u", true},
                                        {toolchain::ir::Optimisation::size, "Osu", true}};
inline constexpr std::size_t kDocumentedLevels = 4;  ///< the first of them

/// @errors std::runtime_error: not readable
[[nodiscard]] std::vector<Kernel> read_kernels(const std::string& csv_file);
[[nodiscard]] Figures read_figures(const std::string& csv_file);
void write_figures(const std::string& csv_file, const Figures& figures);

/// "19.1.4": of the clang that the driver runs.
[[nodiscard]] std::string clang_version();

/// Compiles, runs, checks the checksum and counts.
/// @param folder  where the kernels' sources are
/// @errors std::runtime_error: wrong checksum, no end, ...
[[nodiscard]] Figure measure(const Kernel& kernel, const LevelName& level,
                             const std::string& folder);

/// Tables for people, in Markdown.
[[nodiscard]] std::string table(const std::vector<Kernel>& kernels, const Figures& figures);

/// The row of a kernel and a level, if there is one.
[[nodiscard]] std::optional<Figure> find(const Figures& figures, const std::string& kernel,
                                         const std::string& level);

/// Geometric mean of the T-states of one level, each divided by those of another, over the kernels
/// that count: those with a figure of other compilers.
[[nodiscard]] double mean_ratio(const std::vector<Kernel>& kernels, const Figures& figures,
                                const std::string& level, const std::string& to);

}  // namespace bench
