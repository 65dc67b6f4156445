#include "tools/i85run/output_file.hpp"

#include <cerrno>
#include <cstring>
#include <utility>

#include "host_sim/image/image.hpp"

namespace i85run {

OutputFile::OutputFile(std::string file) : file_(std::move(file)) {
    errno = 0;
    stream_.open(file_, std::ios::binary | std::ios::trunc);
    if (!stream_) fail("cannot be opened for writing");
}

void OutputFile::close() {
    errno = 0;
    stream_.close();
    if (!stream_) fail("cannot be written completely");
}

void OutputFile::fail(const char* what) const {
    std::string sentence = what;
    if (errno != 0) sentence += std::string(": ") + std::strerror(errno);
    throw host_sim::ImageError(file_, 0, sentence, "check the path, permissions and space");
}

}  // namespace i85run
