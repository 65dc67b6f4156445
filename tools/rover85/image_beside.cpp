// image_beside.cpp - see image_beside.hpp.
#include "tools/rover85/image_beside.hpp"

#include "host_sim/bind/host_target.hpp"
#include "host_sim/image/identity.hpp"

namespace fs = std::filesystem;

fs::path program_folder() {
    std::error_code problem;
    const fs::path program = fs::read_symlink("/proc/self/exe", problem);
    return problem ? fs::current_path() : program.parent_path();
}

fs::path image_beside(const fs::path& folder) {
    return folder / "rover85.hex";
}

std::string version_text(const fs::path& folder) {
    std::string text = host_sim::host_image_identity();
    const fs::path image = image_beside(folder);
    if (!fs::exists(image)) return text;
    try {
        return text + "\n" +
               host_sim::describe(host_sim::read_identity(host_sim::load_hex(image))) + " image";
    } catch (const host_sim::ImageError& error) {
        return text + "\n" + error.what();
    }
}
