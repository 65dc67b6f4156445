// outputs.cpp - see outputs.hpp.
#include "toolchain/driver/outputs.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

#include "toolchain/asm/image_files.hpp"
#include "toolchain/asm/listing.hpp"
#include "toolchain/asm/map_file.hpp"
#include "toolchain/asm/symbol_file.hpp"
#include "toolchain/driver/driver.hpp"

namespace toolchain::driver {
namespace fs = std::filesystem;
namespace {

[[noreturn]] void fail(const fs::path& path, const std::string& why) {
    throw Failed(fmt::format("{}: cannot be written: {}: check path, permissions and space",
                             path.string(), why));
}

void write_to(const fs::path& place, const OutputFile& file) {
    errno = 0;
    std::ofstream stream(place, std::ios::binary | std::ios::trunc);
    stream << file.contents;
    stream.close();
    if (!stream) fail(file.path, std::strerror(errno));
}

/// Devices and pipes are written to; a file takes their place never.
bool is_special(const fs::path& path) {
    std::error_code ignored;
    const fs::file_status status = fs::status(path, ignored);
    return fs::exists(status) && !fs::is_regular_file(status);
}

/// Files that are not in their places yet; those left over are removed.
class Drafts {
public:
    Drafts() = default;
    Drafts(const Drafts&) = delete;
    Drafts& operator=(const Drafts&) = delete;
    ~Drafts() {
        std::error_code ignored;
        for (const fs::path& path : paths_) fs::remove(path, ignored);
    }

    void write(const OutputFile& file) {
        const fs::path draft = file.path.string() + fmt::format(".{}.tmp", getpid());
        paths_.push_back(draft);
        write_to(draft, file);
    }

    void put_into_place(const std::vector<OutputFile>& files) {
        for (std::size_t i = 0; i < files.size(); ++i) {
            std::error_code problem;
            fs::rename(paths_[i], files[i].path, problem);
            if (problem) fail(files[i].path, problem.message());
        }
        paths_.clear();
    }

private:
    std::vector<fs::path> paths_;
};

}  // namespace

std::vector<OutputFile> output_files(const assembly::Program& program, const fs::path& hex) {
    const auto beside = [&](const char* extension) {
        return fs::path(hex).replace_extension(extension);
    };
    return {{hex, write_hex(program)},
            {beside(".bin"), write_bin(program)},
            {beside(".map"), map_file(program)},
            {beside(".lst"), listing(program, assembly::source_files())},
            {beside(".sym"), symbol_file(program)}};
}

void write_all(const std::vector<OutputFile>& files) {
    std::vector<OutputFile> plain;
    std::vector<OutputFile> special;
    for (const OutputFile& file : files) {
        std::error_code ignored;
        if (fs::is_directory(file.path, ignored)) {
            throw Failed(fmt::format("{}: cannot be written: it is a folder: choose another name",
                                     file.path.string()));
        }
        if (is_special(file.path)) {
            special.push_back(file);
            continue;
        }
        plain.push_back(file);
        const fs::path target = fs::weakly_canonical(file.path, ignored);  // through links
        if (!ignored && !target.empty()) plain.back().path = target;
    }
    Drafts drafts;
    for (const OutputFile& file : plain) drafts.write(file);
    for (const OutputFile& file : special) write_to(file.path, file);
    drafts.put_into_place(plain);
}

}  // namespace toolchain::driver
