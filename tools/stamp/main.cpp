// rover_stamp - fills the identity block of a linked image and adds the loader in front of it; the
//              build runs it behind i85cc.
// Reads        IN.hex.     Writes  OUT.hex and OUT.bin; copies .map, .lst and .sym beside them.
// Exit codes   0 done, 2 usage, 3 an image that cannot be stamped, a file that cannot be written.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>
#include <string_view>

#include "host_sim/image/board_image.hpp"

namespace {

namespace fs = std::filesystem;

struct Options {
    std::string in, out, version, sources, start, program;
};

std::string check_version(const std::string& text) {
    return host_sim::parse_version(text) ? "" : text + " is not a version; write 0.1.0";
}

uint32_t hash_of(const std::string& text) {
    uint32_t value = 0;
    std::from_chars(text.data(), text.data() + text.size(), value, 16);
    return value;
}

std::string check_hash(const std::string& text) {
    uint32_t value = 0;
    const char* const end = text.data() + text.size();
    const auto [at, error] = std::from_chars(text.data(), end, value, 16);
    const bool right = text.size() == 8 && error == std::errc() && at == end;
    return right ? "" : text + " is not a hash; write 8 hexadecimal digits";
}

void write(const fs::path& file, const std::string& content) {
    std::ofstream stream(file, std::ios::binary | std::ios::trunc);
    stream << content;
    stream.close();
    if (!stream) {
        throw host_sim::ImageError(file.string(), 0, "cannot be written",
                                   "check path, permissions and space");
    }
}

/// The symbols of a program with a word in front of each name.
std::string named_symbols(const fs::path& hex, std::string_view word) {
    std::istringstream lines(host_sim::read_image_file(fs::path(hex).replace_extension(".sym")));
    std::string text;
    constexpr std::size_t kBeforeName = 12;  // "ADDR SIZE K "
    for (std::string line; std::getline(lines, line);) {
        const bool has_name = line.size() > kBeforeName && line[kBeforeName] != '-';
        if (has_name) line.insert(kBeforeName, word);
        text += line + "\n";
    }
    return text;
}

int stamp(const Options& options) {
    host_sim::Image image = host_sim::load_hex(options.in);
    const host_sim::ImageIdentity identity = host_sim::stamp_identity(
        image, host_sim::parse_version(options.version).value(), hash_of(options.sources));
    if (!options.start.empty()) {
        host_sim::complete_for_board(image, identity,
                                     host_sim::loader_image(host_sim::load_hex(options.start),
                                                            host_sim::load_hex(options.program)));
    }
    const fs::path out(options.out);
    write(fs::path(out).replace_extension(".bin"),
          host_sim::write_bin(image, {0, image.extent()->last}));
    for (const char* extension : {".map", ".lst", ".sym"}) {
        std::string text =
            host_sim::read_image_file(fs::path(options.in).replace_extension(extension));
        if (extension == std::string_view(".sym") && !options.start.empty()) {
            text += named_symbols(options.start, "loader start: ");
            text += named_symbols(options.program, "loader: ");
        }
        write(fs::path(out).replace_extension(extension), text);
    }
    write(out, host_sim::write_hex(image));  // last: who sees it finds the others
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("rover_stamp: fills the identity block of a linked image (docs/design/image.md).");
    Options options;
    app.add_option("IN", options.in, "What the linker wrote, Intel HEX")->required();
    app.add_option("-o,--output", options.out, "Stamped Intel HEX; the BIN is beside it")
        ->required();
    app.add_option("--image-version", options.version, "Version of the project")
        ->required()
        ->check(check_version);
    app.add_option("--sources", options.sources, "Hash of the firmware's sources, 8 digits")
        ->required()
        ->check(check_hash);
    CLI::Option* start = app.add_option("--loader-start", options.start,
                                        "First part of the loader to be added, Intel HEX");
    CLI::Option* program = app.add_option("--loader-program", options.program,
                                          "Its second part, linked for RAM, Intel HEX");
    start->needs(program);
    program->needs(start);
    app.footer(
        "Example:\n"
        "  rover_stamp linked/rover85.hex -o bin/rover85.hex --image-version 0.1.0 --sources "
        "1a2b3c4d");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    }
    try {
        return stamp(options);
    } catch (const std::exception& error) {
        std::cerr << "rover_stamp: " << error.what() << "\n";
        return 3;
    }
}
