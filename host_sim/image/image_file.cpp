// image_file.cpp - images from files.
#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "host_sim/image/image.hpp"

namespace host_sim {
namespace {

constexpr std::size_t kFileSizeMax = std::size_t{16} << 20;

[[noreturn]] void fail_system(const std::string& file, std::string_view action, int error) {
    throw ImageError(file, 0, fmt::format("{}: {}", action, std::strerror(error)),
                     "check the path and its permissions");
}

}  // namespace

std::string read_image_file(const std::filesystem::path& path) {
    const std::string file = path.string();
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(std::fopen(path.c_str(), "rb"),
                                                                 &std::fclose);
    if (!stream) fail_system(file, "cannot be opened", errno);
    std::string content;
    char block[65536];
    for (;;) {
        const std::size_t count = std::fread(block, 1, sizeof block, stream.get());
        content.append(block, count);
        if (content.size() > kFileSizeMax) {
            throw ImageError(file, 0, "is larger than 16 MiB", "give the program image itself");
        }
        if (count < sizeof block) break;
    }
    if (std::ferror(stream.get()) != 0) fail_system(file, "cannot be read", errno);
    return content;
}

Image load_hex(const std::filesystem::path& path) {
    return read_hex(read_image_file(path), path.string());
}

Image load_bin(const std::filesystem::path& path, uint16_t load_address) {
    return read_bin(read_image_file(path), load_address, path.string());
}

}  // namespace host_sim
