// program.hpp - the image and its symbols, and what the user's names and addresses mean in them.
// Depends on   host_sim/image, options.hpp, number.hpp.
// Errors       host_sim::ImageError for files, UsageError for the command line.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

#include "host_sim/image/image.hpp"
#include "host_sim/image/symbols.hpp"
#include "tools/i85run/options.hpp"

namespace i85run {

/// A command line that makes no sense with this program.
class UsageError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// What is to run.
struct Program {
    host_sim::Image image;
    host_sim::Symbols symbols;
    std::string symbols_file;  ///< empty: there is none
};

/// Reads the image as HEX, BIN or COM, and the symbol file: the one that was given, else the
/// image's with the extension .sym if that exists.
[[nodiscard]] Program load_program(const Options& options);

/// The address of a symbol, or a number.
/// @param option  for messages, as "--entry"
[[nodiscard]] uint16_t resolve_address(const Program& program, const std::string& option,
                                       const std::string& text);

/// Where the program starts: at --entry; else at the image's start record or load address; else at
/// 0000h or, if nothing is there, at the lowest byte.
[[nodiscard]] uint16_t start_address(const Program& program, const Options& options);

/// Bytes to show after the run; all of them are below 10000h.
struct DumpPlace {
    std::string name;  ///< as the user wrote it
    uint16_t address = 0;
    uint32_t length = 0;
};

/// SYM (with the symbol's size), SYM:LEN or ADDR:LEN.
[[nodiscard]] DumpPlace resolve_dump(const Program& program, const std::string& text);

}  // namespace i85run
