// work_folder.cpp - see work_folder.hpp.
#include "toolchain/driver/work_folder.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>
#include <system_error>

#include "toolchain/driver/driver.hpp"

namespace toolchain::driver {

WorkFolder::WorkFolder() {
    std::error_code problem;
    const std::filesystem::path parent = std::filesystem::temp_directory_path(problem);
    std::string name = (parent / "i85cc-XXXXXX").string();
    if (problem || mkdtemp(name.data()) == nullptr) {
        throw Failed(
            fmt::format("{}: temporary files cannot be written: {}: set TMPDIR to a "
                        "folder that can",
                        parent.empty() ? "TMPDIR" : parent.string(),
                        problem ? problem.message() : std::strerror(errno)));
    }
    path_ = name;
}

WorkFolder::~WorkFolder() {
    std::error_code ignored;  // there is nobody left to tell
    std::filesystem::remove_all(path_, ignored);
}

}  // namespace toolchain::driver
