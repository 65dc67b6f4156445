// work_folder.cpp - see work_folder.hpp.
#include "toolchain/driver/work_folder.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <set>
#include <string>
#include <system_error>

#include "toolchain/driver/driver.hpp"

namespace toolchain::driver {
namespace fs = std::filesystem;
namespace {

struct Existing {
    std::mutex mutex{};
    std::set<fs::path> paths{};
};

Existing& existing() {
    static Existing folders;
    return folders;
}

void remove_folder(const fs::path& path) {
    std::error_code ignored;  // there is nobody left to tell
    fs::remove_all(path, ignored);
}

}  // namespace

WorkFolder::WorkFolder() {
    std::error_code problem;
    const fs::path parent = fs::temp_directory_path(problem);
    const std::lock_guard lock(existing().mutex);
    std::string name = (parent / "i85cc-XXXXXX").string();
    if (problem || mkdtemp(name.data()) == nullptr) {
        throw Failed(
            fmt::format("{}: temporary files cannot be written: {}: set TMPDIR to a "
                        "folder that can",
                        parent.empty() ? "TMPDIR" : parent.string(),
                        problem ? problem.message() : std::strerror(errno)));
    }
    path_ = name;
    existing().paths.insert(path_);
}

WorkFolder::~WorkFolder() {
    remove_folder(path_);
    const std::lock_guard lock(existing().mutex);
    existing().paths.erase(path_);
}

void WorkFolder::remove_all() {
    const std::lock_guard lock(existing().mutex);
    for (const fs::path& path : existing().paths) remove_folder(path);
}

}  // namespace toolchain::driver
