// work_folder.hpp - a folder for one compilation's temporary files.
#pragma once

#include <filesystem>

namespace toolchain::driver {

/// Exists as long as this object; then it is removed with all that is in it.
class WorkFolder {
public:
    /// @errors  Failed: the system's folder for temporary files cannot be written
    WorkFolder();
    ~WorkFolder();
    WorkFolder(const WorkFolder&) = delete;
    WorkFolder& operator=(const WorkFolder&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

    /// Removes all that exist now: for a program that is about to be killed.
    static void remove_all();

private:
    std::filesystem::path path_;
};

}  // namespace toolchain::driver
