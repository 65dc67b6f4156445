// log_load.cpp - load_log: the content decides which reader is asked.
#include <algorithm>

#include "host_sim/log/file_io.hpp"
#include "host_sim/log/rlog_format.hpp"

namespace host_sim {

Log load_log(const std::filesystem::path& path) {
    const std::string content = detail::read_file(path);
    const std::string name = path.string();
    if (content.empty())
        throw LogError(name, {}, "the file is empty", "give an .rlog or a wide CSV");
    // A file shorter than the magic is an .rlog that was cut off, if it starts like one.
    const std::size_t size = std::min(content.size(), detail::kRlogMagic.size());
    const bool is_rlog = content.compare(0, size, detail::kRlogMagic, 0, size) == 0;
    return is_rlog ? read_rlog(content, name) : read_csv(content, name);
}

}  // namespace host_sim
