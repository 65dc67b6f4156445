// rlog_writer.cpp - RlogWriter: an .rlog written while the drive goes on.
#include <unistd.h>

#include <cerrno>

#include "host_sim/log/file_io.hpp"
#include "host_sim/log/rlog_format.hpp"

namespace host_sim {

RlogWriter::RlogWriter(const std::filesystem::path& path, const LogHead& head,
                       std::size_t flush_size)
    : path_(path), flush_size_(flush_size) {
    encoder_ = std::make_unique<detail::RlogEncoder>(head, path_.string(), buffer_);
    descriptor_ = detail::open_for_writing(path_);
    if (descriptor_ < 0) detail::fail_system(path_, "cannot be written", errno);
    try {
        flush();
    } catch (...) {
        ::close(descriptor_);
        throw;
    }
}

RlogWriter::~RlogWriter() {
    try {
        close();
    } catch (const LogError&) {
        // Said in the header: close() is the way to hear of it.
    }
}

void RlogWriter::append(const LogStep& step) {
    if (descriptor_ < 0) {
        throw LogError(path_.string(), {}, "step appended after close()",
                       "correct the program that made this log");
    }
    encoder_->append(step, buffer_);
    if (buffer_.size() >= flush_size_) flush();
}

void RlogWriter::flush() {
    const std::size_t written = detail::write_all(descriptor_, buffer_);
    const int error = errno;
    const bool complete = written == buffer_.size();
    buffer_.erase(0, written);  // after a full disk the next flush goes on where this one stopped
    if (!complete) detail::fail_system(path_, "cannot be written", error);
}

void RlogWriter::close() {
    if (descriptor_ < 0) return;
    const int descriptor = descriptor_;
    try {
        flush();
    } catch (...) {
        descriptor_ = -1;
        ::close(descriptor);
        throw;
    }
    descriptor_ = -1;
    if (::close(descriptor) != 0) detail::fail_system(path_, "cannot be written", errno);
}

}  // namespace host_sim
