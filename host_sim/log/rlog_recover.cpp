// rlog_recover.cpp - keeps the whole leading records of a damaged .rlog and proves that they read.
#include <fmt/format.h>

#include "host_sim/log/file_io.hpp"
#include "host_sim/log/rlog_format.hpp"

namespace host_sim {
namespace {

void refuse_same_file(const std::filesystem::path& in, const std::filesystem::path& out) {
    std::error_code ignored;  // a file that does not exist is not the same
    if (std::filesystem::equivalent(in, out, ignored)) {
        throw LogError(out.string(), {}, "is the damaged log itself", "name another output file");
    }
}

}  // namespace

std::string_view salvage_rlog(std::string_view bytes, std::string_view name, Recovery& recovery) {
    recovery = {};
    detail::RlogParser parser(bytes, name);
    try {
        LogStep step;
        while (parser.next(step)) ++recovery.steps;
    } catch (const LogError& error) {
        recovery.reason = error.what();
    }
    recovery.kept_bytes = parser.offset();
    recovery.dropped_bytes = bytes.size() - parser.offset();
    return bytes.substr(0, parser.offset());
}

Recovery recover_rlog(const std::filesystem::path& in, const std::filesystem::path& out) {
    refuse_same_file(in, out);
    const std::string bytes = detail::read_file(in);
    Recovery recovery;
    const std::string_view kept = salvage_rlog(bytes, in.string(), recovery);
    detail::write_file(out, kept, detail::Durability::power);
    const std::string written = detail::read_file(out);
    if (written != kept || read_rlog(written, out.string()).steps.size() != recovery.steps) {
        throw LogError(out.string(), {}, "does not read back as it was written",
                       "check the disk and recover again");
    }
    return recovery;
}

}  // namespace host_sim
