#include "tools/report/report.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include "tools/report/write_file.hpp"

namespace report {

void write_file(const std::filesystem::path& file, std::string_view text) {
    std::filesystem::path part = file;
    part += ".part";
    const auto fail = [&](const std::string& reason) {
        std::error_code ignored;
        std::filesystem::remove(part, ignored);
        throw std::runtime_error(
            fmt::format("{}: cannot write: {}. Check that the folder exists, "
                        "is writable and has room.",
                        file.string(), reason));
    };
    std::ofstream stream(part, std::ios::binary | std::ios::trunc);
    if (!stream) fail(std::strerror(errno));
    stream.write(text.data(), static_cast<std::streamsize>(text.size()));
    stream.close();
    if (!stream) fail(std::strerror(errno));
    std::error_code error;
    std::filesystem::rename(part, file, error);
    if (error) fail(error.message());
}

void write_report(const host_sim::Log& log, const ReportOptions& options,
                  const std::filesystem::path& file) {
    write_file(file, report_html(log, options));
}

}  // namespace report
