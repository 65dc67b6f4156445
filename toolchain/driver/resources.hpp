// resources.hpp - files that the compiler carries inside itself.
// Source       toolchain/runtime, toolchain/include, toolchain/library, by embed.cmake.
#pragma once

#include <span>
#include <string_view>

namespace toolchain::driver {

struct Resource {
    std::string_view name;
    std::string_view text;
};

/// The runtime routines, *.s85.
[[nodiscard]] std::span<const Resource> runtime_files();

/// Those that are small instead of fast, small/*.s85.
[[nodiscard]] std::span<const Resource> small_files();

/// Those that use undocumented instructions, undocumented/*.s85.
[[nodiscard]] std::span<const Resource> undocumented_files();

/// Those that multiply by table, table/*.s85.
[[nodiscard]] std::span<const Resource> table_files();

/// Headers that programs may include: i85.h, string.h.
[[nodiscard]] std::span<const Resource> include_files();

/// Sources that are compiled when a program needs one of their functions.
[[nodiscard]] std::span<const Resource> library_files();

}  // namespace toolchain::driver
