// log_error.cpp - the one-line form of a LogError.
#include <fmt/format.h>

#include "host_sim/log/log_io.hpp"

namespace host_sim {
namespace {

/// Control characters (a file name may hold a line feed) become '?', so that the line stays one.
std::string one_line(std::string text) {
    for (char& character : text) {
        const auto code = static_cast<unsigned char>(character);
        if (code < 0x20 || code == 0x7F) character = '?';
    }
    return text;
}

std::string message(std::string_view file, LogError::Place place, std::string_view what,
                    std::string_view advice) {
    std::string where(file);
    if (place.line != 0) where += fmt::format(":{}", place.line);
    if (place.byte_offset >= 0) where += fmt::format(":byte {}", place.byte_offset);
    return one_line(fmt::format("{}: {}; {}", where, what, advice));
}

}  // namespace

LogError::LogError(std::string_view file, Place place, std::string_view what,
                   std::string_view advice)
    : std::runtime_error(message(file, place, what, advice)), file_(file), place_(place) {}

}  // namespace host_sim
