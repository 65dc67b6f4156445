// serial_display.cpp - see serial_display.hpp.
#include "tools/debug/serial_display.hpp"

#include <fmt/format.h>

#include "tools/debug/arguments.hpp"

namespace debug_console {

void SerialDisplay::add(const std::vector<host_sim::chips::I8251a::TransmittedByte>& characters) {
    if (mode_ == Mode::off) return;
    for (const auto& character : characters) {
        if (pending_.empty()) pending_t_ = character.start_t;
        pending_ += static_cast<char>(character.byte);
        const bool text = mode_ == Mode::text;
        const bool whole = text && character.byte == '\n';
        if (whole || pending_.size() >= (text ? kTextBytesMax : kHexBytesMax)) flush();
    }
}

void SerialDisplay::flush() {
    if (pending_.empty()) return;
    std::string line = quote(pending_);
    if (mode_ == Mode::hex) {
        line.clear();
        for (const char byte : pending_) {
            line +=
                fmt::format("{}{:02X}", line.empty() ? "" : " ", static_cast<unsigned char>(byte));
        }
    }
    write_(fmt::format("serial T {}: {}\n", pending_t_, line));
    pending_.clear();
}

}  // namespace debug_console
