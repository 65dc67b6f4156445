// front_end.hpp - sources to LLVM bitcode by clang-19, several at a time.
// Depends on   driver.hpp, process.hpp, resources.hpp.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "toolchain/driver/driver.hpp"

namespace toolchain::driver {

/// The command that makes bitcode of a source.
/// @param include  folder of the compiler's own headers
[[nodiscard]] std::vector<std::string> clang_arguments(const Request& request,
                                                       const std::string& path,
                                                       const std::filesystem::path& input,
                                                       const std::filesystem::path& output,
                                                       const std::filesystem::path& include);

/// Makes bitcode of all sources; sources that are LLVM's already are left as they are.
/// @param work  folder for temporary files
/// @return  a file for each source, in their order
/// @errors  Failed: clang is missing, a source cannot be read or has errors. What clang says goes
/// to
///          request.messages, also when all is well (warnings).
[[nodiscard]] std::vector<std::filesystem::path> run_front_end(const Request& request,
                                                               const std::filesystem::path& work);

}  // namespace toolchain::driver
