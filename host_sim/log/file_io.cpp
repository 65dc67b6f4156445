// file_io.cpp - see file_io.hpp.
#include "host_sim/log/file_io.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "host_sim/log/log_io.hpp"

namespace host_sim::detail {
namespace {

constexpr std::size_t kFileSizeMax = std::size_t{1} << 31;

struct Descriptor {
    int value;
    ~Descriptor() {
        if (value >= 0) ::close(value);
    }
};

std::string_view advice_for(int error) {
    switch (error) {
        case ENOENT:
        case ENOTDIR:
            return "check the path";
        case EACCES:
        case EPERM:
        case EROFS:
            return "check the permissions";
        case EISDIR:
            return "name a file in it";
        case ENOSPC:
        case EDQUOT:
            return "free some space or choose another disk";
        default:
            return "check the path and the disk";
    }
}

[[noreturn]] void refuse_size(const std::filesystem::path& path) {
    throw LogError(path.string(), {}, "is larger than 2 GiB",
                   "split the recording into shorter logs");
}

}  // namespace

void fail_system(const std::filesystem::path& path, std::string_view action, int error) {
    throw LogError(path.string(), {}, fmt::format("{}: {}", action, std::strerror(error)),
                   advice_for(error));
}

std::string read_file(const std::filesystem::path& path) {
    const Descriptor file{::open(path.c_str(), O_RDONLY | O_CLOEXEC)};
    if (file.value < 0) fail_system(path, "cannot be opened", errno);
    struct stat status = {};
    if (::fstat(file.value, &status) != 0) fail_system(path, "cannot be read", errno);
    if (static_cast<std::size_t>(status.st_size) > kFileSizeMax) refuse_size(path);
    std::string content;
    std::size_t size = 0;
    content.resize(S_ISREG(status.st_mode) ? static_cast<std::size_t>(status.st_size) + 1 : 65536);
    for (;;) {
        if (size == content.size()) content.resize(2 * content.size());
        const ssize_t count = ::read(file.value, content.data() + size, content.size() - size);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) fail_system(path, "cannot be read", errno);
        if (count == 0) break;
        size += static_cast<std::size_t>(count);
        if (size > kFileSizeMax) refuse_size(path);
    }
    content.resize(size);
    return content;
}

std::size_t write_all(int descriptor, std::string_view bytes) {
    std::size_t done = 0;
    while (done < bytes.size()) {
        const ssize_t count = ::write(descriptor, bytes.data() + done, bytes.size() - done);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) break;
        done += static_cast<std::size_t>(count);
    }
    return done;
}

int open_for_writing(const std::filesystem::path& path) {
    return ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
}

void write_file(const std::filesystem::path& path, std::string_view bytes, Durability durability) {
    std::error_code ignored;
    const auto status = std::filesystem::status(path, ignored);
    const bool direct =
        std::filesystem::exists(status) && !std::filesystem::is_regular_file(status);
    std::filesystem::path target = path;
    // A link is followed, so that the file it names is replaced and not the link.
    if (!direct && std::filesystem::exists(status))
        target = std::filesystem::canonical(path, ignored);
    if (target.empty()) target = path;
    const std::filesystem::path written =
        direct ? target
               : std::filesystem::path(fmt::format("{}.part{}", target.string(), ::getpid()));
    Descriptor file{open_for_writing(written)};
    if (file.value < 0) fail_system(path, "cannot be written", errno);
    bool good = write_all(file.value, bytes) == bytes.size();
    if (good && durability == Durability::power && !direct) good = ::fsync(file.value) == 0;
    int error = errno;
    if (::close(file.value) != 0 && good) {
        good = false;
        error = errno;
    }
    file.value = -1;
    if (good && !direct && ::rename(written.c_str(), target.c_str()) != 0) {
        good = false;
        error = errno;
    }
    if (good) return;
    if (!direct) ::unlink(written.c_str());
    fail_system(path, "cannot be written", error);
}

}  // namespace host_sim::detail
